// SPDX-License-Identifier: LGPL-2.1-or-later
// The parts of error control by themselves: forces over time, intervals between measurements, and errors by
// penetrations and steps of made-up forces.
#include "billet/solve/force_course.h"
#include "billet/solve/measurement_interval.h"
#include "billet/solve/penetration_errors.h"
#include "billet/solve/step_errors.h"

#include "../testing.h"

#include <cmath>

namespace error_parts_test {

using namespace billet;
using billet::testing::check;
using billet::testing::near;

namespace {

ResultGroup force(const double value) { return {dealii::Tensor<1, 3>({value, 0., 0.})}; }

/// Returns the number of steps until the next measurement.
template <class Errors> unsigned int wait_for(const Errors &count_step, const unsigned int maximum = 20) {
  for (unsigned int n = 1; n < maximum; ++n)
    if (count_step())
      return n;
  return maximum;
}

/// Penetrations that cause this part of the error allowed for them, from two measurements: steps until the
/// next one.
unsigned int wait_after(const double part) {
  constexpr double tolerance = 0.01;
  ForceCourse course(1.);
  course.accept(0.01, 10.);
  PenetrationErrors errors(tolerance);
  errors.accept(0.01, 10., 1.);
  errors.measure(course, 1., force(10.), force(10. * (1. + part * tolerance)), 0.);
  return wait_for([&] {
    errors.accept(0.01, 10., 1.);
    return errors.wants_measurement();
  });
}

/// A force of 10 in a run of length 1. Two steps of each of these lengths are compared with one, from which
/// they differ by these parts of the force.
struct Pair {
  double h, difference;
};
struct Compared {
  ForceCourse course{1.};
  StepErrors errors;

  Compared(const double tolerance, const std::vector<Pair> &pairs) : errors({tolerance, false, false}) {
    for (const auto &[h, difference] : pairs) {
      for (unsigned int i = 0; i < 2; ++i) {
        course.accept(h, 10.);
        errors.accept(h, 1);
      }
      errors.measure(course, h, force(10.), force(10. * (1. + difference)), 0.);
    }
  }
};
double next_step(const double tolerance, const std::vector<Pair> &pairs) {
  return Compared(tolerance, pairs).errors.longest_step();
}

/// Steps of length h that are compared when `left` of the run is left, each time with one from which they
/// differ by this part of the force. `unmeasured`: length of one step before, of which nothing is known.
struct Late {
  static constexpr double short_step = 1e-3, tolerance = 0.01;
  double h; ///< of steps, whose errors are measured
  ForceCourse course{1.};
  StepErrors errors{{tolerance, false, false}};

