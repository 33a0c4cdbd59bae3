// SPDX-License-Identifier: LGPL-2.1-or-later
// What the laws refuse, for the step to be cut: no eigenvalue problem is left to run on, nothing is thrown,
// and the history at the end of the step is not touched.

#include "billet/without_traps.h"

#include "../sample_laws.h"
#include "../testing.h"

namespace admissibility_test {

using namespace billet;
using namespace billet::testing;
using dealii::SymmetricTensor;
using dealii::Tensor;

bool accepted(const SymmetricTensor<2, 3> &b) {
  PrincipalElasticState ignored;
  return compute_principal_state(b, ignored);
}

SymmetricTensor<2, 3> diagonal(const double b_1, const double b_2, const double b_3) {
  SymmetricTensor<2, 3> b;
  b[0][0] = b_1;
  b[1][1] = b_2;
  b[2][2] = b_3;
  return b;
}

/// Refused with and without moduli, the history untouched.
template <class Law> bool refuses(const Law &law, const Tensor<2, 3> &F) {
  SymmetricTensor<2, 3> ignored;
  SpatialModuli moduli;
  typename Law::History history_n, history;
  bool untouched = true;
  if constexpr (Law::has_plasticity)
    history.equivalent_plastic_strain = 0.125;
  const bool refused = !law.update(F, history_n, history, ignored, nullptr) &&
                       !law.update(F, history_n, history, ignored, &moduli);
  if constexpr (Law::has_plasticity)
    untouched = history.equivalent_plastic_strain == 0.125 &&
                history.inverse_plastic_metric == dealii::unit_symmetric_tensor<3>();
  return refused && untouched;
}

template <class Law> void test_law(const std::string &name, const Law &law) {
  const double not_a_number = std::numeric_limits<double>::quiet_NaN(),
               infinity = std::numeric_limits<double>::infinity();
  const Tensor<2, 3> singular = diagonal(1.2, 0.8, 0.);
  check(name + ", F = 0", refuses(law, Tensor<2, 3>()));
  check(name + ", F singular", refuses(law, singular));
  check(name + ", F overflows in b", refuses(law, 1e160 * dealii::unit_symmetric_tensor<3>()));
  for (const auto &[label, value] :
       {std::pair("not a number", not_a_number), std::pair("infinite", infinity)})
    for (const bool diagonal_entry : {true, false}) {
      Tensor<2, 3> F = dealii::unit_symmetric_tensor<3>();
      F[1][diagonal_entry ? 1 : 2] = value;
      check(name + ", F " + label + (diagonal_entry ? " on the diagonal" : " beside the diagonal"),
            refuses(law, F));
    }
}

BILLET_TEST(admissibility) {
  const WithoutTraps quiet; // laws are asked what they make of what is no number
  check("b = 1 is accepted", accepted(diagonal(1., 1., 1.)));
  check("b of stretches 1e-3 and 1e3 is accepted", accepted(diagonal(1e-6, 1., 1e6)));
  check("b = 0 is refused", !accepted(diagonal(0., 0., 0.)));
  check("b with a zero eigenvalue is refused", !accepted(diagonal(2., 0., 1.)));
  check("b with a negative eigenvalue is refused", !accepted(diagonal(2., 1., -1e-10)));
  SymmetricTensor<2, 3> indefinite = diagonal(1., 1., 1.);
  indefinite[0][1] = 1.5;
  check("b with eigenvalues 2.5, 1, -0.5 is refused", !accepted(indefinite));

  test_law("elastic", HenckyElasticity(steel));
  for_each_hardening([](const std::string &name, const auto &hardening) {
    test_law(name, HenckyPlasticity(steel, make_hardening(hardening)));
  });
}

} // namespace admissibility_test
