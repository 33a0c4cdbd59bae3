// SPDX-License-Identifier: LGPL-2.1-or-later
// Estimates of the error of force curves, and the steps that follow from them, of made-up curves whose error
// is known: F* = 3 + 2 t along x, to which each step of length h adds an error c h².
#include "billet/solve/error_control.h"

#include "../testing.h"

#include <algorithm>
#include <cmath>

namespace error_control_test {

using namespace billet;
using billet::testing::check;
using billet::testing::near;
using Forces = ErrorControl::Forces;

namespace {

Forces force(const double t, const double error) {
  return {dealii::Tensor<1, 3>({3. + 2. * t + error, 0., 0.})};
}

struct Result {
  ErrorControl::Estimate estimate;
  double error; ///< true
  unsigned int n_steps, n_measurements;
};

constexpr double caution = 1.4; // of the estimate

/// Steps until time 1, in twos where a measurement is wanted. `jump`: of the error, once, at time 0.5. Errors
/// that fade are halved every two steps.
Result run(const ErrorControl::Tolerances &tolerances, const double slope, const double first_step,
           const double stretch = 1., double jump = 0.) {
  ErrorControl control(tolerances, 1.);
  double t = 0., h = first_step, error = 0., error_integral = 0., work = 0., force_before = 0.;
  unsigned int n = 0;
  const double kept = tolerances.fade ? std::sqrt(0.5) : 1.;
  const auto advance = [&] {
    const double before = error;
    t += h;
    ++n;
    error = kept * error + slope * h * h;
    error_integral += 0.5 * (before + error) * h;
    work += 0.5 * (force_before + 3. + 2. * t) * h;
    force_before = 3. + 2. * t;
    control.accept(h, force(t, error), 0., 0.);
  };
  while (t < 1. - 1e-12) {
    h = std::min(h, 1. - t);
    if (control.wants_measurement(h) && t + 2. * h <= 1.) {
      double of_one_step = kept * kept * error + slope * 4. * h * h;
      advance();
      advance();
      if (t > 0.5) {
        of_one_step += jump;
        jump = 0.;
      }
      control.measure_steps(h, force(t, error), force(t, of_one_step), 0.);
    } else
      advance();
    h = std::min(h * stretch, control.longest_step());
  }
  return {control.estimate(), error_integral / work, n, control.n_measurements()};
}

} // namespace

BILLET_TEST(error_control) {
  const Result even = run({0., 0.}, 0.5, 0.01);
  check("equal steps: the estimate is the error, with caution",
        near(even.estimate.steps, caution * even.error, 1e-3));
  check("steps are left alone without a tolerance", even.n_steps == 100 || even.n_steps == 101);
  check("where little changes measurements are few", even.n_measurements < 25);
  const Result disturbed = run({0., 0.}, 0.5, 0.01, 1., 1e-3);
  check("what happens once counts once",
        disturbed.estimate.steps - even.estimate.steps < caution * 1e-3 / 3.);

  for (const double tolerance : {1e-2, 1e-3}) {
    const Result controlled = run({tolerance, 0.}, 0.5, 0.2 * tolerance, 1.5);
    check("controlled steps keep the tolerance", controlled.error < tolerance);
    check("and use a good part of it", controlled.error > 0.2 * tolerance);
    check("the estimate is the error, with caution",
          near(controlled.estimate.steps, caution * controlled.error, 0.05));
  }
  // Errors that fade are no more than those of some steps, however many there were: these may be longer.
  const Result fading = run({0., 0., true}, 0.5, 0.01);
  check("equal steps whose errors fade: the estimate is no less than the error, nor thrice as much",
        fading.estimate.steps > fading.error && fading.estimate.steps < 3. * fading.error);
  for (const double tolerance : {1e-2, 1e-3}) {
    const Result controlled = run({tolerance, 0., true}, 0.5, 0.2 * tolerance, 1.5);
    check("controlled steps whose errors fade keep the tolerance",
          controlled.error < tolerance && controlled.estimate.steps < 1.2 * tolerance);
    check("and are longer than those whose errors add up",
          controlled.error > 0.2 * tolerance &&
              controlled.n_steps < 0.9 * run({tolerance, 0.}, 0.5, 0.2 * tolerance, 1.5).n_steps);
  }
  const Result exact = run({1e-3, 0.}, 0., 0.01, 1.5);
  check("without an error steps grow", exact.n_steps < 30 && exact.estimate.steps == 0.);
  {
    ErrorControl noisy({1e-6, 0.}, 1.);
    noisy.accept(0.01, force(0.01, 0.), 0., 0.);
    noisy.accept(0.01, force(0.02, 0.), 0., 0.);
    noisy.measure_steps(0.01, force(0.02, 0.), force(0.02, 3e-6), 1e-6);
    check("what residuals make of a difference shortens no steps", noisy.longest_step() >= 0.01);
  }
  // One measurement after another of pairs of steps of these lengths and differences from one of twice the
  // length, 1 ppm of the forces in noise: the next step.
  struct Pair {
    double h, difference;
  };
  const auto next_step = [](const std::vector<Pair> &measured) {
    ErrorControl control({1e-3, 0.}, 1.);
    double t = 0.;
    for (const auto &[h, difference] : measured) {
      control.accept(h, force(t += h, 0.), 0., 0.);
      control.accept(h, force(t += h, 0.), 0., 0.);
      control.measure_steps(h, force(t, 0.), force(t, difference), 1e-6);
    }
    return control.longest_step();
  };
  const double steady = next_step({{0.01, 2e-4}, {0.01, 2e-4}});
  check("a difference within the noise is taken to be as before",
        near(next_step({{0.01, 2e-4}, {1e-4, 0.}}), 1e-4 * 4., 1e-9) && steady < 0.04);
  check("errors that turn around do not add up", next_step({{0.01, 2e-4}, {0.01, -2e-4}}) > steady);
  check("steps grow again where shorter ones err as much in the same time",
        next_step({{0.01, 2e-3}, {0.005, 2e-3}}) >= 0.01 && next_step({{0.01, 2e-3}, {0.005, 5e-4}}) < 0.01);

  ErrorControl deep({0., 1e-3}, 1.);
  deep.accept(0.1, force(0.1, 0.), 1e-5, 100.);
  deep.measure_penetration(100., force(0.1, 0.), force(0.1, 0.032), 0.);
  ErrorControl left({0., 0.}, 1.);
  left.accept(0.1, force(0.1, 0.), 0., 100.);
  left.measure_penetration(100., force(0.1, 0.), force(0.1, 0.032), 0.);
  check("what residuals make", near(deep.estimate().iterations, 2e-5, 1e-9)); // from the force 0 at time 0
  check("what penetrations make", near(left.estimate().penetration, 2. * 0.032 / 3.2, 1e-9));
  // A measurement of penetrations costs another solution: the first, and others as long as they change.
  ErrorControl seldom({0., 0.1}, 1.);
  unsigned int n_wanted = 0;
  for (unsigned int i = 0; i < 30; ++i) {
    seldom.accept(0.01, force(0.1, 0.), 0., 100.);
    n_wanted += seldom.wants_penetration() ? 1 : 0;
    if (seldom.wants_penetration())
      seldom.measure_penetration(100., force(0.1, 0.), force(0.1, 1e-4), 0.);
    seldom.measure_steps(0.01, force(0.1, 0.), force(0.1, 1e-6), 0.);
  }
  ErrorControl rough({0., 1e-3}, 1.);
  rough.accept(0.1, force(0.1, 0.), 0., 100.);
  rough.measure_penetration(100., force(0.1, 0.), force(0.1, 1e-3), 1e-3);
  check("what residuals make of penetrations does not count", rough.estimate().penetration == 0.);
  check("penetrations that make little are measured seldom", n_wanted > 2 && n_wanted < 8);
  // 0.032 of something as small as 0.1 is much; of 10 it is little.
  ErrorControl small({0., 1e-3}, 1.);
  const double size = 10. * size_of(force(0.1, 0.));
  small.set_min_size(size);
  small.accept(0.1, force(0.1, 0.), 1e-5, 100.);
  small.measure_penetration(100., force(0.1, 0.), force(0.1, 0.032), 0.);
  check("what is small counts as a part of the least size",
        near(small.estimate().penetration, 2. * 0.032 / size, 1e-9) &&
            near(small.estimate().iterations, 2e-5, 1e-9));
  // A body that yields under a force: what it makes from then on counts in full, and a comparison that fails
  // there is tried again with shorter steps, however little there was before.
  const auto yielding = [](const bool stays) {
    ErrorControl control({1e-3, 0., false, stays}, 1.);
    double t = 0.;
    for (const double difference : {0., 0., 1e-2})
      for (unsigned int i = 0; i < 2; ++i) {
        control.accept(0.01, force(t += 0.01, 0.), 0., 0.);
        if (i == 1)
          control.measure_steps(0.01, force(t, 0.), force(t, difference), 0.);
      }
    for (unsigned int i = 0; i < 4; ++i)
      control.accept(0.01, force(t += 0.01, 0.), 0., 0.);
    return control;
  };
  check("what stays counts in full, what may happen once does not",
        yielding(true).estimate().steps > 1.7 * yielding(false).estimate().steps);
  for (const bool stays : {true, false}) {
    ErrorControl control({1e-3, 0., false, stays}, 1.);
    for (unsigned int i = 1; i <= 2; ++i)
      control.accept(0.01, force(0.01 * i, 0.), 0., 0.);
    control.measure_steps(0.01, force(0.02, 0.), force(0.02, 0.), 0.);
    for (unsigned int i = 0; i < 3; ++i)
      control.miss_measurement(0.04, true);
    check("failed comparisons after little shorten steps where that may grow at once",
          stays ? control.longest_step() <= 0.02 : control.longest_step() >= 0.04);
  }
  // Bodies that meet late: what is found before would be nothing, and believed for long.
  ErrorControl late({1e-3, 1e-3}, 1.);
  for (unsigned int i = 1; i <= 4; ++i)
    late.accept(0.1, force(0., -3.), 0., 0.);
  check("nothing is compared before something acts", !late.wants_measurement(0.1));
  late.measure_penetration(0., force(0., -3.), force(0., -3.), 0.);
  check("and penetrations are asked for until there are some", late.wants_penetration());
  late.accept(0.1, force(0.5, 0.), 0., 100.);
  check("what has not been measured is not known", late.wants_measurement(0.1) && !late.knows_penetration());
  check("the first step with some is held to its part at once", late.allowed_at_first() < 0.01);
  late.measure_penetration(100., force(0.5, 0.), force(0.5, 0.01), 0.);
  check("later ones by what has been found",
        late.knows_penetration() && !late.wants_penetration() && late.allowed_at_first() > 1.);
  ErrorControl hasty({1e-3, 0.}, 1.);
  check("two steps are compared although nothing acts yet", hasty.wants_measurement(0.5));
}

} // namespace error_control_test
