// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/forces/internal_forces.h"

#include "billet/errors.h"
#include "billet/fail_together.h"
#include "billet/mechanics/one_point.h"

#include <deal.II/base/array_view.h>
#include <deal.II/lac/full_matrix.h>

#include <sstream>

namespace billet {

namespace {

/// Finds the thickness axes of a body's elements. Throws InputError if no axis is clearly nearest
/// to the direction.
std::vector<ThicknessAxis> find_thickness_axes(const Scene &scene, const std::size_t b,
                                               const Discretization &discretization,
                                               const std::vector<ElementVectors> &positions) {
  const Body &body = scene.bodies()[b];
  std::vector<ThicknessAxis> axes(positions.size());
  for (std::size_t e = 0; e < positions.size() && !body.thickness_direction.empty(); ++e) {
    const auto centre = discretization.elements(b)[e].cell->center();
    dealii::Tensor<1, 3> direction;
    for (unsigned int i = 0; i < 3; ++i)
      direction[i] = body.thickness_direction[i].value(0., centre);
    const auto axis = find_thickness_axis(positions[e], direction);
    if (!axis) {
      std::ostringstream message;
      message << scene.parameters().bodies[b].element.value.direction_origin << " is (" << direction
              << ") at the element with its centre at (" << centre
              << "); allowed is a direction that is nearer to one axis of each element than to the others by "
                 "10 degrees";
      throw InputError(message.str());
    }
    axes[e] = *axis;
  }
  return axes;
}

} // namespace

InternalForces::InternalForces(const Scene &scene, const Discretization &discretization)
    : discretization_(discretization) {
  std::size_t plastic_bytes = 0;
  fail_together(discretization.communicator(), [&] {
    for (std::size_t b = 0; b < scene.bodies().size(); ++b) {
      std::vector<ElementVectors> positions;
      for (const auto &element : discretization.elements(b))
        positions.push_back(nodal_positions(element.cell));
      blocks_.push_back(make_element_block(scene.bodies()[b].law, scene.bodies()[b].formulation));
      std::size_t offender = 0;
      const auto axes = find_thickness_axes(scene, b, discretization, positions);
      if (!blocks_.back()->initialize(positions, axes, offender)) {
        std::ostringstream message;
        message << scene.parameters().bodies[b].origin << ": the element with its centre at ("
                << discretization.elements(b)[offender].cell->center()
                << ") is degenerate or inverted; allowed are hexahedra with a positive Jacobian";
        throw InputError(message.str());
      }
      const Body &body = scene.bodies()[b];
      const bool is_plastic = body.law->has_plasticity();
      if (is_plastic)
        n_plastic_ += positions.size();
      if (body.formulation.element.is_stabilised())
        n_stabilised_ += positions.size();
      if (is_plastic)
        plastic_bytes += blocks_.back()->history_size() * positions.size() * sizeof(double);
    }
  });
  for (const Body &body : scene.bodies())
    temperatures_.push_back(body.temperature.get());
  start_step(0., 0.);
  plastic_memory_.set(plastic_bytes);
  stabilised_memory_.set(n_stabilised_ * OnePointElement::stabilisation_size);
}

void InternalForces::start_step(const double t, const double dt) {
  step_.dt = dt;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    if (temperatures_[b] != nullptr)
      blocks_[b]->set_temperature(temperatures_[b]->value(t));
}

void InternalForces::count() const {
  Usage::count_if(n_plastic_ > 0, Capability::plasticity, n_plastic_);
  Usage::count_if(n_stabilised_ > 0, Capability::stabilisation, n_stabilised_);
}

bool InternalForces::assemble_forces(const Vector &displacements, Vector &forces) {
  discard_evaluated_summaries();
  count();
  ++ElementLoops::of_forces;
  ElementVectors force{};
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const auto &elements = discretization_.elements(b);
    for (std::size_t e = 0; e < elements.size(); ++e) {
      if (!blocks_[b]->evaluate(e, gather(displacements, elements[e].dofs), force, nullptr, step_))
        return false;
      forces.add(n_element_dofs, elements[e].dofs.data(), force.data());
    }
  }
  return true;
}

