// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/times.h"

#include "../testing.h"

namespace times_test {

using billet::testing::check;
namespace times = billet::times;

// Times that sums of steps reach with round-off, and times that are others.

BILLET_TEST(times) {
  double sum = 0.;
  for (unsigned int step = 0; step < 1000000; ++step)
    sum += 1e-6;
  check("a million steps do not end at 1 exactly", sum != 1.);
  check("their sum is not before 1", !times::is_before(sum, 1.));
  check("nor after it", !times::is_after(sum, 1.));
  check("a millionth is a difference", times::is_before(1. - 1e-6, 1.) && times::is_after(1. + 1e-6, 1.));
  check("2e-9 is a difference", times::is_before(1. - 2e-9, 1.) && times::is_after(1. + 2e-9, 1.));
  check("5e-10 is none", !times::is_before(1. - 5e-10, 1.) && !times::is_after(1. + 5e-10, 1.));
  check("nothing is before the start", !times::is_before(0., 0.) && !times::is_after(0., 0.));
  bool is_whole = true, is_exact = true;
  for (unsigned int n = 1; n <= 1000; ++n) {
    double of_steps = 0.;
    for (unsigned int step = 0; step < n; ++step)
      of_steps += 0.01;
    is_whole =
        is_whole && times::count_intervals(of_steps, 0.01) == n && times::count_steps(of_steps, 0.01) == n;
    is_exact = is_exact && std::floor(of_steps / 0.01) == n && std::ceil(of_steps / 0.01) == n;
  }
  check("sums of intervals are whole", is_whole);
  check("quotients alone are not", !is_exact);
  check("a part of an interval is none", times::count_intervals(2.999, 1.) == 2.);
  check("a rest needs a step", times::count_steps(2.001, 1.) == 3.);
  check("there is one step at least", times::count_steps(1e-12, 1.) == 1.);
}

} // namespace times_test
