// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/explicit_storage.h"

#include "billet/mechanics/assumed_strain_element.h"
#include "billet/mechanics/element_mass.h"
#include "billet/mechanics/hourglass_energy.h"
#include "billet/mechanics/modal_geometry.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;
namespace last = explicit_kernels::last;
namespace mean_gradient = explicit_kernels::mean_gradient;
namespace one_point = explicit_kernels::one_point;
namespace assumed_strain = explicit_kernels::assumed_strain;

namespace {

constexpr std::size_t n_mode_numbers = 21, eight_point_modes = 2;

double next_power_of_two(const double x) { return std::exp2(std::round(std::log2(x))); }

/// Returns ∂ξ/∂X at a point: the gradient of the field with the corners' coordinates ξ as nodal
/// values.
Tensor<2, 3> compute_inverse_jacobian(const ReferenceElement &reference, const unsigned int q) {
  Tensor<2, 3> result;
  for (unsigned int a = 0; a < n_element_nodes; ++a)
    for (unsigned int k = 0; k < 3; ++k)
      for (unsigned int i = 0; i < 3; ++i)
        result[k][i] += corner(a, k) * reference.gradients[q][a][i];
  return result;
}

/// Returns the maximum absolute row sum, a bound of a symmetric matrix's eigenvalues.
template <std::size_t n> double bound_by_rows(const std::array<std::array<double, n>, n> &matrix) {
  double maximum = 0.;
  for (const auto &row : matrix) {
    double sum = 0.;
    for (const double entry : row)
      sum += std::abs(entry);
    maximum = std::max(maximum, sum);
  }
  return maximum;
}

/// Returns a bound of λ_max of A Aᵀ per squared displacement. A maps the nodal values to vectors;
/// `rows` are their coefficients by the seven modes, which are orthogonal with squared length 1/8.
template <std::size_t n> double bound_squares(const std::array<std::array<double, 7>, n> &rows) {
  std::array<std::array<double, n>, n> matrix{};
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t l = 0; l < n; ++l)
      for (unsigned int m = 0; m < 7; ++m)
        matrix[k][l] += rows[k][m] * rows[l][m];
  return bound_by_rows(matrix) / 8.;
}

/// Returns the coefficients of the columns of J̄ by the modes.
std::array<std::array<double, 7>, 3> rows_of_mean(const ModalGeometry &geometry) {
  std::array<std::array<double, 7>, 3> rows{};
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int m = 0; m < n_linear_modes; ++m)
      rows[k][m] = geometry.beta[m][k];
  return rows;
}

/// Returns the same with the modes b and c added, minus `part` times the contribution of the mean
/// gradient.
std::array<std::array<double, 7>, 7> rows_of_all(const ModalGeometry &geometry, const Tensor<2, 3> &inverse,
                                                 const double part) {
  std::array<std::array<double, 7>, 7> rows{};
  const auto mean = rows_of_mean(geometry);
  std::copy(mean.begin(), mean.end(), rows.begin());
  for (unsigned int m = 0; m < 4; ++m) {
    const Tensor<1, 3> own = part * (inverse * geometry.modes[3 + m]);
    for (unsigned int l = 0; l < 7; ++l)
      rows[3 + m][l] =
          (l == 3 + m ? 1. : 0.) - (own[0] * mean[0][l] + own[1] * mean[1][l] + own[2] * mean[2][l]);
  }
  return rows;
}

/// Returns the metric of the columns, relative to the maximum square.
hourglass::Metric<double> measure_columns(const ModalGeometry &geometry) {
  const auto &a = geometry.modes;
  const double unit = std::max({a[0].norm_square(), a[1].norm_square(), a[2].norm_square()});
  hourglass::Metric<double> metric;
  for (unsigned int k = 0; k < 3; ++k) {
    metric.square[k] = a[k].norm_square() / unit;
    metric.product[k] = a[(k + 1) % 3] * a[(k + 2) % 3] / unit;
  }
  metric.complete([](const double x) { return 1. / x; });
  return metric;
}

