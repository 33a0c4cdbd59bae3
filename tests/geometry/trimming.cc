// SPDX-License-Identifier: LGPL-2.1-or-later
// Regions within loops of curves, against their closed forms, next to the border as well.
#include "billet/geometry/trimming_loops.h"

#include "../testing.h"

namespace trimming_test {

using namespace billet;
using billet::testing::check;
using billet::testing::Random;
using Point = TrimmingLoops::Point;

namespace {

/// `samples` + 1 parameters from 0 to 1.
std::vector<double> even(const unsigned int samples) {
  std::vector<double> result;
  for (unsigned int i = 0; i <= samples; ++i)
    result.push_back(double(i) / samples);
  return result;
}

/// The circle from angle `from` over `sweep`.
TrimmingLoops::Curve arc(const Point &centre, const double radius, const double from, const double sweep) {
  return [=](const double t) {
    return Point{centre[0] + radius * std::cos(from + t * sweep),
                 centre[1] + radius * std::sin(from + t * sweep)};
  };
}

TrimmingLoops::Curve line(const Point &start, const Point &end) {
  return [=](const double t) {
    return Point{start[0] + t * (end[0] - start[0]), start[1] + t * (end[1] - start[1])};
  };
}

/// `level` is negative inside and grows with slope 1 or more across the border. Points from all over the
/// square of that half width, and as many at 1e-9 from the border.
template <class Level>
void check_region(const std::string &name, const TrimmingLoops &loops, const Level &level,
                  const double reach) {
  Random random;
  unsigned int n_wrong = 0, n_inside = 0;
  for (unsigned int i = 0; i < 20000; ++i) {
    Point point{random(-reach, reach), random(-reach, reach)};
    if (i % 2 == 0) { // along a ray, to next to the border
      double low = 0., high = 2. * reach;
      const double angle = random(0., 2. * M_PI);
      const auto at = [&](const double r) { return Point{r * std::cos(angle), r * std::sin(angle)}; };
      if (level(at(low)) * level(at(high)) > 0.)
        continue;
      for (unsigned int n = 0; n < 60; ++n) {
        const double middle = 0.5 * (low + high);
        (level(at(middle)) * level(at(low)) > 0. ? low : high) = middle;
      }
      point = at(low + (i % 4 == 0 ? 1e-9 : -1e-9));
    }
    if (std::abs(level(point)) < 1e-12)
      continue;
    const bool is_inside = level(point) < 0.;
    n_inside += is_inside ? 1 : 0;
    n_wrong += is_inside == loops.contains(point) ? 0 : 1;
  }
  check(name + ": there are points inside", n_inside > 1000);
  check(name, n_wrong == 0);
}

} // namespace

BILLET_TEST(trimming) {
  TrimmingLoops circle(1e-9);
  circle.add(arc({0.1, 0.2}, 1., 0.3, 2. * M_PI), even(12));
  const auto disc = [](const Point &p) { return std::hypot(p[0] - 0.1, p[1] - 0.2) - 1.; };
  check_region("circle", circle, disc, 1.5);

  TrimmingLoops halves(1e-9); // in two parts, the second against the first's direction
  halves.add(arc({0.1, 0.2}, 1., -2., 3.), even(9));
  halves.add(arc({0.1, 0.2}, 1., -2., 3. - 2. * M_PI), even(9));
  check_region("circle of two parts", halves, disc, 1.5);

  TrimmingLoops holed(1e-6); // whose corners meet within the tolerance only
  const double off = 1e-8;
  holed.add(line({-1., -1.}, {1., -1.}), even(1));
  holed.add(line({1., -1. + off}, {1., 1.}), even(1));
  holed.add(line({1., 1. + off}, {-1., 1. - off}), even(1));
  holed.add(line({-1., 1.}, {-1., -1. - off}), even(1));
  holed.add(arc({0., 0.}, 0.5, 0., -2. * M_PI), even(10));
  const auto square_with_hole = [](const Point &p) {
    return std::max(std::max(std::abs(p[0]), std::abs(p[1])) - 1., 0.5 - std::hypot(p[0], p[1]));
  };
  unsigned int n_wrong = 0;
  Random random;
  for (unsigned int i = 0; i < 20000; ++i) {
    const Point point{random(-1.5, 1.5),
                      i % 3 == 0 ? (i % 2 == 0 ? 1. : -1.) + random(-2e-8, 2e-8) : random(-1.5, 1.5)};
    const double level = square_with_hole(point);
    n_wrong += std::abs(level) > 3e-8 && (level < 0.) != holed.contains(point) ? 1 : 0;
  }
  check("square with a hole, its corners a little apart", n_wrong == 0);

  TrimmingLoops flower(1e-9);
  const auto radius = [](const double angle) { return 1. + 0.3 * std::cos(5. * angle); };
  flower.add(
      [&](const double t) {
        const double angle = 2. * M_PI * t;
        return Point{radius(angle) * std::cos(angle), radius(angle) * std::sin(angle)};
      },
      even(80));
  check_region(
      "flower", flower,
      [&](const Point &p) { return std::hypot(p[0], p[1]) - radius(std::atan2(p[1], p[0])); }, 1.5);
}

} // namespace trimming_test
