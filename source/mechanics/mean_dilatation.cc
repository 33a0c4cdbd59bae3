// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/mean_dilatation.h"

#include <cmath>

namespace billet {

using dealii::SymmetricTensor;
using dealii::Tensor;

namespace {

using NodalGradients = std::array<std::array<double, 3>, n_element_nodes>;

/// Returns ∂N_a/∂ξ_i on the bi-unit cube at the eight points (±1/√3, ±1/√3, ±1/√3).
std::array<NodalGradients, n_element_points> make_shape_gradients() {
  std::array<NodalGradients, n_element_points> gradients{};
  const double g = 1. / std::sqrt(3.);
  const auto sign = [](const unsigned int corner, const unsigned int axis) {
    return ((corner >> axis) & 1U) != 0U ? 1. : -1.;
  };
  for (unsigned int q = 0; q < n_element_points; ++q)
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      for (unsigned int i = 0; i < 3; ++i) {
        double value = 0.125 * sign(a, i);
        for (unsigned int j = 0; j < 3; ++j)
          if (j != i)
            value *= 1. + sign(a, j) * sign(q, j) * g;
        gradients[q][a][i] = value;
      }
  return gradients;
}

const std::array<NodalGradients, n_element_points> shape_gradients = make_shape_gradients();

/// Computes ∂N_a/∂y from ∂N_a/∂ξ; the Jacobian is ∂y/∂ξ.
void transform_gradients(const NodalGradients &from, const Tensor<2, 3> &inverse_jacobian,
                         NodalGradients &to) {
  for (unsigned int a = 0; a < n_element_nodes; ++a)
    for (unsigned int i = 0; i < 3; ++i)
      to[a][i] = from[a][0] * inverse_jacobian[0][i] + from[a][1] * inverse_jacobian[1][i] +
                 from[a][2] * inverse_jacobian[2][i];
}

Tensor<2, 3> gradient_of(const ElementVectors &values, const NodalGradients &gradients) {
  Tensor<2, 3> result;
  for (unsigned int a = 0; a < n_element_nodes; ++a)
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        result[i][j] += values[3 * a + i] * gradients[a][j];
  return result;
}

} // namespace

bool compute_reference_element(const ElementVectors &positions, ReferenceElement &element) {
  for (unsigned int q = 0; q < n_element_points; ++q) {
    const Tensor<2, 3> jacobian = gradient_of(positions, shape_gradients[q]);
    const double det = dealii::determinant(jacobian);
    if (!(det > 0.))
      return false;
    element.volumes[q] = det; // the Gauss weights of the bi-unit cube are 1
    transform_gradients(shape_gradients[q], dealii::invert(jacobian), element.gradients[q]);
  }
  return true;
}

bool compute_kinematics(const ReferenceElement &element, const ElementVectors &displacements,
                        MeanDilatationKinematics &kinematics) {
  std::array<double, n_element_points> J{};
  double reference_volume = 0.;
  kinematics.current_volume = 0.;
  kinematics.mean_divergence.fill(0.);
  for (unsigned int q = 0; q < n_element_points; ++q) {
    Tensor<2, 3> &F = kinematics.F_bar[q];
    F = gradient_of(displacements, element.gradients[q]);
    for (unsigned int i = 0; i < 3; ++i)
      F[i][i] += 1.;
    J[q] = dealii::determinant(F);
    if (!(J[q] > 0.) || !std::isfinite(J[q]))
      return false;
    transform_gradients(element.gradients[q], dealii::invert(F), kinematics.gradients[q]);
    kinematics.current_volumes[q] = J[q] * element.volumes[q];
    reference_volume += element.volumes[q];
    kinematics.current_volume += kinematics.current_volumes[q];
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      for (unsigned int i = 0; i < 3; ++i)
        kinematics.mean_divergence[3 * a + i] +=
            kinematics.current_volumes[q] * kinematics.gradients[q][a][i];
  }
  for (double &b : kinematics.mean_divergence)
    b /= kinematics.current_volume;
  const double J_bar = kinematics.volume_ratio = kinematics.current_volume / reference_volume;
  for (unsigned int q = 0; q < n_element_points; ++q)
    kinematics.F_bar[q] *= std::cbrt(J_bar / J[q]);
  return true;
}

void add_internal_force(const ReferenceElement &element, const MeanDilatationKinematics &kinematics,
                        const std::array<SymmetricTensor<2, 3>, n_element_points> &tau,
                        ElementVectors &force) {
  double volumetric = 0.; // Π
  for (unsigned int q = 0; q < n_element_points; ++q) {
    const double w = element.volumes[q];
    volumetric += w * dealii::trace(tau[q]) / 3.;
    const Tensor<2, 3> weighted = w * static_cast<Tensor<2, 3>>(dealii::deviator(tau[q]));
    for (unsigned int a = 0; a < n_element_nodes; ++a) {
      const auto &grad = kinematics.gradients[q][a];
      for (unsigned int i = 0; i < 3; ++i)
        force[3 * a + i] += weighted[i][0] * grad[0] + weighted[i][1] * grad[1] + weighted[i][2] * grad[2];
    }
  }
  for (unsigned int k = 0; k < n_element_dofs; ++k)
    force[k] += volumetric * kinematics.mean_divergence[k];
}

namespace {

/// Computes the tangent. If it is symmetric, only the upper triangle is computed, then mirrored.
template <bool is_symmetric>
void compute_tangent(const ReferenceElement &element, const MeanDilatationKinematics &kinematics,
                     const std::array<SymmetricTensor<2, 3>, n_element_points> &tau,
                     const std::array<SpatialModuli, n_element_points> &moduli, ElementMatrix &matrix) {
  matrix.fill(0.);
  double volumetric = 0.; // Π
  for (unsigned int q = 0; q < n_element_points; ++q)
    volumetric += element.volumes[q] * dealii::trace(tau[q]) / 3.;
  const double mean_pressure = volumetric / kinematics.current_volume; // Π / v

  for (unsigned int q = 0; q < n_element_points; ++q) {
    const double w = element.volumes[q];
    const double current = kinematics.current_volumes[q];
    const double trace = dealii::trace(tau[q]);
    const auto &gradients = kinematics.gradients[q];

    // Columns of B̄ = sym ∇N + (1/3) I ⊗ (∇̄N − ∇N), of w c B̄, of w τ ∇N, and θ = (∇̄N − ∇N)/3.
    std::array<std::array<double, n_element_dofs>, 6> B{}, cB{};
    std::array<double, n_element_dofs> theta{}, divergence{}, tau_grad{};
    for (unsigned int a = 0; a < n_element_nodes; ++a) {
      const auto &g = gradients[a];
      const unsigned int k = 3 * a;
      for (unsigned int i = 0; i < 3; ++i) {
        divergence[k + i] = g[i];
        theta[k + i] = (kinematics.mean_divergence[k + i] - g[i]) / 3.;
        tau_grad[k + i] = w * (tau[q][i][0] * g[0] + tau[q][i][1] * g[1] + tau[q][i][2] * g[2]);
        for (unsigned int j = 0; j < 3; ++j)
          B[j][k + i] = theta[k + i] + (i == j ? g[i] : 0.);
      }
      B[3][k] = g[1];
      B[3][k + 1] = g[0];
      B[4][k] = g[2];
      B[4][k + 2] = g[0];
      B[5][k + 1] = g[2];
      B[5][k + 2] = g[1];
    }
    for (unsigned int i = 0; i < 6; ++i)
      for (unsigned int j = 0; j < 6; ++j) {
        const double c = w * moduli[q][i][j];
        for (unsigned int k = 0; k < n_element_dofs; ++k)
          cB[i][k] += c * B[j][k];
      }

    const double swap = w * trace / 3. - mean_pressure * current; // factor of tr(δL L)
    const double dilate = mean_pressure * current;                // factor of tr δL tr L
    for (unsigned int r = 0; r < n_element_dofs; ++r) {
      const unsigned int a = r / 3, i = r % 3;
      double *row = matrix.data() + static_cast<std::size_t>(r) * n_element_dofs;
      const double theta_factor = 2. * tau_grad[r] + 2. * w * trace * theta[r];
      const double tau_factor = 2. * theta[r];
      const double div_factor = dilate * divergence[r];
      for (unsigned int c = is_symmetric ? r : 0; c < n_element_dofs; ++c)
        row[c] += B[0][r] * cB[0][c] + B[1][r] * cB[1][c] + B[2][r] * cB[2][c] + B[3][r] * cB[3][c] +
                  B[4][r] * cB[4][c] + B[5][r] * cB[5][c] + theta_factor * theta[c] +
                  tau_factor * tau_grad[c] + div_factor * divergence[c];
      for (std::size_t b = is_symmetric ? a : 0; b < n_element_nodes; ++b) {
        const auto &g_a = gradients[a];
        const auto &g_b = gradients[b];
        // tr(δL L) couples (a, i) and (b, j) through ∂N_a/∂x_j ∂N_b/∂x_i.
        for (unsigned int j = 0; j < 3; ++j)
          if (!is_symmetric || 3 * b + j >= r)
            row[3 * b + j] += swap * g_a[j] * g_b[i];
        if (!is_symmetric || 3 * b + i >= r)
          row[3 * b + i] +=
              g_a[0] * tau_grad[3 * b] + g_a[1] * tau_grad[3 * b + 1] + g_a[2] * tau_grad[3 * b + 2];
      }
    }
  }

  for (unsigned int r = 0; r < n_element_dofs; ++r)
    for (unsigned int c = is_symmetric ? r : 0; c < n_element_dofs; ++c) {
      const double value = matrix[static_cast<std::size_t>(r) * n_element_dofs + c] -
                           volumetric * kinematics.mean_divergence[r] * kinematics.mean_divergence[c];
      matrix[static_cast<std::size_t>(r) * n_element_dofs + c] = value;
      if (is_symmetric)
        matrix[static_cast<std::size_t>(c) * n_element_dofs + r] = value;
    }
}

} // namespace

void compute_internal_tangent(const ReferenceElement &element, const MeanDilatationKinematics &kinematics,
                              const std::array<SymmetricTensor<2, 3>, n_element_points> &tau,
                              const std::array<SpatialModuli, n_element_points> &moduli,
                              ElementMatrix &matrix) {
  compute_tangent<true>(element, kinematics, tau, moduli, matrix);
}

void compute_unsymmetric_internal_tangent(const ReferenceElement &element,
                                          const MeanDilatationKinematics &kinematics,
                                          const std::array<SymmetricTensor<2, 3>, n_element_points> &tau,
                                          const std::array<SpatialModuli, n_element_points> &moduli,
                                          ElementMatrix &matrix) {
  compute_tangent<false>(element, kinematics, tau, moduli, matrix);
}

} // namespace billet
