// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/explicit_block.h"

#include "billet/material/neo_hookean.h"
#include "billet/material/state_fields.h"
#include "billet/mechanics/elementwise_block.h"
#include "billet/mechanics/explicit_instructions.h"
#include "billet/mechanics/explicit_storage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <type_traits>
#include <variant>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace billet {

namespace {

using Material = explicit_kernels::BasicMaterial<double>;

double harden(const void *flow, const double q, const double m, const double alpha, double &yield_stress) {
  const auto &law = *static_cast<const FlowStress *>(flow);
  const double delta = law.solve(q, m, alpha, 0.).strain;
  yield_stress = law.stress(alpha + delta);
  return delta;
}

explicit_kernels::LaneFlow find_flow(const void *flow, const double q, const double m, const double alpha,
                                     const double dt, double *state) {
  const auto &law = *static_cast<const FlowStress *>(flow);
  const double delta = law.solve(q, m, alpha, dt).strain;
  FlowStress::State before{{}};
  std::copy_n(state, law.n_state(), before.begin());
  FlowStress::State after = before;
  if (delta > 0.)
    law.advance(alpha, delta, dt, before, after);
  std::copy_n(after.begin(), law.n_state(), state);
  return {delta, law.stress(alpha + delta), q - m * delta,
          law.plastic_work(alpha + delta, after) - law.plastic_work(alpha, before)};
}

double find_yield_stress(const void *flow, const double alpha, double &slope) {
  const auto &law = *static_cast<const FlowStress *>(flow);
  slope = law.slope(alpha);
  return law.stress(alpha);
}

/// Returns what a point stores for a flow stress, null for elastic bodies.
PlasticNumbers plastic_numbers(const FlowStress *flow) {
  if (flow == nullptr)
    return {};
  return {true, flow->lane_form().kind != HardeningKind::linear, flow->n_state()};
}

/// Sets the parameters of a flow stress, as far as kernels support it.
void set_hardening(const FlowStress &flow, Material &material) {
  const LaneHardening form = flow.lane_form();
  const bool by_lane = form.kind == HardeningKind::other && form.rate.kind == RateKind::none;
  material.hardening.kind = form.kind;
  material.hardening.yield_stress = form.yield_stress;
  material.hardening.modulus = form.hardening_modulus;
  material.hardening.saturation_stress = form.saturation_stress;
  material.hardening.saturation_rate = form.saturation_rate;
  material.hardening.strength = form.strength;
  material.hardening.prestrain = form.prestrain;
  material.hardening.exponent = form.exponent;
  material.rate.kind = by_lane && flow.n_state() > 0 ? RateKind::other : form.rate.kind;
  material.rate.exponent = form.rate.exponent;
}

bool compute_logarithm(const double *b, double *deviator, double &mean) {
  PrincipalElasticState state;
  dealii::SymmetricTensor<2, 3> tensor;
  for (unsigned int k = 0; k < 6; ++k)
    tensor[symmetric_pairs[k][0]][symmetric_pairs[k][1]] = b[k];
  if (!compute_principal_state(tensor, state))
    return false;
  for (unsigned int k = 0; k < 6; ++k) {
    deviator[k] = 0.;
    for (unsigned int a = 0; a < 3; ++a)
      deviator[k] += 2. * state.deviatoric_log_strains[a] * state.directions[a][symmetric_pairs[k][0]] *
                     state.directions[a][symmetric_pairs[k][1]];
  }
  mean = 2. * state.volumetric_log_strain / 3.;
  return true;
}

/// Converts to the kernel's units and number type.
template <class Number>
explicit_kernels::BasicMaterial<Number> convert(const Material &material, const KernelUnits &units) {
  const auto to_number = [](const double x) { return static_cast<Number>(x); };
  explicit_kernels::BasicMaterial<Number> result{};
  result.bulk = to_number(material.bulk / units.stress);
  result.shear = to_number(material.shear / units.stress);
  result.hardening.kind = material.hardening.kind;
  result.hardening.yield_stress = to_number(material.hardening.yield_stress / units.stress);
  result.hardening.modulus = to_number(material.hardening.modulus / units.stress);
  result.hardening.saturation_stress = to_number(material.hardening.saturation_stress / units.stress);
  result.hardening.saturation_rate = to_number(material.hardening.saturation_rate);
  result.hardening.prestrain = to_number(material.hardening.prestrain);
  result.hardening.exponent = to_number(material.hardening.exponent);
  result.hardening.strength = to_number(material.hardening.strength / units.stress);
  result.rate.kind = material.rate.kind;
  result.rate.exponent = to_number(material.rate.exponent);
  result.hardening.flow_stress = material.hardening.flow_stress;
  result.hardening.n_state = material.hardening.n_state;
  result.stress_unit = units.stress;
  result.density = to_number(material.density / units.density);
  result.wave_speed = to_number(material.wave_speed * units.time / units.length);
  result.viscosity.linear = to_number(material.viscosity.linear);
  result.viscosity.quadratic = to_number(material.viscosity.quadratic);
  return result;
}

/// Returns the mean size of the elements [length].
double typical_length(const std::vector<std::array<unsigned int, n_element_nodes>> &elements,
                      const double *positions) {
  double sum = 0.;
  for (const auto &element : elements) {
    double maximum = 0.;
    for (unsigned int i = 0; i < 3; ++i) {
      double low = positions[4 * std::size_t{element[0]} + i], high = low;
      for (const unsigned int node : element) {
        low = std::min(low, positions[4 * std::size_t{node} + i]);
        high = std::max(high, positions[4 * std::size_t{node} + i]);
      }
      maximum = std::max(maximum, high - low);
    }
    sum += maximum;
  }
  return sum / static_cast<double>(elements.size());
}

/// Guard that flushes subnormal numbers to zero, since processors are a hundred times slower with
/// them. In float, products of small values ahead of a wave are subnormal.
class NoSubnormals {
public:
#ifdef __SSE2__
  NoSubnormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | bits); }
  ~NoSubnormals() { _mm_setcsr((_mm_getcsr() & ~bits) | (before_ & bits)); }