bool InternalForces::assemble_tangent(const Vector &displacements, const TangentSystem &system,
                                      const double yield_slack) {
  discard_evaluated_summaries();
  count();
  ++ElementLoops::of_tangents;
  ElementVectors force{};
  ElementMatrix tangent{};
  PointStep step = step_;
  step.yield_slack = yield_slack;
  dealii::FullMatrix<double> cell_matrix(n_element_dofs, n_element_dofs);
  std::vector<DofIndex> dofs(n_element_dofs);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const auto &elements = discretization_.elements(b);
    for (std::size_t e = 0; e < elements.size(); ++e) {
      if (!blocks_[b]->evaluate(e, gather(displacements, elements[e].dofs), force, &tangent, step))
        return false;
      std::copy(tangent.begin(), tangent.end(), &cell_matrix(0, 0));
      dofs.assign(elements[e].dofs.begin(), elements[e].dofs.end());
      system.add(cell_matrix, dofs);
    }
  }
  return true;
}

void InternalForces::commit() {
  for (auto &block : blocks_)
    block->commit();
  if (summarized_ == Beat::committed) // of the state before
    summaries_.clear();
  summarized_ = Beat::committed;
}

void InternalForces::discard_evaluated_summaries() {
  if (summarized_ == Beat::evaluated)
    summaries_.clear();
}

InternalForces::Energies InternalForces::compute_energies(const Vector &displacements, const Beat beat) {
  std::array<double, 3> sums{};
  summaries_.clear();
  summarized_ = beat;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    summaries_.push_back(compute_summaries(b, displacements, beat));
    for (const ElementSummary &summary : summaries_.back()) {
      sums[0] += summary.elastic_energy;
      sums[1] += summary.plastic_work;
      sums[2] += summary.hourglass_energy;
    }
  }
  std::array<double, 3> totals{};
  dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(sums.data(), sums.size()),
                              discretization_.communicator(),
                              dealii::ArrayView<double>(totals.data(), totals.size()));
  return {totals[0], totals[1], totals[2]};
}

std::vector<ElementSummary> InternalForces::compute_summaries(const std::size_t body,
                                                              const Vector &displacements,
                                                              const Beat beat) const {
  std::vector<ElementSummary> result;
  const auto &elements = discretization_.elements(body);
  for (std::size_t e = 0; e < elements.size(); ++e)
    result.push_back(blocks_[body]->summarize(e, gather(displacements, elements[e].dofs), beat));
  return result;
}

std::vector<ElementSummary> InternalForces::summarize(const std::size_t body,
                                                      const Vector &displacements) const {
  const bool is_known = summarized_ == Beat::committed && !summaries_.empty();
  return is_known ? summaries_[body] : compute_summaries(body, displacements, Beat::committed);
}

std::vector<LayerSummaries> InternalForces::summarize_layers(const std::size_t body,
                                                             const Vector &displacements) const {
  std::vector<LayerSummaries> result;
  const auto &elements = discretization_.elements(body);
  for (std::size_t e = 0; e < elements.size(); ++e)
    if (const auto layers = blocks_[body]->summarize_layers(e, gather(displacements, elements[e].dofs)))
      result.push_back(*layers);
  return result;
}

std::vector<StateAverages> InternalForces::average_states(const std::size_t body) const {
  std::vector<StateAverages> result;
  for (std::size_t e = 0; e < blocks_[body]->size(); ++e)
    result.push_back(blocks_[body]->average_states(e));
  return result;
}

std::size_t InternalForces::history_size() const {
  std::size_t size = 0;
  for (const auto &block : blocks_)
    size += block->size() * block->history_size();
  return size;
}

} // namespace billet
