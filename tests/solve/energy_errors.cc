// SPDX-License-Identifier: LGPL-2.1-or-later
// What a run of dynamics believes its energies to be off does not depend on who looks on.
#include "billet/solve/energy_errors.h"

#include "../testing.h"
#include <cmath>

using namespace billet;
using billet::testing::check;
using billet::testing::near;

namespace {

/// Of two equal masses m that meet with ±v in a frame that goes by at w: a hundredth of what is at stake is
/// missing from half of the time on.
EnergyErrors watch(const double w) {
  constexpr double m = 2., v = 3.;
  const double meeting = 2. * 0.5 * m * v * v, kinetic = meeting + m * w * w,
               carried =
                   carried_energy({{true, false, false}}, dealii::Tensor<1, 3>({2. * m * w, 7., 8.}), 2. * m);
  check("the common motion's energy", near(carried, m * w * w, 1e-12));
  EnergyLedger ledger;
  ledger.initial = kinetic;
  EnergyErrors errors(1e-3);
  for (unsigned int i = 0; i <= 100; ++i) {
    ledger.kinetic = kinetic - (i > 50 ? 0.01 * meeting : 0.);
    ledger.contact = 0.;
    errors.add(0.01 * i, ledger, carried);
  }
  return errors;
}

} // namespace

int main() {
  const EnergyErrors at_rest = watch(0.);
  check("a hundredth in half of the time", near(at_rest.steps(), 0.005, 0.011));
  for (const double w : {1., 1e3})
    check("as much for who moves along",
          near(watch(w).steps(), at_rest.steps(), 1e-9) && watch(w).step_factor() == at_rest.step_factor());
  const auto flies = [](const double left) {
    EnergyLedger ledger;
    ledger.initial = 1e6;
    EnergyErrors errors(1e-3);
    for (unsigned int i = 0; i <= 100; ++i) {
      ledger.kinetic = 1e6 * (1. + 1e-14 * i);
      errors.add(0.01 * i, ledger, 1e6 - left);
    }
    return errors;
  };
  check("of one that flies round-off is nothing",
        !flies(1e-8).has_energies() && flies(1e-8).step_factor() == 1.);
  check("of what is a millionth it is little", flies(1.).has_energies() && flies(1.).steps() < 1e-5);
  check("what is held is no common motion",
        carried_energy({{false, false, false}}, dealii::Tensor<1, 3>({1., 1., 1.}), 1.), 0.);
  return testing::exit_code();
}
