// SPDX-License-Identifier: LGPL-2.1-or-later
// The parts of error control by themselves: forces over time, intervals between measurements, and errors by
// penetrations of made-up forces.
#include "billet/solve/force_course.h"
#include "billet/solve/measurement_interval.h"
#include "billet/solve/penetration_errors.h"

#include "../testing.h"

#include <cmath>

using namespace billet;
using billet::testing::check;

int main() {
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
    check("what doubles is steady", MeasurementInterval::is_steady(2., 1.) &&
                                        MeasurementInterval::is_steady(1., 2.) &&
                                        !MeasurementInterval::is_steady(2.1, 1.));
  }
  {
    const auto force = [](const double value) { return ResultGroup{dealii::Tensor<1, 3>({value, 0., 0.})}; };
    ForceCourse course(1.);
    course.accept(0.5, 10.);
    PenetrationErrors errors(0.01);
    errors.accept(0.5, 10., 2.);
    check("errors are not known before a measurement", !errors.is_known() && errors.wants_measurement());
    check("but what may be allowed", std::abs(errors.allowed_at_first() - 0.02), tolerance);
    errors.measure(course, 2., force(10.), force(11.), 0.);
    // A tenth of the forces at all times; the scale is 10 + 20 * 0.5/2 = 15.
    check("errors in proportion", std::abs(errors.integral() - 0.1 * 10. * 0.5), tolerance);
    check("the penetration to allow is not below the tightest", errors.allowed() == 1.);
    errors.measure(course, 200., force(10.), force(11.), 0.);
    check("the penetration to allow", std::abs(errors.allowed() - 200. * 0.02 * 15.), 1e-12);
    check("then measurements are rare", errors.is_known() && !errors.wants_measurement());
  }
  return billet::testing::exit_code();
}