#else
  NoSubnormals() {}
#endif
  NoSubnormals(const NoSubnormals &) = delete;
  NoSubnormals &operator=(const NoSubnormals &) = delete;

private:
#ifdef __SSE2__
  // Bits of MXCSR: subnormal results and operands become zero.
  static constexpr unsigned int bits = 0x8040;
  unsigned int before_;
#endif
};

/// Ends a switch over all laws of the kernels, which returns in each case.
[[noreturn]] void throw_unknown_law() { throw std::logic_error("a law of the kernels lacks its case"); }

/// Block of a law that kernels support.
template <class Number> class Block final : public ExplicitBlock {
public:
  Block(std::shared_ptr<const PointLaw> law, const LaneLaw lane_law, const LaneElement lane_element,
        const double density, const ExplicitFormulation &formulation)
      : formulation_(formulation), law_(std::move(law)), lane_law_(lane_law), flow_(law_->flow_stress()),
        storage_(find_kernels<Number>(formulation.instructions).n_lanes, law_->elastic(), lane_law,
                 lane_element, plastic_numbers(flow_)),
        kernel_(find_kernel(find_kernels<Number>(formulation.instructions), lane_element, lane_law,
                            flow_ != nullptr)) {
    if (kernel_ == nullptr)
      throw std::logic_error("the explicit kernels lack this law with this element");
    const ElasticModuli &elastic = law_->elastic();
    material_ = {};
    material_.bulk = elastic.bulk;
    material_.shear = elastic.shear;
    material_.density = density;
    material_.wave_speed = std::sqrt((elastic.bulk + 4. / 3. * elastic.shear) / density);
    material_.viscosity.linear = formulation.linear_viscosity;
    material_.viscosity.quadratic = formulation.quadratic_viscosity;
    if (flow_ != nullptr) {
      set_hardening(*flow_, material_);
      reference_rate_ = flow_->lane_form().rate.reference;
      material_.hardening.flow_stress = flow_;
      material_.hardening.n_state = static_cast<unsigned int>(flow_->n_state());
      functions_.harden = &harden;
      functions_.flow = &find_flow;
      functions_.yield_stress = &find_yield_stress;
    }
    functions_.logarithm = &compute_logarithm;
  }

  bool initialize(const std::vector<std::array<unsigned int, n_element_nodes>> &elements,
                  const double *reference_positions, std::size_t &offender) override {
    if constexpr (is_single)
      if (!elements.empty()) {
        const double length = typical_length(elements, reference_positions);
        if (length > 0.)
          units_ = choose_units(length, material_.shear, material_.density);
      }
    kernel_material_ = convert<Number>(material_, units_);
    is_fresh_ = true;
    return storage_.initialize(elements, reference_positions, units_, material_.density,
                               flow_ != nullptr ? flow_->stress(0.) : 0., offender);
  }

  std::size_t size() const override { return storage_.size(); }
  std::size_t history_size() const override { return storage_.layout().n_history; }
  std::size_t history_memory() const override { return size() * history_size() * sizeof(Number); }
  std::size_t stabilisation_memory() const override {
    return size() * storage_.stabilisation_size() * sizeof(Number);
  }

  double scale_mass(const double min_step) override {
    // The kernel itself computes the stable step of each element.
    const dealii::AlignedVector<double> at_rest(storage_.nodal_size(), 0.);
    dealii::AlignedVector<double> ignored_forces(storage_.nodal_size(), 0.);
    typename ExplicitStorage<Number>::Copy copy;
    double added = 0.;
    for (std::size_t element = 0; element < size(); ++element) {
      explicit_kernels::Result result{};
      kernel_(storage_.copy_element(element, copy), kernel_material_, functions_,
              make_step({at_rest.data(), at_rest.data(), ignored_forces.data()}, 0.), result);
      const double excess = min_step * max_rate(result);
      // stiffness/mass scales as the square of a rate, damping/mass linearly with it.
      if (excess > 1.)
        added += material_.density * storage_.scale_mass(element, excess * excess);
    }
    return added;
  }

  StepResult advance(const Nodes &nodes, const double dt) override {
    explicit_kernels::Result result{};
    const auto is_moved = [](const double displacement) { return displacement != 0.; };
    if (is_fresh_ && dt == 0. &&
        std::any_of(nodes.displacements, nodes.displacements + storage_.nodal_size(), is_moved))
      storage_.renew(nodes.displacements, true);
    is_fresh_ = false;
    kernel_material_.rate.dt = dt;
    kernel_material_.rate.reference_increment = static_cast<Number>(reference_rate_ * dt);
    [[maybe_unused]] const std::conditional_t<is_single, NoSubnormals, std::monostate> guard{};
    kernel_(storage_.elements(), kernel_material_, functions_, make_step(nodes, dt), result);
    const double energy = units_.energy(), rate = max_rate(result);
    // A rank without elements sets no limit.
    const double longest = rate > 0. ? 1. / rate : std::numeric_limits<double>::infinity();
    return {longest,
            energy * result.elastic_energy,
            energy * result.plastic_work,
            energy * result.viscous_work,
            energy * result.hourglass_energy,
            result.inverted};
  }

  void renew(const double *displacements) override { storage_.renew(displacements, false); }

  void add_masses(double *masses) const override { storage_.add_masses(material_.density, masses); }

  ElementSummary summarize(const std::size_t element, const double *displacements) const override {
    ElementSummary summary;
    double reference_volume = 0., current_volume = 0.;
    for (const PointState &point : storage_.compute_states(element, displacements)) {
      const double w = point.reference_volume;
      const double volumetric = std::log(point.volume_ratio), mean_tau = material_.bulk * volumetric;
      dealii::SymmetricTensor<2, 3> dev_tau;
      const double distortion = compute_distortion(point.tensor, dev_tau);
      summary.cauchy_stress += w * (dev_tau + mean_tau * dealii::unit_symmetric_tensor<3>());
      summary.equivalent_plastic_strain += w * point.equivalent_plastic_strain;
      summary.elastic_energy += w * (distortion + 0.5 * mean_tau * volumetric);
      if (flow_ != nullptr)
        summary.plastic_work += w * flow_->plastic_work(point.equivalent_plastic_strain, point.flow);
      reference_volume += w;
      current_volume += w * point.volume_ratio;
    }
    if (reference_volume > 0.) {
      summary.cauchy_stress /= current_volume;
      summary.equivalent_plastic_strain /= reference_volume;
    }
    return summary;
  }

  void get_state(const std::size_t element, double *state) const override {
    storage_.get_history(element, state);
  }
  void set_state(const std::size_t element, const double *state) override {
    storage_.set_history(element, state);
    is_fresh_ = false;
  }

  void set_parent_state(const std::size_t element, const ParentElement &parent,
                        const double *displacements) override {
    is_fresh_ = false;
    storage_.set_parent_history(element, parent, displacements);
  }

  ElementStress compute_stress(const std::size_t element, const double *displacements) const override {
    ElementStress stress;
    const std::vector<PointState> states = storage_.compute_states(element, displacements);
    for (std::size_t q = 0; q < stress.size() && !states.empty(); ++q) {
      const PointState &state = states[q % states.size()];
      compute_distortion(state.tensor, stress[q].deviator);
      stress[q].equivalent_plastic_strain = state.equivalent_plastic_strain;
      if (flow_ != nullptr) // as the memory of all laws that kernels have
        stress[q].memory = flow_->numbers_of(state.flow);
    }
    return stress;
  }

  void set_stress(const std::size_t element, const double *displacements,
                  const ElementStress &stress) override {
    if (flow_ == nullptr && lane_law_ != LaneLaw::hypoelastic) {
      storage_.renew(displacements, true);
      return;
    }
    is_fresh_ = false;
    const ElementStress corners = stress.transfer(2);
    ElementStress wanted = corners;
    if (storage_.n_points() == 1) {
      wanted[0] = PointStress();
      for (const PointStress &point : corners)
        wanted[0].add(1. / n_element_nodes, point);
    }
    std::vector<PointState> states;
    std::vector<double> yield_stress;
    for (const PointStress &point : wanted) {
      states.push_back({0., 0., elastic_tensor(point.deviator), point.equivalent_plastic_strain, {}});
      std::copy(point.memory.begin(), point.memory.end(), states.back().flow.begin());
      yield_stress.push_back(flow_ != nullptr ? flow_->stress(point.equivalent_plastic_strain) : 0.);
    }
    storage_.set_states(element, displacements, states, yield_stress);
  }

  PointStates point_states() const override { return {}; }

  StateAverages average_states(const std::size_t element, const double *displacements) const override {
    std::vector<double> state(law_->n_state()), average(state.size(), 0.);
    const std::size_t flow_state = place_of_field(*law_, flow_state_name);
    double reference_volume = 0.;
    for (const PointState &point : storage_.compute_states(element, displacements)) {
      dealii::SymmetricTensor<2, 3> deviator;
      compute_distortion(point.tensor, deviator);
      law_->initialize(state.data());
      law_->set_stress(point.F, deviator, point.equivalent_plastic_strain, state.data());
      for (std::size_t k = 0; flow_ != nullptr && k < flow_->n_state() && flow_state < state.size(); ++k)
        state[flow_state + k] = point.flow[k];
      for (std::size_t k = 0; k < state.size(); ++k)
        average[k] += point.reference_volume * state[k];
      reference_volume += point.reference_volume;
    }
    if (reference_volume > 0.)
      for (double &number : average)
        number /= reference_volume;
    return {average};
  }

private:
  static constexpr bool is_single = std::is_same_v<Number, float>;

  explicit_kernels::Step make_step(const Nodes &nodes, const double dt) const {
    return {nodes.displacements, nodes.velocities, nodes.forces, dt > 0. ? units_.time / dt : 0., dt,
            1. / units_.length,  units_.force()};
  }

  /// Returns the rate with a margin in float: its round-off, a few parts in 10⁷, must not make the
  /// step unstable.
  double max_rate(const explicit_kernels::Result &result) const {
    return (is_single ? 1. + 2e-6 : 1.) * result.max_rate / units_.time;
  }

  /// Returns a PointState's tensor from dev τ, the inverse of compute_distortion().
  dealii::SymmetricTensor<2, 3> elastic_tensor(const dealii::SymmetricTensor<2, 3> &dev_tau) const {
    const dealii::SymmetricTensor<2, 3> X = dev_tau / material_.shear;
    switch (lane_law_) {
    case LaneLaw::hypoelastic:
      return dev_tau;
    case LaneLaw::hencky:
      return exponential(X);
    case LaneLaw::neo_hookean:
      return X + complete_unimodular(X) * dealii::unit_symmetric_tensor<3>();
    }
    throw_unknown_law();
  }

  /// Computes dev τ from a PointState's tensor. Returns its stored energy per reference volume.
  double compute_distortion(const dealii::SymmetricTensor<2, 3> &tensor,
                            dealii::SymmetricTensor<2, 3> &dev_tau) const {
    const double G = material_.shear;
    switch (lane_law_) {
    case LaneLaw::hypoelastic:
      dev_tau = tensor;
      return tensor * tensor / (4. * G);
    case LaneLaw::hencky:
      return compute_principal_distortion(tensor, dev_tau, [G](const double e, double &stress) {
        stress = 2. * G * e;
        return G * e * e;
      });
    case LaneLaw::neo_hookean: // ½ G (tr b̄_e − 3); Σ e = 0
      return compute_principal_distortion(tensor, dev_tau, [G](const double e, double &stress) {
        stress = G * std::expm1(2. * e);
        return 0.5 * G * (std::expm1(2. * e) - 2. * e);
      });
    }
    throw_unknown_law();
  }

  /// Computes dev τ and the energy from principal strains: `respond` sets the principal stress of a
  /// deviatoric logarithmic strain and returns its energy.
  template <class Respond>
  static double compute_principal_distortion(const dealii::SymmetricTensor<2, 3> &tensor,
                                             dealii::SymmetricTensor<2, 3> &dev_tau, const Respond &respond) {
    PrincipalElasticState state;
    if (!compute_principal_state(tensor, state))
      return 0.;
    PrincipalResponse response;
    double energy = 0.;
    for (unsigned int a = 0; a < 3; ++a)
      energy += respond(state.deviatoric_log_strains[a], response.stress[a]);
    dev_tau = dealii::deviator(compute_kirchhoff_stress(state, response));
    return energy;
  }

  ExplicitFormulation formulation_;
  std::shared_ptr<const PointLaw> law_;
  LaneLaw lane_law_;
  const FlowStress *flow_; ///< null for elastic bodies
  Material material_;
  /// D of the rate factor; 0 if there is none, or kernels do not have it.
  double reference_rate_ = 0.;
  KernelUnits units_;
  explicit_kernels::BasicMaterial<Number> kernel_material_{};
  explicit_kernels::LaneFunctions functions_{};
  ExplicitStorage<Number> storage_;
  explicit_kernels::Kernel<Number> kernel_;
  bool is_fresh_ = true; ///< history is still that of initialize()
};

