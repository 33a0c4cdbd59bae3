// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/one_point.h"

#include <cmath>

namespace billet {

using dealii::SymmetricTensor;
using dealii::Tensor;

namespace {

constexpr std::size_t n_modal_dofs = std::size_t{3} * n_element_modes;
using ModalMatrix = std::array<double, n_modal_dofs * n_modal_dofs>;
using ModalForces = std::array<std::array<double, 3>, n_element_modes>;

double contract(const OnePointElement::HourglassVector &a, const OnePointElement::HourglassVector &b) {
  double sum = 0.;
  for (unsigned int m = 0; m < 4; ++m)
    for (unsigned int k = 0; k < 3; ++k)
      sum += a[m][k] * b[m][k];
  return sum;
}

/// Returns J̄⁻¹ (b_1, b_2, b_3, c).
OnePointElement::HourglassVector pull_modes(const Tensor<2, 3> &inverse, const ModalGeometry &geometry) {
  OnePointElement::HourglassVector strain;
  for (unsigned int m = 0; m < 4; ++m) {
    const Tensor<1, 3> pulled = inverse * geometry.modes[3 + m];
    for (unsigned int k = 0; k < 3; ++k)
      strain[m][k] = pulled[k];
  }
  return strain;
}

/// Computes stresses and energy, see hourglass::respond().
double respond(const hourglass::Moduli<double> &moduli, const hourglass::Metric<double> &metric,
               const OnePointElement::HourglassVector &strain, OnePointElement::HourglassVector &stress) {
  double h[4][3], s[4][3];
  for (unsigned int m = 0; m < 4; ++m)
    for (unsigned int k = 0; k < 3; ++k)
      h[m][k] = strain[m][k];
  const double energy = hourglass::respond(moduli, metric, h, s);
  for (unsigned int m = 0; m < 4; ++m)
    for (unsigned int k = 0; k < 3; ++k)
      stress[m][k] = s[m][k];
  return energy;
}

/// Transforms rows of modes to rows of nodes, x_m = Σ_a mode_values[m][a] x_a/8. The row of a node
/// is the signed sum of the modes' rows, computed by sums and differences over the three
/// directions.
template <std::size_t width>
std::array<double, n_element_dofs * width>
scatter_rows(const std::array<double, n_modal_dofs * width> &modal) {
  constexpr std::size_t n = 3 * width;
  std::array<double, n_element_dofs * width> rows{};
  for (std::size_t m = 0; m < n_element_modes; ++m)
    for (std::size_t k = 0; k < n; ++k)
      rows[mode_places[m] * n + k] = 0.125 * modal[m * n + k];
  for (std::size_t step = 1; step < n_element_nodes; step *= 2)
    for (std::size_t a = 0; a < n_element_nodes; ++a)
      if ((a & step) == 0) {
        double *low = rows.data() + a * n, *high = low + step * n;
        for (std::size_t k = 0; k < n; ++k) {
          const double mean = low[k], slope = high[k];
          low[k] = mean - slope;
          high[k] = mean + slope;
        }
      }
  return rows;
}

/// Transforms the stiffness from modes to nodes.
void scatter(const ModalMatrix &modal, ElementMatrix &matrix) {
  const auto half = scatter_rows<n_modal_dofs>(modal);
  std::array<double, n_modal_dofs * n_element_dofs> transposed;
  for (std::size_t r = 0; r < n_element_dofs; ++r)
    for (std::size_t c = 0; c < n_modal_dofs; ++c)
      transposed[c * n_element_dofs + r] = half[r * n_modal_dofs + c];
  const auto whole = scatter_rows<n_element_dofs>(transposed);
  for (std::size_t r = 0; r < n_element_dofs; ++r)
    for (std::size_t c = 0; c < n_element_dofs; ++c)
      matrix[c * n_element_dofs + r] = whole[r * n_element_dofs + c];
}

void add_mean_tangent(const double volume, const Gradients<n_linear_modes> &gradients,
                      const SymmetricTensor<2, 3> &tau, const SpatialModuli &moduli, ModalMatrix &matrix) {
  add_point_tangent(volume, gradients, tau, moduli, matrix.data(), n_modal_dofs);
}

void add_mean_tangent(const double volume, const Gradients<n_linear_modes> &gradients,
                      const SymmetricTensor<2, 3> &tau, const GradientModuli &moduli, ModalMatrix &matrix) {
  auto rates = multiply_gradients(moduli, gradients);
  for (unsigned int k = 0; k < 3 * n_linear_modes; ++k)
    for (unsigned int i = 0; i < 3; ++i)
      rates[i][k] += moduli.volumetric * gradients[k / 3][k % 3];
  add_point_tangent(volume, gradients, tau, rates, matrix.data(), n_modal_dofs);
}

} // namespace

void OnePointElement::store(const History &history, double *numbers) {
  for (unsigned int k = 0; k < 12; ++k)
    numbers[k] = history.shift[k / 3][k % 3];
}

OnePointElement::History OnePointElement::restore(const double *numbers) {
  History history;
  for (unsigned int k = 0; k < 12; ++k)
    history.shift[k / 3][k % 3] = numbers[k];
  return history;
}

bool OnePointElement::initialize(const ElementVectors &positions, Reference &reference) {
  ReferenceElement points; // a brick that is invalid with eight points is rejected with one, too
  if (!compute_reference_element(positions, points))
    return false;
  const ModalGeometry geometry(positions);
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int i = 0; i < 3; ++i)
      reference.jacobian[i][k] = geometry.modes[k][i];
  if (!(dealii::determinant(reference.jacobian) > 0.))
    return false;
  reference.beta = geometry.beta;
  reference.volume = geometry.volume;
  reference.inverse_jacobian = dealii::invert(reference.jacobian);
  reference.strain = pull_modes(reference.inverse_jacobian, geometry);
  for (unsigned int k = 0; k < 3; ++k) {
    reference.metric.square[k] = geometry.modes[k].norm_square();
    reference.metric.product[k] = geometry.modes[(k + 1) % 3] * geometry.modes[(k + 2) % 3];
  }
  reference.metric.complete([](const double x) { return 1. / x; });
  return true;
}