/// Returns M_h of (X12): a bound of the stiffness of hourglass strains over their weighted squares.
double bound_hourglass(const ElasticModuli &elastic, const hourglass::Metric<double> &metric) {
  const hourglass::Moduli<double> moduli(elastic.bulk, elastic.shear);
  constexpr std::size_t n = 12;
  std::array<double, n> weights;
  weights.fill(1.);
  for (unsigned int m = 0; m < 3; ++m)
    weights[4 * m] = std::sqrt(metric.square[m] *
                               (metric.inverse_square[(m + 1) % 3] + metric.inverse_square[(m + 2) % 3]));
  std::array<std::array<double, n>, n> matrix;
  for (std::size_t c = 0; c < n; ++c) {
    double strain[4][3] = {}, stress[4][3];
    strain[c / 3][c % 3] = 1. / weights[c];
    hourglass::respond(moduli, metric, strain, stress);
    for (std::size_t r = 0; r < n; ++r)
      matrix[r][c] = stress[r / 3][r % 3] / weights[r];
  }
  return bound_by_rows(matrix);
}

/// Returns a bound of the eigenvalues of J⁻¹ J⁻ᵀ.
double bound_metric(const Tensor<2, 3> &inverse_jacobian) {
  const Tensor<2, 3> metric = inverse_jacobian * transpose(inverse_jacobian);
  double maximum = 0.;
  for (unsigned int k = 0; k < 3; ++k)
    maximum = std::max(maximum, std::abs(metric[k][0]) + std::abs(metric[k][1]) + std::abs(metric[k][2]));
  return maximum;
}

} // namespace

KernelUnits choose_units(const double length, const double stress, const double density) {
  KernelUnits units;
  units.length = next_power_of_two(length);
  units.stress = next_power_of_two(stress);
  const double rate = std::exp2(std::round(0.5 * std::log2(units.stress / density))); // a speed
  units.density = units.stress / (rate * rate);
  units.time = units.length / rate;
  return units;
}

/// Returns the number of constants that kernels keep of an element.
std::size_t n_constants_of(const LaneElement element, const bool is_rate) {
  switch (element) {
  case LaneElement::one_point:
    return one_point::modes;
  case LaneElement::assumed_strain:
    return assumed_strain::modes;
  case LaneElement::mean_dilatation:
    break;
  }
  return eight_point_modes + (is_rate ? 0 : n_element_points);
}

template <class Number>
ExplicitStorage<Number>::ExplicitStorage(const unsigned int n_lanes, const ElasticModuli &elastic,
                                         const LaneLaw law, const LaneElement element,
                                         const PlasticNumbers &plastic)
    : n_lanes_(n_lanes), elastic_(elastic), law_(law), element_(element), plastic_(plastic) {
  const bool is_one_point = element == LaneElement::one_point;
  n_tensor_ = is_rate() ? 5 : 6;
  layout_.n_point_history = n_tensor_ + (plastic.has_alpha ? n_parts : 0) +
                            (plastic.has_yield_stress ? 1 : 0) + plastic.n_state * n_parts;
  first_point_ = last::n + (is_one_point ? 12 : 0);
  layout_.n_history = first_point_ + (is_one_point ? 1 : n_element_points) * layout_.n_point_history;
  layout_.n_constants = n_constants_of(element, is_rate());
  if (is_single)
    layout_.n_constants += n_mode_numbers;
  history_units_.assign(layout_.n_history, 1.);
}

template <class Number> void ExplicitStorage<Number>::set_history_units() {
  history_units_.assign(layout_.n_history, 1.);
  history_units_[last::omega] = 1. / (units_.density * units_.length * units_.length);
  history_units_[last::viscous_pressure] = units_.stress;
  for (std::size_t first = first_point_; first < layout_.n_history; first += layout_.n_point_history) {
    for (std::size_t k = 0; k < n_tensor_ && is_rate(); ++k)
      history_units_[first + k] = units_.stress;
    if (plastic_.has_yield_stress)
      history_units_[first + n_tensor_ + n_parts] = units_.stress;
  }
}

template <class Number> void ExplicitStorage<Number>::resize(const std::size_t n_elements) {
  n_elements_ = n_elements;
  const std::size_t padded = (n_elements + n_lanes_ - 1) / n_lanes_ * n_lanes_;
  nodes_.resize(0);
  constants_.resize(0);
  history_.resize(0);
  nodes_.resize(padded * n_element_nodes);
  constants_.resize(padded * layout_.n_constants);
  history_.resize(padded * layout_.n_history);
  density_factors_.assign(n_elements, 1.);
}

