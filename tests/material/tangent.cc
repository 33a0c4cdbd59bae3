// SPDX-License-Identifier: LGPL-2.1-or-later
// The spatial moduli c of each law against differences of its stress: along F(ε) = (1 + ε L) F from the same
// history, dτ/dε = c : sym L + L τ + τ Lᵀ. At equal, nearly equal and distinct principal stretches of the
// trial state; elastic, and plastic with and without a history.

#include "moduli.h"

namespace tangent_test {

using namespace billet;
using namespace billet::testing;

/// Relative to the norm of c; nine directions, six of them symmetric, three skew.
template <class Law> double moduli_error(const Law &law, const State<Law> &state, const double step) {
  SymmetricTensor<2, 3> tau;
  const SpatialModuli c = state.moduli(law, tau);
  WorstError error;
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j) {
      Tensor<2, 3> L;
      L[i][j] += 1.;
      L[j][i] += i <= j ? 1. : -1.;
      const SymmetricTensor<2, 3> difference =
          central_difference([&](const double e) { return state.stress(law, e * L); }, step);
      error.add((predict(c, tau, L) - static_cast<Tensor<2, 3>>(difference)).norm() / norm(c));
    }
  return error.value();
}

/// What is checked once per law, over all its states.
struct Properties {
  bool yields_as_named = true;
  WorstError asymmetry, jump;

  void check_all(const std::string &name) const {
    check(name + ", yields where it should", yields_as_named);
    check(name + ", symmetry", asymmetry.value(), 1e-14);
    check(name + ", continuity through equal stretches", jump.value(), 1e-8);
  }
};

/// States of the von Mises strain measure `size`, which yield or not.
template <class Law>
void test_states(const std::string &name, const Law &law, const typename Law::History &history_n,
                 const double size, const bool plastic, Properties &properties) {
  WorstError error;
  const auto add = [&](const Tensor<1, 3> &log_strains) {
    const State<Law> state = make_state<Law>(history_n, log_strains);
    SymmetricTensor<2, 3> ignored;
    const SpatialModuli c = state.moduli(law, ignored);
    properties.asymmetry.add(asymmetry(c));
    properties.yields_as_named &= plastic == state.yields(law);
    error.add(moduli_error(law, state, 2e-5));
    return c;
  };
  for (const double sign : {1., -1.}) {
    const Tensor<1, 3> log_strains = two_equal(sign * size), apart({0., 0.5 * size, -0.5 * size});
    const SpatialModuli equal = add(log_strains), nearly_equal = add(log_strains + 1e-9 * apart);
    properties.jump.add(distance(equal, nearly_equal) / norm(equal));
    for (const double factor : {1e-12, 1e-8, 1e-4})
      add(log_strains + factor * apart);
    add(distinct(sign * size));
  }
  if (!plastic) // all three equal, and nearly so; compressed and stretched
    for (const double mean : {-0.2, 0., 0.2})
      for (const double apart : {0., 1e-12, 1e-8, 1e-4})
        add(Tensor<1, 3>({mean, mean + apart, mean - 2. * apart}));
  check(name, error.value(), 1e-7);
}

BILLET_TEST(tangent) {
  Properties elastic_properties;
  const HenckyElasticity elastic(steel);
  test_states("elastic, small strain", elastic, {}, 1e-3, false, elastic_properties);
  test_states("elastic, large strain", elastic, {}, 0.3, false, elastic_properties);
  test_states("elastic, huge strain", elastic, {}, 1.5, false, elastic_properties);
  elastic_properties.check_all("elastic");

  for_each_hardening([](const std::string &name, const auto &hardening) {
    using Law = HenckyPlasticity;
    const Law law(steel, make_hardening(hardening));
    Properties properties;
    const typename Law::History fresh, worked = work(law);
    for (const auto &[label, history_n] :
         {std::pair(name + ", fresh, ", fresh), std::pair(name + ", worked, ", worked)}) {
      const double yield_strain = hardening.stress(history_n.equivalent_plastic_strain) / (3. * steel.shear);
      test_states(label + "elastic", law, history_n, 0.5 * yield_strain, false, properties);
      test_states(label + "plastic", law, history_n, 5. * yield_strain, true, properties);
      test_states(label + "far beyond yield", law, history_n, 1.5, true, properties);
    }
    properties.check_all(name);
  });
}

} // namespace tangent_test
