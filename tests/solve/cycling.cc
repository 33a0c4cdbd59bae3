// SPDX-License-Identifier: LGPL-2.1-or-later
// Iterations that cycle are distinguished from those that stand still or converge slowly.
#include "../testing.h"
#include "billet/solve/newton.h"

#include <cmath>
#include <functional>

namespace cycling_test {

using namespace billet;
using billet::testing::check;

namespace {

bool cycles_with(const std::function<double(int)> &residual, const int n = 20) {
  std::vector<NewtonIteration> iterations;
  iterations.reserve(n);
  for (int i = 0; i < n; ++i)
    iterations.push_back({residual(i), 0., 1.});
  return is_cycling(iterations);
}

} // namespace

BILLET_TEST(cycling) {
  check("two states alternate", cycles_with([](const int i) { return i % 2 == 0 ? 1e-5 : 1e-3; }));
  check("nearly the same ones",
        cycles_with([](const int i) { return (i % 2 == 0 ? 1e-5 : 1e-3) * (1. + 0.005 * std::sin(i)); }));
  check("three", cycles_with([](const int i) { return 1. + i % 3; }));
  check("four", cycles_with([](const int i) { return i % 2 == 0 ? 1. : 5. + i % 4; }));
  check("after a while only", cycles_with([](const int i) { return i < 8 ? 1e3 / (1. + i) : 1. + i % 2; }));
  check("not yet", !cycles_with([](const int i) { return i % 2 == 0 ? 1e-5 : 1e-3; }, 11));
  check("it stands still", !cycles_with([](const int) { return 1e-3; }));
  check("it converges slowly", !cycles_with([](const int i) { return std::pow(0.99, i); }));
  check("up and down, but it converges",
        !cycles_with([](const int i) { return (1. + i % 2) * std::pow(0.9, i); }));
  check("five are no cycle", !cycles_with([](const int i) { return 1. + i % 5; }));
  check("without order", !cycles_with([](const int i) { return 1.5 + std::sin(i * i); }));
}

} // namespace cycling_test