template <class Number>
bool ExplicitStorage<Number>::initialize(
    const std::vector<std::array<unsigned int, n_element_nodes>> &elements, const double *reference_positions,
    const KernelUnits &units, const double density, const double yield_stress, std::size_t &offender) {
  units_ = units;
  set_history_units();
  resize(elements.size());
  unsigned int n_nodes = 0;
  for (const auto &element : elements)
    n_nodes = std::max(n_nodes, *std::max_element(element.begin(), element.end()) + 1);
  reference_positions_.resize(0);
  reference_positions_.resize(std::size_t{4} * n_nodes);
  std::copy(reference_positions, reference_positions + std::size_t{4} * n_nodes,
            reference_positions_.begin());
  for (offender = 0; offender < elements.size(); ++offender) {
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      nodes_[index(offender, a, n_element_nodes)] = elements[offender][a];
    if (!initialize_element(offender, density, yield_stress))
      return false;
  }
  // Lanes beyond the last element repeat it.
  for (std::size_t e = elements.size(); e % n_lanes_ != 0; ++e) {
    const std::size_t last = elements.size() - 1;
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      nodes_[index(e, a, n_element_nodes)] = nodes_[index(last, a, n_element_nodes)];
    for (std::size_t k = 0; k < layout_.n_constants; ++k)
      set_constant(e, k, constant(last, k));
    for (std::size_t k = 0; k < layout_.n_history; ++k)
      set_history(e, k, history(last, k));
  }
  return true;
}

template <class Number>
ElementVectors ExplicitStorage<Number>::gather(const std::size_t element, const double *values) const {
  ElementVectors result;
  for (unsigned int a = 0; a < n_element_nodes; ++a)
    for (unsigned int i = 0; i < 3; ++i)
      result[3 * a + i] = values[4 * std::size_t{nodes_[index(element, a, n_element_nodes)]} + i];
  return result;
}

template <class Number>
void ExplicitStorage<Number>::set_in_parts(const std::size_t element, std::size_t &k, const double value) {
  set_history(element, k, value);
  const double rest = value - history(element, k);
  ++k;
  if (is_single)
    set_history(element, k++, rest);
}

template <class Number>
double ExplicitStorage<Number>::get_in_parts(const std::size_t element, std::size_t &k) const {
  double value = 0.;
  for (std::size_t part = 0; part < n_parts; ++part)
    value += history(element, k++);
  return value;
}

template <class Number>
void ExplicitStorage<Number>::initialize_point(const std::size_t element, const std::size_t first,
                                               const Tensor<2, 3> &inverse_jacobian,
                                               const double yield_stress) {
  std::size_t k = first;
  if (is_rate() || is_single)
    for (; k < first + n_tensor_; ++k)
      set_history(element, k, 0.);
  else {
    const Tensor<2, 3> H = inverse_jacobian * transpose(inverse_jacobian);
    for (const auto &pair : symmetric_pairs)
      set_history(element, k++, H[pair[0]][pair[1]]);
  }
  if (plastic_.has_alpha)
    set_in_parts(element, k, 0.);
  if (plastic_.has_yield_stress)
    set_history(element, k++, yield_stress);
  for (std::size_t n = 0; n < plastic_.n_state; ++n)
    set_in_parts(element, k, 0.);
}

template <class Number>
void ExplicitStorage<Number>::set_modes(const std::size_t element, const std::size_t first,
                                        const ModalGeometry &geometry) {
  std::size_t place = first;
  for (unsigned int m = 0; m < 7; ++m)
    for (unsigned int i = 0; i < 3; ++i)
      set_constant(element, place++, geometry.modes[m][i] / units_.length);
}

