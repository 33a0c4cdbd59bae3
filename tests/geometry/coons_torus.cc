// SPDX-License-Identifier: LGPL-2.1-or-later
// The quarter fillet of a round die from sets of Coons patches, read from files, against the torus that it
// is: errors and how they fall, and what happens on the seams.
#include "check_surface.h"

#include <fstream>
#include <sstream>

namespace coons_torus_test {

using namespace billet;
using namespace billet::testing;
using Point = dealii::Tensor<1, 3>;

namespace {

constexpr double ring = 7., tube = 2., quarter = 0.5 * M_PI;

/// Around the axis by the angle `around`, around the tube by `along` from its top inwards, `out` of it.
Point on_torus(const double around, const double along, const double out = 0.) {
  const double angle = quarter + along, radius = ring + (tube + out) * std::cos(angle);
  return Point({radius * std::cos(around), radius * std::sin(around), (tube + out) * std::sin(angle)});
}

std::string arc(const double around_0, const double along_0, const double around_1, const double along_1) {
  std::ostringstream text;
  text.precision(17);
  const auto print = [&text](const Point &p) { text << p[0] << ", " << p[1] << ", " << p[2]; };
  text << "arc: ";
  print(on_torus(around_0, along_0));
  text << " via ";
  print(on_torus(0.5 * (around_0 + around_1), 0.5 * (along_0 + along_1)));
  text << " to ";
  print(on_torus(around_1, along_1));
  return text.str();
}

/// The fillet in n × n patches.
SharedSurface make_fillet(const unsigned int n) {
  const std::string name = "fillet_" + std::to_string(n * n) + ".txt";
  std::ofstream file(name);
  file << "# four arcs a line\n\n";
  for (unsigned int i = 0; i < n; ++i)
    for (unsigned int j = 0; j < n; ++j) {
      const double b = quarter * i / n, c = quarter * (i + 1) / n, a = quarter * j / n,
                   d = quarter * (j + 1) / n;
      file << arc(b, a, c, a) << " ; " << arc(c, a, c, d) << " ; " << arc(c, d, b, d) << " ; "
           << arc(b, d, b, a) << "   # " << i << ", " << j << "\n";
    }
  file.close();
  return make_surface("coons patches", "set File = " + name);
}

/// Largest errors where both have a contact point.
struct Errors {
  double gap, normal, jump_of_gap, jump_of_normal;
  unsigned int n_seams;
};

Errors errors_against(const RigidSurface &torus, const RigidSurface &fillet) {
  Random random;
  WorstError gap, normal, jump_of_gap, jump_of_normal;
  for (unsigned int i = 0; i < 4000; ++i) {
    const Point x = on_torus(random(0.02, 0.98) * quarter, random(0.02, 0.98) * quarter, random(-0.3, 0.6));
    const auto p = fillet.project(x), q = torus.project(x);
    gap.add(p.exists ? std::abs(p.gap - q.gap) : 1.);
    normal.add((p.normal - q.normal).norm());
  }
  // A path over the seams, at a height that changes its sign: wherever the nearest patch changes, one
  // bisects.
  const auto path = [](const double t) {
    return on_torus((0.1 + 0.8 * t) * quarter, (0.5 + 0.4 * std::sin(9. * t)) * quarter,
                    0.1 * std::cos(30. * t));
  };
  unsigned int n_seams = 0;
  constexpr unsigned int n = 400;
  for (unsigned int i = 0; i < n; ++i) {
    double before = i / static_cast<double>(n), after = (i + 1) / static_cast<double>(n);
    const unsigned int first = fillet.project(path(before)).patch;
    if (fillet.project(path(after)).patch == first)
      continue;
    ++n_seams;
    while (after - before > 1e-13) {
      const double middle = 0.5 * (before + after);
      (fillet.project(path(middle)).patch == first ? before : after) = middle;
    }
    const auto p = fillet.project(path(before)), q = fillet.project(path(after));
    jump_of_gap.add(p.exists && q.exists ? std::abs(p.gap - q.gap) : 1.);
    jump_of_normal.add((p.normal - q.normal).norm());
  }
  return {gap.value(), normal.value(), jump_of_gap.value(), jump_of_normal.value(), n_seams};
}

} // namespace

BILLET_TEST(coons_torus) {
  const auto torus =
      make_surface("torus", "set Ring radius = 7\nset Tube radius = 2\nset From angle = 90\nset To "
                            "angle = 180\nset Sector = 90");
  Errors before{};
  for (const unsigned int n : {2, 4, 8}) {
    const auto fillet = make_fillet(n);
    const std::string name = std::to_string(n * n) + " patches";
    check_surface(name, *fillet, Point({3., 3., 0.}), 4.);
    const Errors errors = errors_against(*torus, *fillet);
    check(name + ": the path crosses seams", errors.n_seams >= 2 * n);
    check(name + ": there the gap does not jump", errors.jump_of_gap, 1e-9 * tube);
    check(name + ": the normal jumps by its errors on both sides", errors.jump_of_normal, 2. * errors.normal);
    if (n == 4) { // patches of 22.5 degrees
      check(name + ": the surface is that near to the torus", errors.gap, 4e-4 * tube);
      check(name + ": the normal is that near to the torus's", errors.normal, 4e-3);
    }
    if (n > 2) {
      check(name + ": the gap is of fourth order", std::abs(std::log2(before.gap / errors.gap) - 4.), 0.3);
      check(name + ": the normal is of third order", std::abs(std::log2(before.normal / errors.normal) - 3.),
            0.2);
    }
    before = errors;
  }
}

} // namespace coons_torus_test
