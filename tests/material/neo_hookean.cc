// SPDX-License-Identifier: LGPL-2.1-or-later
// Simo's neo-Hookean laws: closed forms of simple shear, elastic and in one plastic step; the tangent against
// differences, exact also in its unsymmetric part; objectivity; flow without volume; the way back from a
// stress.

#include "moduli.h"

#include "billet/material/neo_hookean.h"

namespace neo_hookean_test {

using namespace billet;
using namespace billet::testing;

Tensor<2, 3> simple_shear(const double gamma) {
  Tensor<2, 3> F = unit;
  F[0][1] = gamma;
  return F;
}

/// Elastic: dev τ = G dev (F Fᵀ), so that τ12 = G γ, τ11 − τ22 = G γ², and no pressure; stored ½ G γ². In one
/// step of linear hardening q = G γ √(3 + γ²), Δα = (q − σ_0)/(G (3 + γ²) + H), and all scaled by σ_y/q.
void test_simple_shear() {
  const NeoHookeanElasticity elastic(steel);
  const NeoHookeanPlasticity plastic(steel, make_hardening(linear));
  WorstError stress, energy, plastic_stress, alpha_error;
  for (const double gamma : {1e-4, 0.01, 0.3, 2.}) {
    const double G = steel.shear;
    SymmetricTensor<2, 3> tau;
    NeoHookeanElasticity::History none;
    elastic.update(simple_shear(gamma), none, none, tau, nullptr);
    const auto compare = [&](const double beta) {
      return std::max({std::abs(tau[0][1] / (beta * G * gamma) - 1.),
                       std::abs((tau[0][0] - tau[1][1]) / (beta * G * gamma * gamma) - 1.) * gamma,
                       std::abs(trace(tau)) / (beta * G * gamma)});
    };
    stress.add(compare(1.));
    energy.add(std::abs(elastic.elastic_energy(simple_shear(gamma), none) / (0.5 * G * gamma * gamma) - 1.));

    NeoHookeanPlasticity::History history;
    plastic.update(simple_shear(gamma), {}, history, tau, nullptr);
    const double q = G * gamma * std::sqrt(3. + gamma * gamma);
    const double alpha = q <= linear.yield_stress
                             ? 0.
                             : (q - linear.yield_stress) / (G * (3. + gamma * gamma) + linear.modulus);
    plastic_stress.add(compare(alpha > 0. ? linear.stress(alpha) / q : 1.));
    alpha_error.add(std::abs(history.equivalent_plastic_strain - alpha));
  }
  check("simple shear, stress", stress.value(), 1e-11);
  check("simple shear, energy", energy.value(), 1e-7);
  check("simple shear, plastic, stress", plastic_stress.value(), 1e-11);
  check("simple shear, plastic, plastic strain", alpha_error.value(), 1e-12);
}

template <class Law>
void test_law(const std::string &name, const Law &law, const std::vector<double> &sizes) {
  WorstError error, turned, again, volume, returned;
  double max_asymmetry = 0.;
  typename Law::History fresh;
  for (const auto &history_n : {fresh, work(law)})
    for (const double size : sizes)
      for (const auto &strains : {two_equal(size), two_equal(-size), distinct(size)}) {
        const State<Law> state = make_state<Law>(history_n, strains);
        SymmetricTensor<2, 3> tau, turned_tau;
        const SpatialModuli c = state.moduli(law, tau);
        max_asymmetry = std::max(max_asymmetry, asymmetry(c));
        Random random;
        for (unsigned int i = 0; i < 9; ++i) {
          Tensor<2, 3> L;
          L[i / 3][i % 3] = 1.;
          const SymmetricTensor<2, 3> difference =
              central_difference([&](const double e) { return state.stress(law, e * L); }, 2e-5);
          error.add((predict(c, tau, L) - static_cast<Tensor<2, 3>>(difference)).norm() / norm(c));
        }
        const Tensor<2, 3> R = random.rotation();
        State<Law>{R * state.F, history_n}.moduli(law, turned_tau);
        turned.add((static_cast<Tensor<2, 3>>(turned_tau) - R * static_cast<Tensor<2, 3>>(tau) * transpose(R))
                       .norm() /
                   tau.norm());
        if constexpr (Law::has_plasticity) {
          typename Law::History history, later;
          law.update(state.F, history_n, history, tau, nullptr);
          volume.add(std::abs(determinant(history.inverse_plastic_metric) - 1.));
          const typename Law::History before = history;
          law.update(state.F, before, later, turned_tau, nullptr);
          again.add((turned_tau - tau).norm() / tau.norm());
          again.add(later.equivalent_plastic_strain - history.equivalent_plastic_strain);
          const auto found =
              law.find_history(state.F, dealii::deviator(tau), history.equivalent_plastic_strain);
          returned.add((found.inverse_plastic_metric - history.inverse_plastic_metric).norm());
        }
      }
  check(name + ", differences", error.value(), 1e-7);
  check(name + ", objectivity", turned.value(), 1e-12);
  if constexpr (Law::has_plasticity) {
    check(name + ", plastic flow has no volume", volume.value(), 1e-12);
    check(name + ", standing still changes nothing", again.value(), 1e-11);
    check(name + ", history found from the stress", returned.value(), 1e-10);
    check(name + ", unsymmetric where it yields", max_asymmetry > 1e-5);
  } else
    check(name + ", symmetry", max_asymmetry, 1e-14);
}

BILLET_TEST(neo_hookean) {
  test_simple_shear();
  test_law("elastic", NeoHookeanElasticity(steel), {1e-3, 0.3, 1.});
  for_each_hardening([](const std::string &name, const auto &hardening) {
    using Law = NeoHookeanPlasticity;
    const double yield_strain = hardening.stress(0.) / (3. * steel.shear);
    test_law(name, Law(steel, make_hardening(hardening)), {0.5 * yield_strain, 5. * yield_strain, 0.5});
  });
}

} // namespace neo_hookean_test