template <class Number>
bool ExplicitStorage<Number>::initialize_mean_gradient(const std::size_t element,
                                                       const ElementVectors &positions, const double min_mass,
                                                       const double yield_stress, double &lambda) {
  const ModalGeometry geometry(positions);
  Tensor<2, 3> jacobian;
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int i = 0; i < 3; ++i)
      jacobian[i][k] = geometry.modes[k][i];
  const double det = determinant(jacobian);
  if (!(det > 0.))
    return false;
  const Tensor<2, 3> inverse = invert(jacobian);
  const bool is_one_point = element_ == LaneElement::one_point;
  const double squares = is_one_point ? bound_squares(rows_of_mean(geometry))
                                      : bound_squares(rows_of_all(geometry, inverse, 1.));
  lambda = geometry.volume * bound_metric(inverse) * squares;
  const double cubed = units_.length * units_.length * units_.length;
  const double mass_unit = units_.density * cubed;
  set_constant(element, mean_gradient::volume, geometry.volume / cubed);
  set_constant(element, mean_gradient::inverse_det, cubed / det);
  set_constant(element, mean_gradient::bound, squares / min_mass * mass_unit);
  for (unsigned int m = 0; m < 6; ++m)
    for (unsigned int k = 0; k < 3; ++k)
      set_constant(element, mean_gradient::beta + 3 * m + k, geometry.beta[m][k]);
  if (is_one_point) {
    set_constant(element, one_point::bound_of_all,
                 bound_squares(rows_of_all(geometry, inverse, 0.)) / min_mass * mass_unit);
    initialize_one_point(element, geometry, inverse);
  } else
    initialize_assumed_strain(element, geometry, inverse);
  for (std::size_t first = first_point_; first < layout_.n_history; first += layout_.n_point_history)
    initialize_point(element, first, inverse, yield_stress);
  return true;
}

template <class Number>
void ExplicitStorage<Number>::initialize_one_point(const std::size_t element, const ModalGeometry &geometry,
                                                   const Tensor<2, 3> &inverse) {
  const hourglass::Metric<double> metric = measure_columns(geometry);
  set_constant(element, one_point::hourglass_modulus, bound_hourglass(elastic_, metric) / units_.stress);
  for (std::size_t k = 0; k < 3; ++k) {
    set_constant(element, one_point::metric + k, metric.square[k]);
    set_constant(element, one_point::metric + 3 + k, metric.product[k]);
  }
  if (is_single)
    set_modes(element, one_point::modes, geometry);
  else
    for (unsigned int m = 0; m < 4; ++m)
      for (unsigned int k = 0; k < 3; ++k)
        set_history(element, last::n + std::size_t{3} * m + k, (inverse * geometry.modes[3 + m])[k]);
}

template <class Number>
void ExplicitStorage<Number>::initialize_assumed_strain(const std::size_t element,
                                                        const ModalGeometry &geometry,
                                                        const Tensor<2, 3> &inverse) {
  std::array<double, 3> lengths{};
  for (unsigned int k = 0; k < 3; ++k)
    lengths[k] = geometry.modes[k].norm();
  const auto constants = compute_strain_constants(elastic_, lengths);
  std::size_t place = 0;
  for (unsigned int j = 0; j < 3; ++j) {
    for (unsigned int k = 0; k < 3; ++k)
      if (j != k) {
        set_constant(element, assumed_strain::share + place, constants.share[j][k]);
        set_constant(element, assumed_strain::shear + place++, constants.shear[j][k]);
      }
    set_constant(element, assumed_strain::thinning + j, constants.thinning[j]);
  }
  for (unsigned int m = 0; m < 4; ++m) {
    const Tensor<1, 3> own = inverse * geometry.modes[3 + m];
    for (unsigned int k = 0; k < 3; ++k)
      set_constant(element, assumed_strain::own + std::size_t{3} * m + k, own[k]);
  }
  if (is_single)
    set_modes(element, assumed_strain::modes, geometry);
}

