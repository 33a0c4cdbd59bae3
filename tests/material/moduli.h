// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_MATERIAL_MODULI_H
#define BILLET_TESTS_MATERIAL_MODULI_H

#include "../sample_laws.h"
#include "../testing.h"

#include "billet/material/elastic.h"

/// Spatial moduli and the stress rate that they promise, at states with chosen principal stretches.
namespace billet::testing {

using dealii::SymmetricTensor;
using dealii::Tensor;

inline const Tensor<2, 3> unit = dealii::unit_symmetric_tensor<3>();

inline double norm(const SpatialModuli &c) {
  double sum = 0.;
  for (const auto &row : c)
    for (const double entry : row)
      sum += entry * entry;
  return std::sqrt(sum);
}

inline double distance(const SpatialModuli &c, const SpatialModuli &d) {
  SpatialModuli difference;
  for (unsigned int i = 0; i < 6; ++i)
    for (unsigned int j = 0; j < 6; ++j)
      difference[i][j] = c[i][j] - d[i][j];
  return norm(difference);
}

inline double asymmetry(const SpatialModuli &c) {
  SpatialModuli transposed;
  for (unsigned int i = 0; i < 6; ++i)
    for (unsigned int j = 0; j < 6; ++j)
      transposed[i][j] = c[j][i];
  return distance(c, transposed) / norm(c);
}

/// c : sym L + L τ + τ Lᵀ
inline Tensor<2, 3> predict(const SpatialModuli &c, const SymmetricTensor<2, 3> &tau, const Tensor<2, 3> &L) {
  constexpr unsigned int rows[6] = {0, 1, 2, 0, 0, 1}, columns[6] = {0, 1, 2, 1, 2, 2};
  Tensor<2, 3> rate = L * tau + tau * transpose(L);
  for (unsigned int i = 0; i < 6; ++i) {
    double entry = 0.;
    for (unsigned int j = 0; j < 6; ++j)
      entry += c[i][j] * (j < 3 ? L[j][j] : L[rows[j]][columns[j]] + L[columns[j]][rows[j]]);
    rate[rows[i]][columns[i]] += entry;
    if (i >= 3)
      rate[columns[i]][rows[i]] += entry;
  }
  return rate;
}

/// The symmetric positive definite A with its eigenvalues raised to `exponent`.
inline Tensor<2, 3> power(const SymmetricTensor<2, 3> &A, const double exponent) {
  Tensor<2, 3> result;
  for (const auto &[value, vector] :
       dealii::eigenvectors(A, dealii::SymmetricTensorEigenvectorMethod::jacobi))
    result += std::pow(value, exponent) * outer_product(vector, vector);
  return result;
}

/// A state of a law: F and the history at the start of the step.
template <class Law> struct State {
  Tensor<2, 3> F;
  typename Law::History history_n;

  SymmetricTensor<2, 3> stress(const Law &law, const Tensor<2, 3> &L) const {
    typename Law::History ignored;
    SymmetricTensor<2, 3> tau;
    AssertThrow(law.update((unit + L) * F, history_n, ignored, tau, nullptr), dealii::ExcInternalError());
    return tau;
  }
  SpatialModuli moduli(const Law &law, SymmetricTensor<2, 3> &tau) const {
    typename Law::History ignored;
    SpatialModuli c;
    AssertThrow(law.update(F, history_n, ignored, tau, &c), dealii::ExcInternalError());
    return c;
  }
  bool yields(const Law &law) const {
    typename Law::History history;
    SymmetricTensor<2, 3> ignored;
    AssertThrow(law.update(F, history_n, history, ignored, nullptr), dealii::ExcInternalError());
    return law.equivalent_plastic_strain(history) > law.equivalent_plastic_strain(history_n);
  }
};

/// A history from one large random step.
template <class Law> typename Law::History work(const Law &law) {
  typename Law::History history;
  SymmetricTensor<2, 3> ignored;
  AssertThrow(law.update(unit + Random().tensor(0.3), {}, history, ignored, nullptr),
              dealii::ExcInternalError());
  return history;
}

/// F such that the trial b = F C_p⁻¹ Fᵀ has the principal logarithmic strains (½ ln b) `log_strains`.
template <class Law>
State<Law> make_state(const typename Law::History &history_n, const Tensor<1, 3> &log_strains) {
  Random random;
  const Tensor<2, 3> Q = random.rotation(), R = random.rotation();
  Tensor<2, 3> V;
  for (unsigned int i = 0; i < 3; ++i)
    V[i][i] = std::exp(log_strains[i]);
  State<Law> state{Q * V * transpose(Q) * R, history_n};
  if constexpr (Law::has_plasticity)
    state.F = state.F * power(history_n.inverse_plastic_metric, -0.5);
  return state;
}

/// Logarithmic strains whose deviator has the von Mises measure √(2/3) |dev ε| = `size`: two of them equal,
/// or none.
inline Tensor<1, 3> two_equal(const double size) {
  return Tensor<1, 3>({0.03 + size, 0.03 - 0.5 * size, 0.03 - 0.5 * size});
}
inline Tensor<1, 3> distinct(const double size) {
  const double e = size / std::sqrt(2. / 3. * (1. + 0.04 + 1.44));
  return Tensor<1, 3>({0.03 + e, 0.03 + 0.2 * e, 0.03 - 1.2 * e});
}

} // namespace billet::testing

#endif