  Late(const double left, const double unmeasured, const std::vector<double> &differences,
       const double length = short_step)
      : h(length) {
    course.accept(1e-6, 10.);
    course.accept(1. - 1e-6 - left, 10.);
    if (unmeasured > 0.)
      errors.accept(unmeasured, 1);
    for (const double difference : differences) {
      for (unsigned int i = 0; i < 2; ++i)
        errors.accept(h, 1);
      errors.measure(course, h, force(10.), force(10. * (1. + difference)), 0.);
    }
  }
  /// The factor by which the next steps may be longer.
  double stretch() const { return errors.longest_step() / h; }
  /// The difference of steps that make errors grow at so many times the even rate: 1.4 c h = n 2 S ε/T.
  static constexpr double at_rate(const double n, const double length = short_step) {
    return n * 2. * tolerance * 2. * length / 1.4;
  }
};

/// Limits of the rate at which errors may grow.
void check_rates() {
  constexpr double rounding = 1e-4; // of the error so far
  // With a fifth of the run to go, all that is allowed would be 25 times the even rate.
  check("errors late in the run grow at six times the even rate at most",
        near(Late(0.2, 0., {Late::at_rate(3.)}).stretch(), 2., rounding) &&
            near(Late(0., 0., {Late::at_rate(3.)}).stretch(), 2., rounding));
  // Where half of the run has used up all that is allowed, 0.2 of the rate that leads to it in the other
  // half. Steps of three tolerances of the span: errors do not hold back shorter ones.
  constexpr double length = 3. * Late::tolerance;
  check("what has used up all errors goes on at a fifth of the rate",
        near(Late(0.5, 0.5, {Late::at_rate(0.4, length)}, length).stretch(), 2., 1e-9));
  check("errors that grow suddenly count three times the last ones",
        near(Late(0.2, 0., {Late::at_rate(1.), Late::at_rate(3.1)}).stretch(), 2., rounding) &&
            near(Late(0.2, 0., {Late::at_rate(1.), Late::at_rate(30.)}).stretch(), 2., rounding));
}

/// Errors that fade: each pair of steps adds 0.004 of the force and halves what was before.
void check_fading_errors() {
  ForceCourse course(1.);
  StepErrors errors({0.02, true, false});
  double adds_up = 0.;
  for (unsigned int pair = 0; pair < 40; ++pair) {
    for (unsigned int i = 0; i < 2; ++i) {
      course.accept(0.01, 10.);
      errors.accept(0.01, 1);
    }
    adds_up = 0.5 * adds_up + 0.004;
    errors.measure(course, 0.01, force(10.), force(10.04), 0.);
  }
  // But for the first pair, over which they rise.
  check("errors that fade add up to twice those of a pair",
        near(errors.integral(), 10. * adds_up * course.time(), 0.02));
  check("and grow with the square of the step", near(errors.longest_step(), 0.01 * std::sqrt(2.5), 1e-9));
}

void check_steps() {
  constexpr double rounding = 1e-12;
  {
    const ForceCourse course(1.);
    const StepErrors errors({1e-3, false, false});
    check("the first comparison waits while three steps are left", !errors.wants_measurement(course, 0.33));
    check("but no longer", errors.wants_measurement(course, 0.34));
    check("a part of 1e-9 of the run does not count",
          !errors.wants_measurement(course, (1. + 0.9e-9) / 3.) &&
              errors.wants_measurement(course, (1. + 1.1e-9) / 3.));
  }
  {
    const Compared steady(1e-3, {{0.01, 1e-5}});
    check("steps that are half as long again are compared anew",
          !steady.errors.wants_measurement(steady.course, 0.0149) &&
              steady.errors.wants_measurement(steady.course, 0.0151));
  }
  // Steps of h that differ by d from one of 2 h add c h² = d/2. Over the run they make 1.4 c h/2 of the mean
  // force, with the tolerance ε: 1.4 d/(4 h) = ε.
  const double h = 5e-3, tolerance = 1e-3;
  check("steps that cause what is allowed stay, but for what the start has left",
        near(next_step(tolerance, {{h, 4. * h * tolerance / 1.4}}), h, 0.03));
  check("those that cause little grow fourfold", near(next_step(tolerance, {{h, 1e-9}}), 4. * h, rounding));
  check("those that cause much are halved", near(next_step(1e-3, {{0.03, 1.}}), 0.015, rounding));
  check("where they make a twentieth of what is allowed they are at most 0.65 of the root of the tolerance",
        near(next_step(1e-4, {{4e-3, 0.053 * 4. * 4e-3 * 1e-4 / 1.4}}), 6.5e-3, rounding));
  check("where they make less they may be longer",
        near(next_step(1e-4, {{4e-3, 0.047 * 4. * 4e-3 * 1e-4 / 1.4}}), 16e-3, rounding));
  check("they are not cut below three times the tolerance",
        near(next_step(1e-3, {{5e-3, 1.}}), 3e-3, rounding));
  check("nor below half of that maximum", near(next_step(0.04, {{0.1, 1.}}), 0.065, rounding));
  // Errors in the same time: d/h.
  const auto returns = [](const double shorter, const double as_much) {
    return next_step(1e-3, {{0.01, 4e-3}, {0.01 * shorter, as_much * shorter * 4e-3}}) >= 0.01 * (1. - 1e-12);
  };
  check("steps that are a quarter shorter return if they err by 0.8 times as much",
        returns(0.74, 0.81) && !returns(0.76, 0.81) && !returns(0.74, 0.79));
  {
    StepErrors errors({1e-3, false, false});
    for (unsigned int i = 0; i < 2; ++i)
      errors.miss(0.01, true);
    check("a second failed comparison halves the step", near(errors.longest_step(), 5e-3, rounding));
    ForceCourse course(1.);
    course.accept(0.01, 10.);
    const bool is_due_at_once = errors.wants_measurement(course);
    errors.accept(0.01, 1);
    check("the next step is compared", !is_due_at_once && errors.wants_measurement(course));
    for (unsigned int i = 2; i < 5; ++i)
      errors.miss(0.01, true);
    check("five in a row are not given up", !errors.has_given_up() && std::isfinite(errors.longest_step()));
    errors.miss(0.01, true);
    check("six are, and limit steps no longer", errors.has_given_up() && std::isinf(errors.longest_step()));
  }
}

} // namespace

BILLET_TEST(error_parts) {
  constexpr double tolerance = 1e-14;
  {
    ForceCourse course(2.);
    course.begin(1.);
    course.accept(0.5, 4.);
    check("work by the trapezoidal rule", std::abs(course.work() - 1.), tolerance);
    check("time and what is left", std::abs(course.time() - 1.5) + std::abs(course.left() - 0.5), tolerance);
    // A rate of 8 for another 0.5 gives 2 in the mean.
    check("forces that grow on", std::abs(course.scale() - 6.), tolerance);
    course.accept(0.25, 1.);
    check("forces that have been larger", std::abs(course.scale() - 1.625 / 0.75), tolerance);
    // At the rate of the first step the mean would be 50 times the force.
    ForceCourse sudden(1.);
    sudden.accept(0.01, 3.);
    check("forces grow on by ten times at most", std::abs(sudden.scale() - 33.), 1e-12);
  }
  {
    MeasurementInterval interval(1);
    check("the first measurement waits", !interval.is_due());
    interval.count_step();
    check("until a step is taken", interval.is_due());
    interval.start_longer();
    check("intervals have a least length", interval.length() == MeasurementInterval::min);
    interval.start_longer();
    interval.start_longer();
    check("and a largest", interval.until() == MeasurementInterval::max);
    interval.wait(0);
    check("one may be due at once", interval.is_due());
    interval.repeat();
    check("the next is as long as before", interval.until() == MeasurementInterval::max);
    const auto wait = [&] {
      return wait_for([&] {
        interval.count_step();
        return interval.is_due();
      });
    };
    check("which is eight steps", wait() == 8);
    interval.start(1);
    interval.start_longer();
    check("the shortest are four", wait() == 4);
    check("what doubles is steady", MeasurementInterval::is_steady(2., 1.) &&
                                        MeasurementInterval::is_steady(1., 2.) &&
                                        !MeasurementInterval::is_steady(2.1, 1.));
  }
  {
    ForceCourse course(1.);
    course.accept(0.5, 10.);
    PenetrationErrors errors(0.01);
    errors.accept(0.5, 10., 2.);
    check("errors are not known before a measurement", !errors.is_known() && errors.wants_measurement());
    check("but what may be allowed", std::abs(errors.allowed_at_first() - 0.01), tolerance);
    errors.measure(course, 2., force(10.), force(11.), 0.);
    // A tenth of the forces at all times; the scale is 10 + 20 * 0.5/2 = 15.
    check("errors in proportion", std::abs(errors.integral() - 0.1 * 10. * 0.5), tolerance);
    check("the penetration to allow is not below the tightest", errors.allowed(5.) == 1.);
    errors.measure(course, 200., force(10.), force(11.), 0.);
    check("the penetration to allow", std::abs(errors.allowed(5.) - 200. * 0.01 * 15.), 1e-12);
    check("twice that while the error is within the mean", std::abs(errors.allowed(50.) - 200. * 0.02 * 15.),
          1e-12);
    check("then measurements are rare", errors.is_known() && !errors.wants_measurement());
  }
  check("penetrations that cause a tenth of what is allowed are measured seldom",
        wait_after(0.095) == 8 && wait_after(0.105) == 4);
  check_steps();
  check_rates();
  check_fading_errors();
}

} // namespace error_parts_test