void require(const bool is_met, const char *reason) {
  if (!is_met)
    throw std::invalid_argument(reason);
}

} // namespace

bool has_kernel(const BrickElement &element, const PointLaw &law) {
  return element.lanes().has_value() && law.lane_law().has_value();
}

std::unique_ptr<ExplicitBlock> make_explicit_block(const std::shared_ptr<const PointLaw> &law,
                                                   const double density,
                                                   const ExplicitFormulation &formulation) {
  require(law->elastic().bulk > 0. && law->elastic().shear > 0., "elastic moduli must be positive");
  require(density > 0., "the density must be positive");
  require(formulation.linear_viscosity >= 0. && formulation.quadratic_viscosity >= 0.,
          "bulk viscosity must not be negative");
  const bool in_float = formulation.number_type == NumberType::float_precision;
  if (!has_kernel(formulation.element, *law)) {
    require(!in_float, "'Number type = float' is for laws and elements that the kernels have");
    return make_elementwise_block(law, density, formulation);
  }
  const LaneLaw lane_law = *law->lane_law();
  const LaneElement lane_element = *formulation.element.lanes();
  if (in_float)
    return std::make_unique<Block<float>>(law, lane_law, lane_element, density, formulation);
  return std::make_unique<Block<double>>(law, lane_law, lane_element, density, formulation);
}

} // namespace billet
