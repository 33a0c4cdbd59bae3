// SPDX-License-Identifier: LGPL-2.1-or-later
// Works of contact in a step: nodes that enter and leave, (A1), the ramp, (A2), against closed forms of a
// spring; and the verdicts on steps, (A4).
#include "billet/solve/step_energy.h"
#include "billet/contact/step_works.h"

#include "../testing.h"

#include <cmath>

namespace step_energy_test {

using billet::StepEnergy;
using billet::StepWorks;
using billet::testing::check;
using Verdict = StepEnergy::Verdict;

namespace {

/// The verdict on a first step, each with works just beside a limit.
bool is_rejected(const double imbalance, const double own, const double before) {
  return StepEnergy().judge(1., 0.1, {imbalance, own, before}, 0.) == Verdict::rejected;
}

/// The verdict on a step from t_n, after one from 1 to 1.1 that was rejected.
Verdict judge_next(const double t_n, const double length) {
  StepEnergy energy;
  energy.judge(1., 0.1, {1., 1., 1.}, 0.);
  return energy.judge(t_n, length, {1., 1., 1.}, 0.);
}

void check_limits() {
  check("much of all work", is_rejected(5., 5., 5.) && !is_rejected(0.05, 1., 9.));
  check("and of the step's", is_rejected(10., 10., 2.) && !is_rejected(0.5, 10., 2.));
  check("after some was done before", is_rejected(1., 1., 1.) && !is_rejected(1., 1., 1e-3));
  check("steps are cut, and not for ever",
        judge_next(1., 0.1 / 4.) == Verdict::rejected && judge_next(1., 0.1 / 1000.) == Verdict::jump);
  check("round-off of a step is none", judge_next(1.1 - 1e-12, 1e-3) == Verdict::rejected);
}

} // namespace

BILLET_TEST(step_energy) {
  check_limits();
  constexpr double k = 7., tolerance = 1e-14;
  // A spring that a wall meets after a way of 3 and presses by 0.5, and back: trapezoidal work plus what
  // StepWorks add is what it stores.
  {
    const double depth = 0.5, way = 3.5, force = k * depth;
    StepWorks works;
    works.add(0., force, 0., depth, way, 0., 0.5);
    check("entering", std::abs(0.5 * force * way + works.touching - 0.5 * k * depth * depth), tolerance);
    works = {};
    works.add(force, 0., depth, 0., -way, 0., 0.5);
    check("leaving", std::abs(-0.5 * force * way + works.touching + 0.5 * k * depth * depth), tolerance);
    works = {};
    works.add(0., force, 0., depth, 0.1, 0., 0.5);
    check("from elsewhere: nothing is left out", works.touching == 0.);
    works = {};
    works.add(force, 0., depth, 0., 40., 0., 0.5);
    check("out on the other side: nothing is left out", works.touching == 0.);
    works = {};
    works.add(force, 2. * force, depth, 2. * depth, depth, 0., 0.5);
    check("pressed on: nothing", works.touching == 0. && works.ramp == 0.);
  }
  // A ramp presses a spring by 0.2 between standing bodies, in two steps, the second twice as long.
  {
    StepWorks works;
    const double first = 0.2 / 3., second = 0.2;
    works.add(0., k * first, 0., first, first, first, 0.5);
    works.add(k * first, k * second, first, second, second - first, second - first, 0.5);
    check("ramp", std::abs(works.ramp - 0.5 * k * second * second) + std::abs(works.touching), tolerance);
  }
  StepEnergy energy;
  check("small beside all work", energy.judge(1., 0.1, {0.9, 1., 10.}, 0.) == Verdict::balanced);
  check("small beside the step's", energy.judge(1., 0.1, {3.9, 10., 2.}, 0.) == Verdict::balanced);
  check("below the floor", energy.judge(1., 0.1, {1., 1., 0.5}, 2.) == Verdict::balanced);
  check("at first touch", energy.judge(1., 0.1, {1., 1., 0.05}, 0.) == Verdict::balanced);
  check("out of balance", energy.judge(1., 0.1, {-1., 1., 1.}, 0.) == Verdict::rejected);
  check("and cut", energy.judge(1., 0.1 / 16., {-1., 1., 1.}, 0.) == Verdict::rejected);
  check("a jump", energy.judge(1., 0.1 / 32., {-1., 1., 1.}, 0.) == Verdict::jump);
  check("also later in the rejected step", energy.judge(1.05, 0.1 / 32., {-1., 1., 1.}, 0.) == Verdict::jump);
  check("longer ones there are cut", energy.judge(1.05, 0.1 / 16., {-1., 1., 1.}, 0.) == Verdict::rejected);
  StepEnergy resumed;
  resumed.load(energy.save());
  check("a run that goes on knows that", resumed.judge(1.06, 0.1 / 32., {-1., 1., 1.}, 0.) == Verdict::jump);
  check("the next step begins anew", energy.judge(1.1, 0.1 / 32., {-1., 1., 1.}, 0.) == Verdict::rejected);
  check("nothing from nothing", energy.judge(2., 0.1, {0., 0., 0.}, 0.) == Verdict::balanced);
}

} // namespace step_energy_test