template <class Number>
bool ExplicitStorage<Number>::initialize_element(const std::size_t element, const double density,
                                                 const double yield_stress) {
  const ElementVectors positions = gather(element, reference_positions_.data());
  ReferenceElement reference;
  if (!compute_reference_element(positions, reference))
    return false;
  const auto nodal_volumes = compute_nodal_volumes(reference);
  const double min_mass = density * *std::min_element(nodal_volumes.begin(), nodal_volumes.end());
  double volume = 0., lambda = 0.;
  for (const double w : reference.volumes)
    volume += w;

  if (element_ != LaneElement::mean_dilatation) {
    if (!initialize_mean_gradient(element, positions, min_mass, yield_stress, lambda))
      return false;
  } else {
    const double cubed = units_.length * units_.length * units_.length;
    set_constant(element, 0, volume / cubed);
    set_constant(element, 1, units_.density * cubed / min_mass);
    std::size_t place = eight_point_modes;
    if (is_single) {
      set_modes(element, place, ModalGeometry(positions));
      place += n_mode_numbers;
    }
    for (unsigned int q = 0; q < n_element_points; ++q) {
      const Tensor<2, 3> inverse = compute_inverse_jacobian(reference, q);
      lambda = std::max(lambda, reference.volumes[q] * bound_metric(inverse));
      if (!is_rate())
        set_constant(element, place + q, reference.volumes[q] / cubed);
      initialize_point(element, first_point_ + q * layout_.n_point_history, inverse, yield_stress);
    }
  }
  set_history(element, last::volume, is_single ? 0. : volume);
  set_history(element, last::omega, lambda / min_mass);
  set_history(element, last::viscous_pressure, 0.);
  return true;
}

template <class Number> explicit_kernels::BasicElements<Number> ExplicitStorage<Number>::elements() {
  return {n_elements_,       nodes_.data(),   reference_positions_.data(),
          constants_.data(), history_.data(), layout_};
}

template <class Number>
explicit_kernels::BasicElements<Number> ExplicitStorage<Number>::copy_element(const std::size_t element,
                                                                              Copy &copy) const {
  copy.nodes.resize(std::size_t{n_element_nodes} * n_lanes_);
  copy.constants.resize(layout_.n_constants * n_lanes_);
  copy.history.resize(layout_.n_history * n_lanes_);
  for (std::size_t lane = 0; lane < n_lanes_; ++lane) {
    for (std::size_t a = 0; a < n_element_nodes; ++a)
      copy.nodes[a * n_lanes_ + lane] = nodes_[index(element, a, n_element_nodes)];
    for (std::size_t k = 0; k < layout_.n_constants; ++k)
      copy.constants[k * n_lanes_ + lane] = constants_[index(element, k, layout_.n_constants)];
    for (std::size_t k = 0; k < layout_.n_history; ++k)
      copy.history[k * n_lanes_ + lane] = history_[index(element, k, layout_.n_history)];
  }
  return {1,      copy.nodes.data(), reference_positions_.data(), copy.constants.data(), copy.history.data(),
          layout_};
}

template <class Number>
double ExplicitStorage<Number>::scale_mass(const std::size_t element, const double factor) {
  const double cubed = units_.length * units_.length * units_.length;
  const double volume = cubed * constant(element, 0) * density_factors_[element];
  density_factors_[element] *= factor;
  // Lanes beyond the last element repeat it.
  const bool is_last = element + 1 == n_elements_;
  for (std::size_t e = element; e == element || (is_last && e % n_lanes_ != 0); ++e) {
    const auto divide = [&](const std::size_t k) { set_constant(e, k, constant(e, k) / factor); };
    divide(element_ == LaneElement::mean_dilatation ? 1 : mean_gradient::bound);
    if (element_ == LaneElement::one_point)
      divide(one_point::bound_of_all);
    set_history(e, last::omega, history(e, last::omega) / factor);
  }
  return volume * (factor - 1.);
}

template <class Number>
// NOLINTNEXTLINE(readability-non-const-parameter): what is added depends on the template
void ExplicitStorage<Number>::add_masses(const double density, double *masses) const {
  for (std::size_t element = 0; element < n_elements_; ++element) {
    ReferenceElement reference;
    compute_reference_element(gather(element, reference_positions_.data()), reference);
    const auto volumes = compute_nodal_volumes(reference);
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      masses[nodes_[index(element, a, n_element_nodes)]] += density * density_factors_[element] * volumes[a];
  }
}

