// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/elementwise_block.h"

#include "billet/mechanics/element_mass.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace billet {

namespace {

/// Returns ‖A²‖_∞^{1/2} of (X16).
double bound_gradients(const ReferenceElement &reference, const MeanDilatationKinematics &kinematics) {
  double A[n_element_nodes][n_element_nodes] = {};
  for (unsigned int q = 0; q < n_element_points; ++q) {
    const auto &g = kinematics.gradients[q];
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      for (unsigned int b = 0; b < n_element_nodes; ++b)
        A[a][b] += reference.volumes[q] * (g[a][0] * g[b][0] + g[a][1] * g[b][1] + g[a][2] * g[b][2]);
  }
  double maximum = 0.;
  for (const auto &row : A) {
    double sum = 0.;
    for (unsigned int b = 0; b < n_element_nodes; ++b) {
      double square = 0.;
      for (unsigned int c = 0; c < n_element_nodes; ++c)
        square += row[c] * A[c][b];
      sum += std::abs(square);
    }
    maximum = std::max(maximum, sum);
  }
  return std::sqrt(maximum);
}

class ElementwiseBlock final : public ExplicitBlock {
public:
  ElementwiseBlock(std::shared_ptr<const PointLaw> law, const double density,
                   const ExplicitFormulation &formulation)
      : law_(std::move(law)), formulation_(formulation), density_(density),
        wave_speed_(std::sqrt((law_->elastic().bulk + 4. / 3. * law_->elastic().shear) / density)) {
    ElementFormulation implicit;
    implicit.element = formulation.element;
    implicit.constants = formulation.constants;
    block_ = make_element_block(law_, implicit);
  }

  bool initialize(const std::vector<std::array<unsigned int, n_element_nodes>> &elements,
                  const double *reference_positions, std::size_t &offender) override {
    nodes_ = elements;
    std::vector<ElementVectors> positions;
    positions.reserve(elements.size());
    for (std::size_t e = 0; e < elements.size(); ++e)
      positions.push_back(gather(e, reference_positions));
    if (!block_->initialize(positions, offender))
      return false;
    references_.resize(elements.size());
    masses_.resize(elements.size());
    last_.resize(elements.size());
    for (std::size_t e = 0; e < elements.size(); ++e) {
      compute_reference_element(positions[e], references_[e]);
      masses_[e] = compute_nodal_volumes(references_[e]);
      for (double &mass : masses_[e])
        mass *= density_;
      MeanDilatationKinematics kinematics;
      compute_kinematics(references_[e], ElementVectors{}, kinematics);
      last_[e] = {kinematics.current_volume, find_omega(e, kinematics), 0., 0.};
    }
    return true;
  }

  std::size_t size() const override { return nodes_.size(); }

  double scale_mass(const double min_step) override {
    double added = 0.;
    for (std::size_t e = 0; e < size(); ++e) {
      const double stiffness = law_->bound_stiffness({}) * last_[e].omega,
                   excess = min_step * find_rate(stiffness, damp(last_[e].omega, 0.).rate * last_[e].omega);
      if (excess <= 1.)
        continue;
      // Stiffness/mass scales as the square of a rate, damping/mass linearly with it.
      const double factor = excess * excess;
      for (double &mass : masses_[e]) {
        added += (factor - 1.) * mass;
        mass *= factor;
      }
      last_[e].omega /= factor;
    }
    return added;
  }

  void set_temperature(const double temperature) override { block_->set_temperature(temperature); }

  StepResult advance(const Nodes &nodes, const double dt) override {
    StepResult result{std::numeric_limits<double>::infinity(), 0., 0., 0., 0., size()};
    double max_rate = 0.;
    PointStep step;
    step.dt = dt;
    for (std::size_t e = 0; e < size(); ++e) {
      const ElementVectors u = gather(e, nodes.displacements);
      MeanDilatationKinematics kinematics;
      ElementVectors force{};
      if (!compute_kinematics(references_[e], u, kinematics) ||
          !block_->evaluate(e, u, force, nullptr, step)) {
        result.inverted = std::min(result.inverted, e);
        continue;
      }
      const ElementSummary summary = block_->summarize(e, u, Beat::evaluated);
      Last &last = last_[e];
      const double change = kinematics.current_volume - last.volume,
                   rate = dt > 0. ? 2. / dt * change / (kinematics.current_volume + last.volume) : 0.;
      const Damping damping = damp(last.omega, rate);
      result.viscous_work += 0.5 * (last.viscous_pressure + damping.pressure) * change;
      for (unsigned int i = 0; i < n_element_dofs; ++i)
        force[i] += damping.pressure * kinematics.current_volume * kinematics.mean_divergence[i];
      for (unsigned int a = 0; a < n_element_nodes; ++a)
        for (unsigned int i = 0; i < 3; ++i)
          nodes.forces[4 * std::size_t{nodes_[e][a]} + i] -= force[3 * a + i];

      result.elastic_energy += summary.elastic_energy;
      result.hourglass_energy += summary.hourglass_energy;
      result.plastic_work += summary.plastic_work - last.plastic_work;
      last = {kinematics.current_volume, find_omega(e, kinematics), damping.pressure, summary.plastic_work};
      max_rate = std::max(max_rate, find_rate(summary.stiffness_bound * last.omega,
                                              damping.rate * kinematics.volume_ratio * last.omega));
    }
    block_->commit();
    if (max_rate > 0.)
      result.stable_step = 1. / max_rate;
    return result;
  }