bool OnePointElement::compute(const Reference &reference, const ElementVectors &displacements,
                              Kinematics &kinematics) {
  // Modes are linear in the positions; only those of the displacements are needed here.
  const auto moved = compute_modes(displacements);
  Tensor<2, 3> H; // F̄ − 1
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int m = 0; m < n_linear_modes; ++m)
        H[i][k] += reference.beta[m][k] * moved[m][i];
  H = H * reference.inverse_jacobian;
  kinematics.F = H;
  for (unsigned int i = 0; i < 3; ++i)
    kinematics.F[i][i] += 1.;
  kinematics.J = dealii::determinant(kinematics.F);
  if (!(kinematics.J > 0.) || !std::isfinite(kinematics.J))
    return false;
  kinematics.volume = kinematics.J * reference.volume;
  kinematics.inverse_jacobian = reference.inverse_jacobian * dealii::invert(kinematics.F);
  const Tensor<2, 3> &Z = kinematics.inverse_jacobian;
  for (unsigned int m = 0; m < n_linear_modes; ++m)
    for (unsigned int i = 0; i < 3; ++i)
      kinematics.gradients[m][i] =
          Z[0][i] * reference.beta[m][0] + Z[1][i] * reference.beta[m][1] + Z[2][i] * reference.beta[m][2];
  // J̄⁻¹ (b_0 + δb), b_0 = J̄_0 ĥ_0, without round-off in the undeformed element
  Tensor<2, 3> carried = dealii::invert(kinematics.F);
  for (unsigned int i = 0; i < 3; ++i)
    carried[i][i] -= 1.;
  carried = reference.inverse_jacobian * carried * reference.jacobian;
  for (unsigned int m = 0; m < 4; ++m)
    for (unsigned int k = 0; k < 3; ++k) {
      double sum = reference.strain[m][k];
      for (unsigned int i = 0; i < 3; ++i)
        sum += carried[k][i] * reference.strain[m][i] + Z[k][i] * moved[3 + m][i];
      kinematics.strain[m][k] = sum;
    }
  return true;
}