template <class Number>
template <class Visit>
void ExplicitStorage<Number>::visit_points(const std::size_t element, const double *displacements,
                                           const Visit &visit) const {
  const ElementVectors X = gather(element, reference_positions_.data()), u = gather(element, displacements);
  if (element_ == LaneElement::one_point) {
    ElementVectors x;
    std::transform(X.begin(), X.end(), u.begin(), x.begin(), std::plus<>());
    const ModalGeometry reference(X), current(x);
    Tensor<2, 3> jacobian, reference_jacobian;
    for (unsigned int k = 0; k < 3; ++k)
      for (unsigned int i = 0; i < 3; ++i) {
        reference_jacobian[i][k] = reference.modes[k][i];
        for (unsigned int m = 0; m < 6; ++m)
          jacobian[i][k] += reference.beta[m][k] * current.modes[m][i];
      }
    const double J = determinant(jacobian) / determinant(reference_jacobian);
    if (J > 0.)
      visit(first_point_, reference.volume, J, jacobian, invert(reference_jacobian));
    return;
  }
  if (element_ == LaneElement::assumed_strain) {
    using Brick = AssumedStrainElement<>;
    const Brick brick(elastic_, {});
    Brick::Reference reference;
    Brick::Kinematics kinematics;
    if (!brick.initialize(X, reference) || !Brick::compute(reference, u, kinematics))
      return;
    for (unsigned int q = 0; q < n_element_points; ++q)
      visit(first_point_ + q * layout_.n_point_history, reference.volume / n_element_points, kinematics.J,
            kinematics.F[q] * reference.jacobian, reference.inverse_jacobian);
    return;
  }
  ReferenceElement reference;
  MeanDilatationKinematics kinematics;
  compute_reference_element(X, reference);
  if (!compute_kinematics(reference, u, kinematics))
    return;
  double volume = 0.;
  for (const double w : reference.volumes)
    volume += w;
  for (unsigned int q = 0; q < n_element_points; ++q) {
    const Tensor<2, 3> inverse = compute_inverse_jacobian(reference, q);
    visit(first_point_ + q * layout_.n_point_history, reference.volumes[q],
          kinematics.current_volume / volume, kinematics.F_bar[q] * invert(inverse), inverse);
  }
}

template <class Number>
std::vector<PointState> ExplicitStorage<Number>::compute_states(const std::size_t element,
                                                                const double *displacements) const {
  std::vector<PointState> states;
  visit_points(element, displacements,
               [&](const std::size_t first, const double reference_volume, const double volume_ratio,
                   const Tensor<2, 3> &jacobian, const Tensor<2, 3> &inverse_reference) {
                 PointState state{reference_volume, volume_ratio, {}, 0., jacobian * inverse_reference};
                 std::size_t k = first;
                 if (is_rate()) {
                   for (const unsigned int place : {0, 1, 3, 4, 5})
                     state.tensor[symmetric_pairs[place][0]][symmetric_pairs[place][1]] =
                         history(element, k++);
                   state.tensor[2][2] = -state.tensor[0][0] - state.tensor[1][1];
                 } else if (is_single && !plastic_.has_alpha) {
                   state.tensor = symmetrize(state.F * transpose(state.F));
                 } else {
                   Tensor<2, 3> H;
                   for (const auto &pair : symmetric_pairs)
                     H[pair[0]][pair[1]] = H[pair[1]][pair[0]] = history(element, k++);
                   state.tensor = is_single ? symmetrize(H) + dealii::unit_symmetric_tensor<3>()
                                            : symmetrize(jacobian * H * transpose(jacobian));
                 }
                 if (plastic_.has_alpha)
                   state.equivalent_plastic_strain = get_in_parts(element, k);
                 k += plastic_.has_yield_stress ? 1 : 0;
                 for (std::size_t n = 0; n < plastic_.n_state; ++n)
                   state.flow[n] = get_in_parts(element, k);
                 states.push_back(state);
               });
  return states;
}

template <class Number>
void ExplicitStorage<Number>::set_hourglass(const std::size_t element, const double *displacements,
                                            const Tensor<2, 3> &jacobian, const bool is_forgotten) {
  const ElementVectors X = gather(element, reference_positions_.data()), u = gather(element, displacements);
  ElementVectors x;
  std::transform(X.begin(), X.end(), u.begin(), x.begin(), std::plus<>());
  const ModalGeometry reference(X), current(x);
  Tensor<2, 3> reference_jacobian;
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int i = 0; i < 3; ++i)
      reference_jacobian[i][k] = reference.modes[k][i];
  const Tensor<2, 3> inverse = invert(jacobian), inverse_reference = invert(reference_jacobian);
  for (unsigned int m = 0; m < 4; ++m) {
    Tensor<1, 3> strain = inverse * current.modes[3 + m];
    if (is_single) // strain relative to the reference, or zero
      strain = is_forgotten ? Tensor<1, 3>() : strain - inverse_reference * reference.modes[3 + m];
    for (unsigned int i = 0; i < 3; ++i)
      set_history(element, last::n + std::size_t{3} * m + i, strain[i]);
  }
}

