// SPDX-License-Identifier: LGPL-2.1-or-later
// The choice of steps alone, nothing is solved.
#include "billet/solve/step_control.h"

#include "../testing.h"

namespace step_control_test {

using namespace billet;
using billet::testing::check;
using billet::testing::WorstError;

namespace {

parameters::TimeStepping make_parameters(const bool automatic) {
  parameters::TimeStepping p;
  p.end_time = 1.;
  p.control =
      automatic ? parameters::TimeStepping::Control::automatic : parameters::TimeStepping::Control::fixed;
  p.initial_step = 0.1;
  p.min_step = 0.01;
  p.max_step = 0.2;
  p.few_iterations = 4;
  p.many_iterations = 8;
  p.growth_factor = 1.5;
  p.shrink_factor = 0.5;
  p.cut_factor = 0.25;
  return p;
}

void check_times(const std::string &name, StepControl control, const std::vector<double> &times) {
  WorstError error;
  std::size_t i = 0;
  for (; !control.is_finished() && i < times.size(); ++i, control.accept(1))
    error.add(std::abs(control.next_time() - times[i]));
  check(name, control.is_finished() && i == times.size() ? error.value() : 1., 1e-15);
}

/// The first automatic step, of 0.1, in a run of this length.
double first_step(const double end_time) {
  auto p = make_parameters(true);
  p.end_time = end_time;
  return StepControl(p, 0.).next_step();
}

void check_rules() {
  for (const double end_time : {0.101, 0.12, 0.14, 0.16, 0.199}) {
    const double first = first_step(end_time);
    check("no step before the end is much shorter than another",
          first <= 0.1 && end_time - first > 0.3 * first);
  }
  check("round-off makes no step", first_step(0.1 * (1. + 1e-14)) == 0.1 * (1. + 1e-14));
  // The error falls with the third power of the step: 8 times the error, half of the step.
  const auto step_after = [](const double error) {
    StepControl control(make_parameters(true), 0.);
    control.accept(6, error);
    return control.next_step();
  };
  check("steps follow the error by its order", std::abs(step_after(2.) - 2. * step_after(16.)), 1e-15);
  check("and are shorter than it allows", step_after(8.) < 0.05);
}

} // namespace

BILLET_TEST(step_control) {
  check_rules();
  {
    auto p = make_parameters(false);
    p.initial_step = 1. / 700.;
    StepControl control(p, 0.);
    unsigned int n = 0;
    for (; !control.is_finished(); ++n)
      control.accept(1);
    check("fixed steps: 700 of them, the last at the end", n == 700 && control.time() == 1.);
    check("fixed steps are not cut", !StepControl(p, 0.).reject());
  }
  {
    StepControl control(make_parameters(true), 0.);
    control.accept(4);
    check("few iterations: grows", std::abs(control.next_step() - 0.15), 1e-15);
    control.accept(4);
    check("not above the largest", std::abs(control.next_step() - 0.2), 1e-15);
    control.accept(6);
    check("neither few nor many: stays", std::abs(control.next_step() - 0.2), 1e-15);
    control.accept(8);
    check("many: shrinks", std::abs(control.next_step() - 0.1), 1e-15);
    check("a failed step is cut", control.reject() && std::abs(control.next_step() - 0.025) < 1e-15);
    check("the smallest is tried", control.reject() && std::abs(control.next_step() - 0.01) < 1e-15);
    check("but none below it", !control.reject());
    check("cuts are counted", control.n_cuts() == 3);
    while (!control.is_finished())
      control.accept(6);
    check("ends exactly at the end", control.time() == 1.);
  }
  {
    StepControl control(make_parameters(true), 0.3);
    std::vector<double> times;
    double minimum = 1.;
    while (!control.is_finished()) {
      const double step = control.next_step();
      minimum = std::min(minimum, step);
      control.accept(4);
      times.push_back(control.time());
    }
    const auto hits = [&](const double t) { return std::find(times.begin(), times.end(), t) != times.end(); };
    check("stops at multiples of the interval", hits(0.3) && hits(0.6) && hits(3 * 0.3) && hits(1.));
    check("without slivers before them", minimum >= 0.05);
  }
  {
    auto p = make_parameters(false);
    p.end_time = 0.7; // 0.7, 0.07 and 0.01 have no finite binary form
    p.initial_step = 0.01;
    StepControl control(p, 0.07);
    WorstError error;
    for (; !control.is_finished(); control.accept(1))
      error.add(std::abs(control.next_step() - 0.01));
    check("fixed steps between output times a whole number of steps apart", control.n_steps() == 70);
    check("all have the length asked for", error.value(), 1e-15);
  }
  {
    auto p = make_parameters(false);
    p.stops = {0.45};
    check_times("fixed steps, output in between: only the last before it is cut", StepControl(p, 0.25),
                {0.1, 0.2, 0.25, 0.35, 0.45, 0.5, 0.6, 0.7, 0.75, 0.85, 0.95, 1.});
  }
  for (const bool automatic : {false, true}) {
    auto p = make_parameters(automatic);
    p.end_time = 58.;
    p.initial_step = p.max_step = 0.29;
    p.stops = {29.};
    StepControl control(p, 0.29); // 100 times this is less than 29
    double minimum = 1.;
    bool stopped = false;
    for (; !control.is_finished(); control.accept(6)) {
      minimum = std::min(minimum, control.next_step());
      stopped = stopped || control.next_time() == 29.;
    }
    check(std::string(automatic ? "automatic" : "fixed") + " steps: none of the length of round-off",
          stopped && minimum > 0.28 && control.n_steps() == 200);
  }
}

} // namespace step_control_test
