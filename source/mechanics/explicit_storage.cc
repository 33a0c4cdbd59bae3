// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/explicit_storage.h"

#include "billet/mechanics/modal_geometry.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;
using Element = ExplicitFormulation::Element;
using Kinematics = ExplicitFormulation::Kinematics;

namespace {

constexpr std::size_t n_last = 3; ///< what history keeps of the last call, see kernel.h

/// ∂ξ/∂X at a point: the gradient of the field that has the corners' coordinates ξ as nodal values.
Tensor<2, 3> compute_inverse_jacobian(const ReferenceElement &reference, const unsigned int q) {
  Tensor<2, 3> result;
  for (unsigned int a = 0; a < n_element_nodes; ++a)
    for (unsigned int k = 0; k < 3; ++k)
      for (unsigned int i = 0; i < 3; ++i)
        result[k][i] += corner(a, k) * reference.gradients[q][a][i];
  return result;
}

/// ∫ N_a dV; the points integrate it exactly.
std::array<double, n_element_nodes> compute_nodal_volumes(const ReferenceElement &reference) {
  std::array<double, n_element_nodes> volumes{};
  for (unsigned int a = 0; a < n_element_nodes; ++a)
    for (unsigned int q = 0; q < n_element_points; ++q) {
      double value = reference.volumes[q];
      for (unsigned int i = 0; i < 3; ++i)
        value *= 0.5 * (1. + corner(a, i) * corner(q, i) / std::sqrt(3.));
      volumes[a] += value;
    }
  return volumes;
}

/// Largest sum of the sizes in a row, a bound of a symmetric matrix's eigenvalues.
template <std::size_t n> double bound_by_rows(const std::array<std::array<double, n>, n> &matrix) {
  double largest = 0.;
  for (const auto &row : matrix) {
    double sum = 0.;
    for (const double entry : row)
      sum += std::abs(entry);
    largest = std::max(largest, sum);
  }
  return largest;
}

/// λ_max of J̄ᵀJ̄ per squared displacement, and of J̄ and the modes b and c together: modes are orthogonal, of
/// squared length 1/8.
void bound(const ModalGeometry &geometry, double &mean, double &all) {
  std::array<std::array<double, 3>, 3> mean_matrix{};
  std::array<std::array<double, 7>, 7> matrix{};
  for (unsigned int k = 0; k < 3; ++k) {
    for (unsigned int l = 0; l < 3; ++l) {
      for (const auto &row : geometry.beta)
        mean_matrix[k][l] += row[k] * row[l];
      matrix[k][l] = mean_matrix[k][l];
      matrix[k][3 + l] = matrix[3 + l][k] = geometry.beta[3 + l][k];
    }
  }
  for (unsigned int k = 3; k < 7; ++k)
    matrix[k][k] = 1.;
  mean = bound_by_rows(mean_matrix) / 8.;
  all = bound_by_rows(matrix) / 8.;
}

} // namespace

ExplicitStorage::ExplicitStorage(const unsigned int n_lanes, const ExplicitFormulation &formulation,
                                 const bool has_plasticity, const bool keeps_yield_stress)
    : n_lanes_(n_lanes), formulation_(formulation), has_plasticity_(has_plasticity),
      keeps_yield_stress_(keeps_yield_stress) {
  const bool is_rate = formulation.kinematics == Kinematics::hypoelastic;
  layout_.n_point_history = (is_rate ? 5 : 6) + (has_plasticity ? 1 : 0) + (keeps_yield_stress ? 1 : 0);
  if (formulation.element == Element::one_point) {
    layout_.n_constants = 28;
    layout_.n_history = n_last + 12 + layout_.n_point_history;
  } else {
    layout_.n_constants = is_rate ? 2 : 10;
    layout_.n_history = n_last + n_element_points * layout_.n_point_history;
  }
}

