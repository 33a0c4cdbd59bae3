// SPDX-License-Identifier: LGPL-2.1-or-later
// The moduli on both sides of first yield, so close to it that central differences would cross it: one-sided
// differences from 1e-6 below yield into unloading meet the elastic moduli, from 1e-6 above into loading the
// elastoplastic ones.

#include "moduli.h"

namespace tangent_at_first_yield_test {

using namespace billet;
using namespace billet::testing;

template <class Law>
double one_sided_error(const Law &law, const State<Law> &state, const double side, const double h) {
  SymmetricTensor<2, 3> tau;
  const SpatialModuli c = state.moduli(law, tau);
  WorstError error;
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = i; j < 3; ++j) {
      Tensor<2, 3> L;
      L[i][j] += 1.;
      L[j][i] += 1.;
      L *= side * std::copysign(1., scalar_product(deviator(tau), dealii::symmetrize(L)));
      const SymmetricTensor<2, 3> difference =
          (-25. * tau + 48. * state.stress(law, h * L) - 36. * state.stress(law, 2. * h * L) +
           16. * state.stress(law, 3. * h * L) - 3. * state.stress(law, 4. * h * L)) /
          (12. * h);
      error.add((predict(c, tau, L) - static_cast<Tensor<2, 3>>(difference)).norm() / norm(c));
    }
  return error.value();
}

BILLET_TEST(tangent_at_first_yield) {
  for_each_hardening([](const std::string &name, const auto &hardening) {
    using Law = HenckyPlasticity;
    const Law law(steel, make_hardening(hardening));
    const typename Law::History fresh, worked = work(law);
    for (const auto &[label, history_n] :
         {std::pair(name + ", fresh, ", fresh), std::pair(name + ", worked, ", worked)}) {
      const double yield_strain = hardening.stress(history_n.equivalent_plastic_strain) / (3. * steel.shear);
      WorstError loading, unloading;
      bool yields = true;
      for (const auto &shape : {two_equal, distinct})
        for (const double sign : {1., -1.}) {
          const auto above = make_state<Law>(history_n, shape(sign * (1. + 1e-6) * yield_strain));
          const auto below = make_state<Law>(history_n, shape(sign * (1. - 1e-6) * yield_strain));
          yields &= above.yields(law) && !below.yields(law);
          loading.add(one_sided_error(law, above, 1., 3e-3 * yield_strain));
          unloading.add(one_sided_error(law, below, -1., 3e-3 * yield_strain));
        }
      check(label + "yields where it should", yields);
      check(label + "1e-6 above yield, into loading", loading.value(), 1e-7);
      check(label + "1e-6 below yield, into unloading", unloading.value(), 1e-7);
    }
  });
}

} // namespace tangent_at_first_yield_test