  void renew(const double *) override {} // nothing accumulates in float

  void add_masses(double *masses) const override {
    for (std::size_t e = 0; e < size(); ++e)
      for (unsigned int a = 0; a < n_element_nodes; ++a)
        masses[nodes_[e][a]] += masses_[e][a];
  }

  ElementSummary summarize(const std::size_t element, const double *displacements) const override {
    return block_->summarize(element, gather(element, displacements), Beat::committed);
  }

  std::size_t history_size() const override { return block_->state_size() + n_last; }
  std::size_t history_memory() const override {
    return size() * (block_->history_size() + n_last) * sizeof(double);
  }
  std::size_t stabilisation_memory() const override { return 0; }

  void get_state(const std::size_t element, double *state) const override {
    const Last &last = last_[element];
    const std::array<double, n_last> own = {last.volume, last.omega, last.viscous_pressure,
                                            last.plastic_work};
    block_->get_state(element, std::copy(own.begin(), own.end(), state));
  }
  void set_state(const std::size_t element, const double *state) override {
    last_[element] = {state[0], state[1], state[2], state[3]};
    block_->set_state(element, state + n_last);
  }

  void set_parent_state(const std::size_t element, const ParentElement &parent,
                        const double *displacements) override {
    const ElementVectors u = gather(element, displacements);
    block_->set_parent_state(element, parent.state + n_last, parent.child);
    MeanDilatationKinematics kinematics;
    if (!compute_kinematics(references_[element], u, kinematics))
      return;
    last_[element] = {kinematics.current_volume, find_omega(element, kinematics), parent.state[2],
                      block_->summarize(element, u, Beat::committed).plastic_work};
  }

  ElementStress compute_stress(const std::size_t element, const double *displacements) const override {
    return block_->compute_stress(element, gather(element, displacements));
  }
  void set_stress(const std::size_t element, const double *displacements,
                  const ElementStress &stress) override {
    const ElementVectors u = gather(element, displacements);
    block_->set_stress(element, u, stress);
    MeanDilatationKinematics kinematics;
    if (!compute_kinematics(references_[element], u, kinematics))
      return;
    last_[element] = {kinematics.current_volume, find_omega(element, kinematics), 0.,
                      block_->summarize(element, u, Beat::committed).plastic_work};
  }

  PointStates point_states() const override { return {n_last, block_->point_states().n_points}; }
  StateAverages average_states(const std::size_t element, const double *) const override {
    return block_->average_states(element);
  }

private:
  /// Data of an element's last call.
  struct Last {
    double volume, omega, viscous_pressure, plastic_work;
  };
  static constexpr std::size_t n_last = 4;

  struct Damping {
    double pressure, rate;
  };
  /// Computes the bulk viscosity ρ L (c_1 c |d| + c_2² L d²) with L² = 4/(ρ Ω), as in the kernels.
  Damping damp(const double omega, const double rate_of_volume) const {
    const double linear = 2. * formulation_.linear_viscosity * wave_speed_ * std::sqrt(density_ / omega),
                 quadratic = 4. * formulation_.quadratic_viscosity * formulation_.quadratic_viscosity /
                             omega * std::max(-rate_of_volume, 0.);
    return {(linear + quadratic) * rate_of_volume, 3. * (linear + 2. * quadratic)};
  }

  /// Returns the minimum 1/Δt for which M − Δt C/2 − Δt² K/4 stays positive: K ≤ M ω², C ≤ M c.
  static double find_rate(const double omega_squared, const double c) {
    return 0.5 * (0.5 * c + std::sqrt(0.25 * c * c + omega_squared));
  }

  double find_omega(const std::size_t element, const MeanDilatationKinematics &kinematics) const {
    const auto &masses = masses_[element];
    return bound_gradients(references_[element], kinematics) /
           *std::min_element(masses.begin(), masses.end());
  }

  ElementVectors gather(const std::size_t element, const double *values) const {
    ElementVectors result;
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      for (unsigned int i = 0; i < 3; ++i)
        result[3 * a + i] = values[4 * std::size_t{nodes_[element][a]} + i];
    return result;
  }

  std::shared_ptr<const PointLaw> law_;
  ExplicitFormulation formulation_;
  double density_, wave_speed_;
  std::unique_ptr<ElementBlock> block_;
  std::vector<std::array<unsigned int, n_element_nodes>> nodes_;
  std::vector<ReferenceElement> references_;
  /// Lumped masses of the elements' nodes.
  std::vector<std::array<double, n_element_nodes>> masses_;
  std::vector<Last> last_;
};

} // namespace

std::unique_ptr<ExplicitBlock> make_elementwise_block(std::shared_ptr<const PointLaw> law,
                                                      const double density,
                                                      const ExplicitFormulation &formulation) {
  return std::make_unique<ElementwiseBlock>(std::move(law), density, formulation);
}

} // namespace billet