void ExplicitStorage::resize(const std::size_t n_elements) {
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

bool ExplicitStorage::initialize(const std::vector<std::array<unsigned int, n_element_nodes>> &elements,
                                 const double *reference_positions,
                                 const explicit_kernels::Material &material, const double yield_stress,
                                 std::size_t &offender) {
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
    if (!initialize_element(offender, material, yield_stress))
      return false;
  }
  // The lanes beyond the last element repeat it.
  for (std::size_t e = elements.size(); e % n_lanes_ != 0; ++e) {
    const std::size_t last = elements.size() - 1;
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      nodes_[index(e, a, n_element_nodes)] = nodes_[index(last, a, n_element_nodes)];
    for (std::size_t k = 0; k < layout_.n_constants; ++k)
      constant(e, k) = constant(last, k);
    for (std::size_t k = 0; k < layout_.n_history; ++k)
      history(e, k) = history(last, k);
  }
  return true;
}

ElementVectors ExplicitStorage::gather(const std::size_t element, const double *values) const {
  ElementVectors result;
  for (unsigned int a = 0; a < n_element_nodes; ++a)
    for (unsigned int i = 0; i < 3; ++i)
      result[3 * a + i] = values[4 * std::size_t{nodes_[index(element, a, n_element_nodes)]} + i];
  return result;
}

void ExplicitStorage::initialize_point(const std::size_t element, const std::size_t first,
                                       const Tensor<2, 3> &inverse_jacobian, const double yield_stress) {
  std::size_t k = first;
  if (formulation_.kinematics == Kinematics::hypoelastic)
    for (; k < first + 5; ++k)
      history(element, k) = 0.;
  else {
    const Tensor<2, 3> H = inverse_jacobian * transpose(inverse_jacobian);
    for (const auto &pair : symmetric_pairs)
      history(element, k++) = H[pair[0]][pair[1]];
  }
  if (has_plasticity_)
    history(element, k++) = 0.;
  if (keeps_yield_stress_)
    history(element, k) = yield_stress;
}

bool ExplicitStorage::initialize_element(const std::size_t element,
                                         const explicit_kernels::Material &material,
                                         const double yield_stress) {
  const ElementVectors positions = gather(element, reference_positions_.data());
  ReferenceElement reference;
  if (!compute_reference_element(positions, reference))
    return false;
  const auto nodal_volumes = compute_nodal_volumes(reference);
  const double smallest_mass =
      material.density * *std::min_element(nodal_volumes.begin(), nodal_volumes.end());
  double volume = 0., lambda = 0.;
  const auto bound_metric = [](const Tensor<2, 3> &inverse_jacobian) {
    const Tensor<2, 3> metric = inverse_jacobian * transpose(inverse_jacobian);
    double largest = 0.;
    for (unsigned int k = 0; k < 3; ++k)
      largest = std::max(largest, std::abs(metric[k][0]) + std::abs(metric[k][1]) + std::abs(metric[k][2]));
    return largest;
  };
  for (const double w : reference.volumes)
    volume += w;

  if (formulation_.element == Element::one_point) {
    const ModalGeometry geometry(positions);
    Tensor<2, 3> jacobian;
    for (unsigned int k = 0; k < 3; ++k)
      for (unsigned int i = 0; i < 3; ++i)
        jacobian[i][k] = geometry.modes[k][i];
    const double det = determinant(jacobian);
    if (!(det > 0.))
      return false;
    const Tensor<2, 3> inverse = invert(jacobian);
    double mean = 0., all = 0.;
    bound(geometry, mean, all);
    lambda = volume * bound_metric(inverse) * mean;
    constant(element, 0) = volume;
    constant(element, 1) = 1. / det;
    constant(element, 2) = mean / smallest_mass;
    constant(element, 3) = all / smallest_mass;
    for (unsigned int m = 0; m < 6; ++m)
      for (unsigned int k = 0; k < 3; ++k)
        constant(element, 4 + 3 * m + k) = geometry.beta[m][k];
    unsigned int place = 22;
    for (unsigned int k = 0; k < 3; ++k)
      for (unsigned int l = 0; l < 3; ++l)
        if (k != l)
          constant(element, place++) = geometry.modes[k].norm() / geometry.modes[l].norm();
    for (unsigned int m = 0; m < 4; ++m)
      for (unsigned int k = 0; k < 3; ++k)
        history(element, n_last + std::size_t{3} * m + k) = (inverse * geometry.modes[3 + m])[k];
    initialize_point(element, n_last + 12, inverse, yield_stress);
  } else {
    constant(element, 0) = volume;
    constant(element, 1) = 1. / smallest_mass;
    for (unsigned int q = 0; q < n_element_points; ++q) {
      const Tensor<2, 3> inverse = compute_inverse_jacobian(reference, q);
      lambda = std::max(lambda, reference.volumes[q] * bound_metric(inverse));
      if (formulation_.kinematics != Kinematics::hypoelastic)
        constant(element, 2 + q) = reference.volumes[q];
      initialize_point(element, n_last + q * layout_.n_point_history, inverse, yield_stress);
    }
  }
  history(element, 0) = volume;
  history(element, 1) = lambda / smallest_mass;
  history(element, 2) = 0.;
  return true;
}

