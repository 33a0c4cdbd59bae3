// SPDX-License-Identifier: LGPL-2.1-or-later
// What a run of dynamics believes its energies to be off does not depend on who looks on.
#include "billet/solve/energy_errors.h"

#include "../testing.h"
#include <cmath>
#include <vector>

namespace energy_errors_test {

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

/// Energies of 10 at stake beside 90 of a common motion, in a run of length 1 with a tolerance of 1e-2.
class Run {
public:
  /// Adds energies of which `missing` is missing, and which hold `in_springs`, as parts of those at stake.
  void add(const double missing, const double in_springs = 0.) {
    EnergyLedger ledger;
    ledger.initial = 100.;
    ledger.contact = 10. * in_springs;
    ledger.kinetic = 100. - 10. * missing - ledger.contact;
    errors_.add(time_, ledger, 90.);
    time_ += 0.25;
  }
  /// Returns the step factor after these parts are missing, one after the other.
  static double step_factor(const std::vector<double> &missing) {
    Run run;
    for (const double part : missing)
      run.add(part);
    return run.errors_.step_factor();
  }
  const EnergyErrors &errors() const { return errors_; }

private:
  EnergyErrors errors_{1e-2};
  double time_ = 0.;
};

void check_penetrations() {
  Run run;
  for (unsigned int i = 0; i < 5; ++i)
    run.add(0., 1e-3);
  // The delay of nodes makes 2 E_c of the kinetic energy, springs hold E_c, and waves carry on as much again.
  check("energy in springs counts six times", near(run.errors().penetration(), 6e-3, 1e-9));
  check("and not as an error of steps", run.errors().steps(), 1e-12);
  Run shared;
  for (unsigned int i = 0; i < 5; ++i)
    shared.add(0., i < 3 ? 1e-3 : 0.);
  check("for as long as they hold it", near(shared.errors().penetration(), 6e-3 * 2.5 / 4., 1e-9));
}

void check_step_factor() {
  // A fifth of the tolerance is 2e-3.
  check("steps stay while less than a fifth of the tolerance is missing",
        Run::step_factor({0., 1.9e-3}) == 1.);
  check("then they are a fifth shorter", near(Run::step_factor({0., 2.1e-3}), 0.8, 1e-12));
  check("again if it grows by more than a tenth",
        near(Run::step_factor({0., 2.1e-3, 2.1e-3 * 1.12}), 0.64, 1e-12));
  check("but not if it hardly grows", near(Run::step_factor({0., 2.1e-3, 2.1e-3 * 1.08}), 0.8, 1e-12));
  check("nor for what was missing at first", Run::step_factor({0.1, 0.1}) == 1.);
  check("not below half", Run::step_factor({0., 0.01, 0.02, 0.04, 0.08, 0.16}) == 0.5);
}

} // namespace

BILLET_TEST(energy_errors) {
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
  check("nor is anything near it", flies(1.).has_energies() && !flies(1e-6).has_energies());
  check("of what is a millionth it is little", flies(1.).has_energies() && flies(1.).steps() < 1e-5);
  check("what is held is no common motion",
        carried_energy({{false, false, false}}, dealii::Tensor<1, 3>({1., 1., 1.}), 1.), 0.);
  check_penetrations();
  check_step_factor();
}

} // namespace energy_errors_test
