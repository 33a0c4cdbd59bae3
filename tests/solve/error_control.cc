// SPDX-License-Identifier: LGPL-2.1-or-later
// Estimates of the error of force curves, and the steps that follow from them, of made-up curves whose error
// is known: F* = 3 + 2 t along x, computed with steps of length h as F* + c h.
#include "billet/solve/error_control.h"

#include "../testing.h"

#include <algorithm>
#include <cmath>

using namespace billet;
using billet::testing::check;
using Forces = ErrorControl::Forces;

namespace {

Forces force(const double t, const double error) {
  return {dealii::Tensor<1, 3>({3. + 2. * t + error, 0., 0.})};
}

struct Result {
  ErrorControl::Estimate estimate;
  double error; ///< true
  double last_step;
  unsigned int n_steps, n_measurements;
};

/// Steps until time 1, in twos where a measurement is wanted.
Result run(const ErrorControl::Tolerances &tolerances, const double slope, const double first_step,
           const double stretch = 1.) {
  ErrorControl control(tolerances);
  double t = 0., h = first_step, error = 0., work = 0.;
  unsigned int n = 0;
  const auto advance = [&] {
    t += h;
    ++n;
    error += slope * h * h;
    work += (3. + 2. * t) * h;
    control.accept(h, force(t, slope * h), 0.);
  };
  while (t < 1. - 1e-12) {
    const bool measures = control.wants_measurement();
    advance();
    if (measures) {
      advance();
      control.measure_steps(h, force(t, slope * h), force(t, 2. * slope * h));
    }
    h = std::min({h * stretch, control.longest_step(), std::max(1e-12, 1. - t)});
  }
  return {control.estimate(), error / work, h, n, control.n_measurements()};
}

bool near(const double a, const double b, const double part) { return std::abs(a - b) <= part * std::abs(b); }

} // namespace

int main() {
  const Result even = run({0., 0.}, 0.5, 0.01);
  check("equal steps: the estimate is the error", near(even.estimate.steps, even.error, 0.02));
  check("steps are left alone without a tolerance", even.n_steps == 100 || even.n_steps == 101);
  check("where little changes measurements are few", even.n_measurements < 25);

  for (const double tolerance : {1e-2, 1e-3}) {
    const Result controlled = run({tolerance, 0.}, 0.5, 0.2 * tolerance, 1.5);
    check("controlled steps keep the tolerance", controlled.error < tolerance);
    check("and use most of it", controlled.error > 0.4 * tolerance);
    check("the estimate is the error", near(controlled.estimate.steps, controlled.error, 0.1));
  }
  const Result exact = run({1e-3, 0.}, 0., 0.01, 1.5);
  check("without an error steps grow", exact.n_steps < 30 && exact.estimate.steps == 0.);

  ErrorControl deep({0., 1e-3});
  deep.accept(0.1, force(0.1, 0.), 1e-5);
  deep.measure_penetration(100., force(0.1, 0.), force(0.1, 0.032));
  check("what residuals make", near(deep.estimate().iterations, 2e-5, 1e-9)); // from the force 0 at time 0
  check("what penetrations make", near(deep.estimate().penetration, 2. * 0.032 / 3.2, 1e-9));
  // A tenth of it is allowed, and less since too much is spent.
  check("what penetration is allowed", deep.penetration_allowed() < 10. && deep.penetration_allowed() >= 1.);
  return billet::testing::exit_code();
}