explicit_kernels::Elements ExplicitStorage::elements() {
  return {n_elements_,       nodes_.data(),   reference_positions_.data(),
          constants_.data(), history_.data(), layout_};
}

explicit_kernels::Elements ExplicitStorage::copy_element(const std::size_t element, Copy &copy) const {
  copy.nodes.resize(std::size_t{n_element_nodes} * n_lanes_);
  copy.constants.resize(layout_.n_constants * n_lanes_);
  copy.history.resize(layout_.n_history * n_lanes_);
  for (std::size_t lane = 0; lane < n_lanes_; ++lane) {
    for (std::size_t a = 0; a < n_element_nodes; ++a)
      copy.nodes[a * n_lanes_ + lane] = nodes_[index(element, a, n_element_nodes)];
    for (std::size_t k = 0; k < layout_.n_constants; ++k)
      copy.constants[k * n_lanes_ + lane] = constant(element, k);
    for (std::size_t k = 0; k < layout_.n_history; ++k)
      copy.history[k * n_lanes_ + lane] = history(element, k);
  }
  return {1,      copy.nodes.data(), reference_positions_.data(), copy.constants.data(), copy.history.data(),
          layout_};
}

double ExplicitStorage::scale_mass(const std::size_t element, const double factor) {
  const double volume = constant(element, 0) * density_factors_[element];
  density_factors_[element] *= factor;
  // The lanes beyond the last element repeat it.
  const bool is_last = element + 1 == n_elements_;
  for (std::size_t e = element; e == element || (is_last && e % n_lanes_ != 0); ++e) {
    if (formulation_.element == Element::one_point) {
      constant(e, 2) /= factor;
      constant(e, 3) /= factor;
    } else
      constant(e, 1) /= factor;
    history(e, 1) /= factor;
  }
  return volume * (factor - 1.);
}

void ExplicitStorage::add_masses(const double density, double *masses) const {
  for (std::size_t element = 0; element < n_elements_; ++element) {
    ReferenceElement reference;
    compute_reference_element(gather(element, reference_positions_.data()), reference);
    const auto volumes = compute_nodal_volumes(reference);
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      masses[nodes_[index(element, a, n_element_nodes)]] += density * density_factors_[element] * volumes[a];
  }
}