OnePointElement::Stabilisation OnePointElement::stabilise(const Reference &reference,
                                                          const Kinematics &kinematics,
                                                          const History &history_n) const {
  Stabilisation result;
  for (unsigned int m = 0; m < 4; ++m)
    for (unsigned int k = 0; k < 3; ++k)
      result.strain[m][k] = kinematics.strain[m][k] - reference.strain[m][k] - history_n.shift[m][k];
  result.energy = reference.volume * respond(moduli_, reference.metric, result.strain, result.stress);
  for (auto &row : result.stress)
    for (double &entry : row)
      entry *= reference.volume;
  return result;
}

OnePointElement::History OnePointElement::flow(const Stabilisation &stabilisation, const History &history_n) {
  History history = history_n;
  const double lost = 1. - stabilisation.yield.share;
  for (unsigned int m = 0; m < 4; ++m)
    for (unsigned int k = 0; k < 3; ++k)
      history.shift[m][k] += lost * stabilisation.strain[m][k];
  return history;
}

OnePointElement::History OnePointElement::find_history(const Reference &reference,
                                                       const Kinematics &kinematics) {
  History history;
  for (unsigned int m = 0; m < 4; ++m)
    for (unsigned int k = 0; k < 3; ++k)
      history.shift[m][k] = kinematics.strain[m][k] - reference.strain[m][k];
  return history;
}

void OnePointElement::add_force(const Reference &reference, const Kinematics &kinematics,
                                const SymmetricTensor<2, 3> &tau, const Stabilisation &stabilisation,
                                ElementVectors &force) {
  ModalForces modal{};
  const auto tau_g = multiply_gradients(tau, kinematics.gradients);
  const Tensor<2, 3> &Z = kinematics.inverse_jacobian;
  std::array<std::array<double, 3>, 3> mean_forces{}; // forces of the columns of J̄
  for (unsigned int m = 0; m < 4; ++m)
    for (unsigned int i = 0; i < 3; ++i) {
      const double t = stabilisation.yield.share *
                       (Z[0][i] * stabilisation.stress[m][0] + Z[1][i] * stabilisation.stress[m][1] +
                        Z[2][i] * stabilisation.stress[m][2]);
      modal[3 + m][i] = t;
      for (unsigned int k = 0; k < 3; ++k)
        mean_forces[k][i] -= t * kinematics.strain[m][k];
    }
  for (unsigned int m = 0; m < n_linear_modes; ++m)
    for (unsigned int i = 0; i < 3; ++i) {
      modal[m][i] += reference.volume * tau_g[3 * m + i];
      for (unsigned int k = 0; k < 3; ++k)
        modal[m][i] += mean_forces[k][i] * reference.beta[m][k];
    }
  for (unsigned int a = 0; a < n_element_nodes; ++a)
    for (unsigned int m = 0; m < n_element_modes; ++m)
      for (unsigned int i = 0; i < 3; ++i)
        force[3 * a + i] += 0.125 * mode_values[m][a] * modal[m][i];
}