template <class Number>
void ExplicitStorage<Number>::set_states(const std::size_t element, const double *displacements,
                                         const std::vector<PointState> &states,
                                         const std::vector<double> &yield_stress) {
  std::size_t q = 0;
  visit_points(
      element, displacements,
      [&](const std::size_t first, const double, const double volume_ratio, const Tensor<2, 3> &jacobian,
          const Tensor<2, 3> &) {
        const PointState &state = states[q];
        if (is_single)
          set_history(element, last::volume, volume_ratio - 1.);
        std::size_t k = first;
        if (is_rate())
          for (const unsigned int place : {0, 1, 3, 4, 5})
            set_history(element, k++, state.tensor[symmetric_pairs[place][0]][symmetric_pairs[place][1]]);
        else if (is_single) {
          for (const auto &pair : symmetric_pairs)
            set_history(element, k++, state.tensor[pair[0]][pair[1]] - (pair[0] == pair[1] ? 1. : 0.));
        } else {
          const Tensor<2, 3> inverse = invert(jacobian), b = state.tensor;
          const Tensor<2, 3> H = std::pow(volume_ratio, 2. / 3.) * inverse * b * transpose(inverse);
          for (const auto &pair : symmetric_pairs)
            set_history(element, k++, H[pair[0]][pair[1]]);
        }
        if (plastic_.has_alpha)
          set_in_parts(element, k, state.equivalent_plastic_strain);
        if (plastic_.has_yield_stress)
          set_history(element, k++, yield_stress[q]);
        for (std::size_t n = 0; n < plastic_.n_state; ++n)
          set_in_parts(element, k, state.flow[n]);
        if (plastic_.has_alpha && element_ == LaneElement::one_point)
          set_hourglass(element, displacements, jacobian, true);
        ++q;
      });
  repeat_last(element);
}

template <class Number>
void ExplicitStorage<Number>::renew(const double *displacements, const bool from_the_start) {
  if (!is_single)
    return;
  const bool is_volume_alone =
      element_ == LaneElement::mean_dilatation && (is_rate() || (plastic_.has_alpha && !from_the_start));
  for (std::size_t element = 0; element < n_elements_; ++element) {
    if (is_volume_alone) {
      ElementVectors x = gather(element, reference_positions_.data());
      const double reference = ModalGeometry(x).volume;
      const ElementVectors u = gather(element, displacements);
      std::transform(x.begin(), x.end(), u.begin(), x.begin(), std::plus<>());
      set_history(element, last::volume, ModalGeometry(x).volume / reference - 1.);
      repeat_last(element);
      continue;
    }
    visit_points(element, displacements,
                 [&](const std::size_t first, const double, const double volume_ratio,
                     const Tensor<2, 3> &jacobian, const Tensor<2, 3> &inverse_reference) {
                   set_history(element, last::volume, volume_ratio - 1.);
                   if (plastic_.has_alpha && !from_the_start)
                     return;
                   if (element_ == LaneElement::one_point)
                     set_hourglass(element, displacements, jacobian, false);
                   if (is_rate())
                     return;
                   const Tensor<2, 3> F = jacobian * inverse_reference;
                   const Tensor<2, 3> b = std::pow(volume_ratio, -2. / 3.) * F * transpose(F);
                   std::size_t k = first;
                   for (const auto &pair : symmetric_pairs)
                     set_history(element, k++, b[pair[0]][pair[1]] - (pair[0] == pair[1] ? 1. : 0.));
                 });
    repeat_last(element);
  }
}

template <class Number>
void ExplicitStorage<Number>::get_history(const std::size_t element, double *numbers) const {
  for (std::size_t k = 0; k < layout_.n_history; ++k)
    numbers[k] = history(element, k);
}

template <class Number>
void ExplicitStorage<Number>::set_history(const std::size_t element, const double *numbers) {
  for (std::size_t k = 0; k < layout_.n_history; ++k)
    set_history(element, k, numbers[k]);
  repeat_last(element);
}