template <class Visit>
void ExplicitStorage::visit_points(const std::size_t element, const double *displacements,
                                   const Visit &visit) const {
  const ElementVectors X = gather(element, reference_positions_.data()), u = gather(element, displacements);
  if (formulation_.element == Element::one_point) {
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
      visit(n_last + 12, reference.volume, J, jacobian);
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
  for (unsigned int q = 0; q < n_element_points; ++q)
    visit(n_last + q * layout_.n_point_history, reference.volumes[q], kinematics.current_volume / volume,
          kinematics.F_bar[q] * invert(compute_inverse_jacobian(reference, q)));
}

std::vector<PointState> ExplicitStorage::compute_states(const std::size_t element,
                                                        const double *displacements) const {
  const bool is_rate = formulation_.kinematics == Kinematics::hypoelastic;
  std::vector<PointState> states;
  visit_points(element, displacements,
               [&](const std::size_t first, const double reference_volume, const double volume_ratio,
                   const Tensor<2, 3> &jacobian) {
                 PointState state{reference_volume, volume_ratio, {}, 0.};
                 std::size_t k = first;
                 if (is_rate) {
                   for (const unsigned int place : {0, 1, 3, 4, 5})
                     state.tensor[symmetric_pairs[place][0]][symmetric_pairs[place][1]] =
                         history(element, k++);
                   state.tensor[2][2] = -state.tensor[0][0] - state.tensor[1][1];
                 } else {
                   Tensor<2, 3> H;
                   for (const auto &pair : symmetric_pairs)
                     H[pair[0]][pair[1]] = H[pair[1]][pair[0]] = history(element, k++);
                   state.tensor = symmetrize(jacobian * H * transpose(jacobian));
                 }
                 if (has_plasticity_)
                   state.equivalent_plastic_strain = history(element, k);
                 states.push_back(state);
               });
  return states;
}

void ExplicitStorage::set_states(const std::size_t element, const double *displacements,
                                 const std::vector<PointState> &states,
                                 const std::vector<double> &yield_stress) {
  std::size_t q = 0;
  visit_points(
      element, displacements,
      [&](const std::size_t first, const double, const double volume_ratio, const Tensor<2, 3> &jacobian) {
        const PointState &state = states[q];
        std::size_t k = first;
        if (formulation_.kinematics == Kinematics::hypoelastic)
          for (const unsigned int place : {0, 1, 3, 4, 5})
            history(element, k++) = state.tensor[symmetric_pairs[place][0]][symmetric_pairs[place][1]];
        else {
          const Tensor<2, 3> inverse = invert(jacobian), b = state.tensor;
          const Tensor<2, 3> H = std::pow(volume_ratio, 2. / 3.) * inverse * b * transpose(inverse);
          for (const auto &pair : symmetric_pairs)
            history(element, k++) = H[pair[0]][pair[1]];
        }
        if (has_plasticity_)
          history(element, k++) = state.equivalent_plastic_strain;
        if (keeps_yield_stress_)
          history(element, k) = yield_stress[q];
        if (has_plasticity_ && formulation_.element == Element::one_point) {
          ElementVectors x = gather(element, reference_positions_.data());
          const ElementVectors u = gather(element, displacements);
          std::transform(x.begin(), x.end(), u.begin(), x.begin(), std::plus<>());
          const ModalGeometry current(x);
          const Tensor<2, 3> inverse = invert(jacobian);
          for (unsigned int m = 0; m < 4; ++m)
            for (unsigned int i = 0; i < 3; ++i)
              history(element, n_last + std::size_t{3} * m + i) = (inverse * current.modes[3 + m])[i];
        }
        ++q;
      });
  repeat_last(element);
}

void ExplicitStorage::get_history(const std::size_t element, double *numbers) const {
  for (std::size_t k = 0; k < layout_.n_history; ++k)
    numbers[k] = history(element, k);
}

void ExplicitStorage::set_history(const std::size_t element, const double *numbers) {
  for (std::size_t k = 0; k < layout_.n_history; ++k)
    history(element, k) = numbers[k];
  repeat_last(element);
}

void ExplicitStorage::repeat_last(const std::size_t element) {
  if (element + 1 == n_elements_)
    for (std::size_t e = n_elements_; e % n_lanes_ != 0; ++e)
      for (std::size_t k = 0; k < layout_.n_history; ++k)
        history(e, k) = history(element, k);
}

} // namespace billet