template <class Moduli>
void OnePointElement::compute_tangent(const Reference &reference, const Kinematics &kinematics,
                                      const SymmetricTensor<2, 3> &tau, const Moduli &moduli,
                                      const Stabilisation &stabilisation, ElementMatrix &matrix) const {
  ModalMatrix modal{};
  add_mean_tangent(reference.volume, kinematics.gradients, tau, moduli, modal);

  const SharedYield &yield = stabilisation.yield;
  // Change of δτ by the trial's δ(energy).
  const auto flow =
      multiply_gradients(dealii::deviator(tau) * (yield.slope / yield.share), kinematics.gradients);

  const Tensor<2, 3> &Z = kinematics.inverse_jacobian;
  const HourglassVector &c = kinematics.strain, &s = stabilisation.stress;
  HourglassVector t; // forces of the modes b and c
  for (unsigned int p = 0; p < 4; ++p)
    for (unsigned int i = 0; i < 3; ++i)
      t[p][i] = yield.share * (Z[0][i] * s[p][0] + Z[1][i] * s[p][1] + Z[2][i] * s[p][2]);
  const double factor = yield.share * reference.volume;
  for (unsigned int m = 0; m < n_element_modes; ++m)
    for (unsigned int i = 0; i < 3; ++i) {
      // Unit variation of component i of mode m: δJ̄ = e_i ⊗ β, δ(b_p) = e_i if p is m − 3; δc = Z
      // (δb − δJ̄ c).
      const std::array<double, 3> beta =
          m < n_linear_modes ? reference.beta[m] : std::array<double, 3>{0., 0., 0.};
      const std::array<double, 3> gradient =
          m < n_linear_modes ? kinematics.gradients[m] : std::array<double, 3>{0., 0., 0.};
      HourglassVector dc;
      for (unsigned int p = 0; p < 4; ++p) {
        const double share =
            (p + 3 == m ? 1. : 0.) - (beta[0] * c[p][0] + beta[1] * c[p][1] + beta[2] * c[p][2]);
        for (unsigned int k = 0; k < 3; ++k)
          dc[p][k] = share * Z[k][i];
      }
      HourglassVector ds;
      respond(moduli_, reference.metric, dc, ds);
      const double energy_rate = contract(s, dc);
      const double share_rate = yield.rate[i][0] * gradient[0] + yield.rate[i][1] * gradient[1] +
                                yield.rate[i][2] * gradient[2] + yield.slope * energy_rate / reference.volume;
      std::array<std::array<double, 3>, 3> mean_rates{};
      ModalForces rates{};
      for (unsigned int p = 0; p < 4; ++p) {
        for (unsigned int k = 0; k < 3; ++k)
          ds[p][k] = factor * ds[p][k] + share_rate * s[p][k];
        for (unsigned int j = 0; j < 3; ++j) {
          // δt = Zᵀ δs − Zᵀ δJ̄ᵀ t, Zᵀ β = gradient
          const double dt =
              Z[0][j] * ds[p][0] + Z[1][j] * ds[p][1] + Z[2][j] * ds[p][2] - gradient[j] * t[p][i];
          rates[3 + p][j] = dt;
          for (unsigned int k = 0; k < 3; ++k)
            mean_rates[k][j] -= dt * c[p][k] + t[p][j] * dc[p][k];
        }
      }
      for (unsigned int n = 0; n < n_linear_modes; ++n)
        for (unsigned int j = 0; j < 3; ++j) {
          rates[n][j] += energy_rate * flow[std::size_t{3} * n + j];
          for (unsigned int k = 0; k < 3; ++k)
            rates[n][j] += mean_rates[k][j] * reference.beta[n][k];
        }
      for (std::size_t n = 0; n < n_element_modes; ++n)
        for (std::size_t j = 0; j < 3; ++j)
          modal[(3 * n + j) * n_modal_dofs + std::size_t{3} * m + i] += rates[n][j];
    }
  scatter(modal, matrix);
}

template void OnePointElement::compute_tangent(const Reference &, const Kinematics &,
                                               const SymmetricTensor<2, 3> &, const SpatialModuli &,
                                               const Stabilisation &, ElementMatrix &) const;
template void OnePointElement::compute_tangent(const Reference &, const Kinematics &,
                                               const SymmetricTensor<2, 3> &, const GradientModuli &,
                                               const Stabilisation &, ElementMatrix &) const;

} // namespace billet
