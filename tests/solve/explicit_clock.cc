// SPDX-License-Identifier: LGPL-2.1-or-later
// Steps of explicit dynamics: equal ones to an event, their growth, and what they do when the bound falls.
#include "billet/solve/explicit/explicit_clock.h"

#include "../testing.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace explicit_clock_test {

using billet::ExplicitClock;
using billet::testing::check;

namespace {

/// Runs to the event and returns the steps.
std::vector<double> run_to(ExplicitClock &clock, const double event, const double allowed) {
  std::vector<double> steps;
  while (clock.time() < event) {
    clock.plan(event, allowed);
    steps.push_back(clock.step());
    clock.advance();
  }
  return steps;
}

bool throws(ExplicitClock &clock, const double event, const double allowed) {
  try {
    clock.plan(event, allowed);
  } catch (const billet::SolutionFailure &) {
    return true;
  }
  return false;
}

} // namespace

BILLET_TEST(explicit_clock) {
  constexpr double tolerance = 1e-14;
  {
    ExplicitClock clock("scene.prm");
    check("at the start no time has passed since forces", clock.is_at_start() && clock.since_forces() == 0.);
    const std::vector<double> steps = run_to(clock, 1., 0.3);
    check("the least number of steps", steps.size() == 4 && clock.n_steps() == 4);
    check("equal steps", std::abs(steps.front() - 0.25) + std::abs(steps.back() - 0.25), tolerance);
    check("the event is met exactly", clock.time() == 1.);
    clock.plan(2., 0.3);
    check("the step before", std::abs(clock.step_before() - 0.25), tolerance);
  }
  {
    ExplicitClock clock("scene.prm");
    run_to(clock, 1., 1.);
    const std::vector<double> steps = run_to(clock, 100., 1.2);
    bool grow_slowly = true;
    for (std::size_t i = 1; i < steps.size(); ++i)
      grow_slowly = grow_slowly && steps[i] <= 1.03 * steps[i - 1];
    check("steps near the bound grow slowly", grow_slowly);
    check("up to it", *std::max_element(steps.begin(), steps.end()) <= 1.2 * (1. + 1e-8));
  }
  {
    ExplicitClock clock("scene.prm");
    run_to(clock, 2., 1.); // the first step counts as growth, the second one ends it
    const std::vector<double> steps = run_to(clock, 100., 1.05);
    check("steps that are nearly as long as allowed stay", std::abs(steps[50] - steps[0]), tolerance);
  }
  {
    ExplicitClock clock("scene.prm");
    run_to(clock, 1e-3, 1e-3);
    const std::vector<double> steps = run_to(clock, 100., 1.);
    check("steps far below the bound double", std::abs(steps[1] / steps[0] - 2.), 1e-2);
    check("until they are long", *std::max_element(steps.begin(), steps.end()) > 0.98);
  }
  {
    ExplicitClock clock("scene.prm");
    clock.plan(1., 0.1);
    clock.advance();
    clock.plan(1., 0.05);
    check("a lower bound ends the plan at once", std::abs(clock.step() - 0.05), tolerance);
    clock.advance();
    clock.plan_to(1.);
    const double step = clock.step();
    clock.plan(1., 0.052);
    check("the same event keeps the plan", clock.step() == step);
    clock.advance();
    clock.plan_to(0.5);
    check("another event makes a new one", run_to(clock, 0.5, 0.05).size() > 1 && clock.time() == 0.5);
  }
  {
    ExplicitClock clock("scene.prm");
    clock.begin(1.);
    check("time that would not advance fails", throws(clock, 2., 1e-17));
  }
}

} // namespace explicit_clock_test
