// SPDX-License-Identifier: LGPL-2.1-or-later
// A rotation R after the deformation turns the stress, τ(R F) = R τ(F) Rᵀ, and the moduli, and changes
// nothing else: no stress is added, no plastic strain, and C_p⁻¹, which lives in the undeformed body, stays.

#include "moduli.h"

namespace objectivity_test {

using namespace billet;
using namespace billet::testing;

/// Steps the point through `n` rotations of the deformation gradient F.
template <class Law>
void test_rotations(const std::string &name, const Law &law, const Tensor<2, 3> &F, const double tolerance) {
  constexpr unsigned int n = 200;
  Random random;
  typename Law::History start, history_n, history;
  SymmetricTensor<2, 3> tau_0, tau;
  AssertThrow(law.update(F, {}, start, tau_0, nullptr), dealii::ExcInternalError());
  history_n = start;
  WorstError turned, added, history_change;
  for (unsigned int step = 0; step < n; ++step) {
    const Tensor<2, 3> R = random.rotation();
    AssertThrow(law.update(R * F, history_n, history, tau, nullptr), dealii::ExcInternalError());
    const Tensor<2, 3> expected = R * tau_0 * transpose(R);
    turned.add((static_cast<Tensor<2, 3>>(tau) - expected).norm() / tau_0.norm());
    added.add(std::abs(tau.norm() / tau_0.norm() - 1.));
    if constexpr (Law::has_plasticity) {
      history_change.add(std::abs(history.equivalent_plastic_strain / start.equivalent_plastic_strain - 1.));
      history_change.add((history.inverse_plastic_metric - start.inverse_plastic_metric).norm());
    }
    history_n = history;
  }
  check(name + ", stress turns", turned.value(), tolerance);
  check(name + ", none is added", added.value(), tolerance);
  if constexpr (Law::has_plasticity)
    check(name + ", history unchanged", history_change.value(), tolerance);
}

/// The moduli at R F predict the turned rate of the moduli at F, away from yield, where round-off decides on
/// loading.
template <class Law>
void test_moduli(const std::string &name, const Law &law, const typename Law::History &history_n,
                 const double size) {
  Random random;
  WorstError error;
  const State<Law> state = make_state<Law>(history_n, distinct(size));
  SymmetricTensor<2, 3> tau, turned_tau;
  const SpatialModuli c = state.moduli(law, tau);
  for (unsigned int i = 0; i < 50; ++i) {
    const Tensor<2, 3> R = random.rotation(), L = random.tensor(1.);
    const SpatialModuli turned = State<Law>{R * state.F, history_n}.moduli(law, turned_tau);
    const Tensor<2, 3> expected = R * predict(c, tau, L) * transpose(R);
    error.add((predict(turned, turned_tau, R * L * transpose(R)) - expected).norm() / norm(c));
  }
  check(name + ", moduli turn", error.value(), 1e-12);
}

BILLET_TEST(objectivity) {
  Random random;
  const HenckyElasticity elastic(steel);
  const Tensor<2, 3> moderate = unit + random.tensor(0.05), large = unit + random.tensor(0.4);
  test_rotations("elastic, 5 %", elastic, moderate, 1e-12);
  test_rotations("elastic, 40 %", elastic, large, 1e-12);
  test_moduli("elastic", elastic, {}, 0.3);
  for_each_hardening([&](const std::string &name, const auto &hardening) {
    const HenckyPlasticity law(steel, make_hardening(hardening));
    test_rotations(name + ", 5 %", law, moderate, 1e-12);
    test_rotations(name + ", 40 %", law, large, 1e-12);
    test_moduli(name + ", elastic", law, work(law), 1e-4);
    test_moduli(name + ", plastic", law, work(law), 0.3);
  });
}

} // namespace objectivity_test