template <class Number>
Tensor<2, 3> ExplicitStorage<Number>::inverse_reference(const ElementVectors &positions,
                                                        const unsigned int point) const {
  if (element_ == LaneElement::mean_dilatation) {
    ReferenceElement reference;
    compute_reference_element(positions, reference);
    return compute_inverse_jacobian(reference, point);
  }
  const ModalGeometry geometry(positions);
  Tensor<2, 3> jacobian;
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int i = 0; i < 3; ++i)
      jacobian[i][k] = geometry.modes[k][i];
  return invert(jacobian);
}

template <class Number>
void ExplicitStorage<Number>::set_parent_hourglass(const std::size_t element, const ParentElement &parent) {
  const ElementVectors own = gather(element, reference_positions_.data());
  std::array<std::array<double, 3>, 4> strain{}, shift{};
  const auto find_reference = [this](const ElementVectors &positions) {
    const ModalGeometry geometry(positions);
    const Tensor<2, 3> inverse = inverse_reference(positions, 0);
    std::array<Tensor<1, 3>, 4> modes;
    for (unsigned int m = 0; m < 4; ++m)
      modes[m] = inverse * geometry.modes[3 + m];
    return modes;
  };
  const auto of_parent = find_reference(parent.positions), of_own = find_reference(own);
  for (unsigned int m = 0; m < 4; ++m)
    for (unsigned int k = 0; k < 3; ++k) {
      strain[m][k] = parent.state[last::n + 3 * m + k];
      shift[m][k] = strain[m][k] - (is_single ? 0. : of_parent[m][k]);
    }
  shift = hourglass_of_child(shift, parent.child);
  for (unsigned int m = 0; m < 4; ++m)
    for (unsigned int k = 0; k < 3; ++k)
      set_history(element, last::n + std::size_t{3} * m + k, shift[m][k] + (is_single ? 0. : of_own[m][k]));
}

template <class Number>
void ExplicitStorage<Number>::set_parent_history(const std::size_t element, const ParentElement &parent,
                                                 const double *displacements) {
  const bool is_one_point = element_ == LaneElement::one_point;
  const unsigned int from = is_one_point ? 0 : parent.child;
  const double *const point = parent.state + first_point_ + from * layout_.n_point_history;
  const Tensor<2, 3> X_xi = invert(inverse_reference(parent.positions, from));
  Tensor<2, 3> C; // C_p⁻¹
  std::size_t k = 0;
  for (const auto &pair : symmetric_pairs)
    if (!is_rate())
      C[pair[0]][pair[1]] = C[pair[1]][pair[0]] = point[k++];
  C = X_xi * C * transpose(X_xi);
  if (is_one_point)
    set_parent_hourglass(element, parent);
  double ratio = 1., volume = 0.;
  visit_points(element, displacements,
               [&](const std::size_t first, const double reference_volume, const double volume_ratio,
                   const Tensor<2, 3> &, const Tensor<2, 3> &xi_X) {
                 ratio = volume_ratio;
                 volume += reference_volume * volume_ratio;
                 for (std::size_t i = 0; i < layout_.n_point_history; ++i)
                   set_history(element, first + i, point[i]);
                 if (is_rate() || is_single)
                   return;
                 const Tensor<2, 3> H = xi_X * C * transpose(xi_X);
                 std::size_t i = first;
                 for (const auto &pair : symmetric_pairs)
                   set_history(element, i++, H[pair[0]][pair[1]]);
               });
  constexpr double omega_of_child = 4.; // 4/(ρ L²)
  set_history(element, last::volume, is_single ? ratio - 1. : volume);
  set_history(element, last::omega, omega_of_child * parent.state[last::omega]);
  set_history(element, last::viscous_pressure, parent.state[last::viscous_pressure]);
  repeat_last(element);
}

template <class Number> void ExplicitStorage<Number>::repeat_last(const std::size_t element) {
  if (element + 1 == n_elements_)
    for (std::size_t e = n_elements_; e % n_lanes_ != 0; ++e)
      for (std::size_t k = 0; k < layout_.n_history; ++k)
        set_history(e, k, history(element, k));
}

template class ExplicitStorage<double>;
template class ExplicitStorage<float>;

} // namespace billet
