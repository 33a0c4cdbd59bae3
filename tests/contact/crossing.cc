// SPDX-License-Identifier: LGPL-2.1-or-later
// Paths of nodes: conservative advancement against closed forms, for surfaces given by formulas and for
// facets.
#include "billet/contact/crossing.h"
#include "billet/contact/facet_paths.h"

#include "../testing.h"

#include <deal.II/base/mpi.h>

#include <cmath>

namespace crossing_test {

using namespace billet;
using billet::testing::check;
using dealii::Tensor;
using Side = SurfaceSide::Side;
using Point = Tensor<1, 3>;

namespace {

Point at(const double x, const double y, const double z) { return Point({x, y, z}); }

constexpr double resolution = 0.01;

/// Parts found are short of the true ones by no more than a 32nd of the resolution's way.
double tolerance(const double length) { return resolution / (16. * length); }

/// A half-space z < 0 in which nodes may be `depth` deep.
SurfaceSide plane(const Point &x, const double depth) {
  return {x[2] < 0. ? Side::behind : Side::front, std::abs(x[2]), Point({0., 0., 1.}), x[2] < -depth};
}

/// A plate of this thickness, whose upper face is z = 0. It has no depth that is too deep.
SurfaceSide plate(const Point &x, const double thickness) {
  const bool is_above = x[2] > -0.5 * thickness;
  const double gap = is_above ? x[2] : -thickness - x[2];
  return {gap < 0. ? Side::behind : Side::front, std::abs(gap), Point({0., 0., is_above ? 1. : -1.}), false};
}

/// The part x < 0 of the plane z = 0.
SurfaceSide half_plane(const Point &x, const double depth) {
  if (x[0] < 0.)
    return plane(x, depth);
  const double distance = std::hypot(x[0], x[2]);
  const bool is_beyond = std::abs(x[2]) < 0.5 * distance;
  return {is_beyond   ? Side::beyond
          : x[2] < 0. ? Side::behind
                      : Side::front,
          distance, Point({0., 0., 1.}), !is_beyond && x[2] < -depth};
}

/// A cylinder about y.
SurfaceSide cylinder(const Point &x, const double radius, const double depth) {
  const double rho = std::hypot(x[0], x[2]), gap = rho - radius;
  return {gap < 0. ? Side::behind : Side::front, std::abs(gap), Point({x[0] / rho, 0., x[2] / rho}),
          gap < -depth};
}

/// The body below z = 0 and a second plane through the y axis, whose normal has this component along z.
SurfaceSide edge(const Point &x, const double along_z) {
  const Point normals[2] = {at(0., 0., 1.), at(std::sqrt(1. - along_z * along_z), 0., along_z)};
  const double gaps[2] = {x * normals[0], x * normals[1]};
  const std::size_t nearest = gaps[0] > gaps[1] ? 0 : 1;
  return {gaps[nearest] < 0. ? Side::behind : Side::front, std::abs(gaps[nearest]), normals[nearest], false};
}

/// The crease of a fold: one flank is z = 0, above its body; the other, beneath its own, slopes down to the
/// first.
SurfaceSide crease(const Point &x, const double depth) {
  const Point normals[2] = {at(0., 0., 1.), at(-0.6, 0., -0.8)};
  const double gaps[2] = {x[2], normals[1] * x};
  const std::size_t nearest = std::abs(gaps[0]) < std::abs(gaps[1]) ? 0 : 1;
  return {gaps[nearest] < 0. ? Side::behind : Side::front, std::abs(gaps[nearest]), normals[nearest],
          gaps[nearest] < -depth};
}

template <class Surface>
double free_part(const Point &from, const Point &to, const Surface &surface,
                 unsigned int *n_evaluations = nullptr) {
  return find_free_part(
      [&](const double s) {
        if (n_evaluations != nullptr)
          ++*n_evaluations;
        return surface((1. - s) * from + s * to);
      },
      (to - from).norm(), resolution);
}

void check_formulas() {
  const auto deep = [](const double depth) { return [=](const Point &x) { return plane(x, depth); }; };
  // Down through a plane: to the depth that is allowed.
  check("plane, straight", std::abs(free_part(at(0., 0., 1.), at(0., 0., -3.), deep(0.2)) - 1.2 / 4.),
        tolerance(4.));
  check("plane, oblique", std::abs(free_part(at(0., 0., 1.), at(30., 0., -3.), deep(0.2)) - 1.2 / 4.),
        tolerance(30.));
  check("plane, not so deep", free_part(at(0., 0., 1.), at(0., 0., -0.1), deep(0.2)) == 1.);
  check("plane, away", free_part(at(0., 0., 1.), at(0., 0., 50.), deep(0.2)) == 1.);
  check("plane, from contact", std::abs(free_part(at(0., 0., -0.1), at(0., 0., -1.1), deep(0.2)) - 0.1),
        tolerance(1.));
  check("plane, already deeper", free_part(at(0., 0., -0.3), at(0., 0., -1.), deep(0.2)) == 1.);
  unsigned int n = 0;
  free_part(at(0., 0., 1000.), at(0., 0., 1.), deep(0.2), &n);
  check("far away costs one evaluation", n == 1);

  n = 0;
  check("a way without measure ends", free_part(at(0., 0., -0.1), at(1e15, 0., -0.1), deep(0.2), &n) == 1.);
  check("after so many evaluations at most", n <= 10002);

  const auto thin = [](const Point &x) { return plate(x, 0.05); };
  check("plate, to its middle", std::abs(free_part(at(0., 0., 1.), at(0., 0., -1.), thin) - 1.025 / 2.),
        tolerance(2.));
  check("plate, from below", std::abs(free_part(at(0., 0., -1.05), at(0., 0., 0.95), thin) - 1.025 / 2.),
        tolerance(2.));

  // Down at 0.05 beside the edge of a block, to where its side is nearer; and of a blade, to its middle.
  const auto block = [](const Point &x) { return edge(x, -0.1); };
  check("edge of a block, past its middle", free_part(at(-0.05, 0., 1.), at(-0.05, 0., -0.2), block) == 1.);
  const double c = -0.9, s = std::sqrt(1. - c * c), middle = 0.05 * s / (1. - c);
  check(
      "edge of a blade, to its middle",
      std::abs(free_part(at(-0.05, 0., 1.), at(-0.05, 0., -1.), [c](const Point &x) { return edge(x, c); }) -
               (1. + middle) / 2.),
      tolerance(2.));

  // Into the crease at 0.05 below one flank, to where the other is nearer; and on through the other, until
  // the first is nearer again: 0.6 x - 0.04 = 0.05.
  const auto fold = [](const Point &x) { return crease(x, 0.2); };
  check("crease, between its flanks", free_part(at(-0.5, 0., -0.05), at(0.06, 0., -0.05), fold) == 1.);
  check("crease, through the other flank",
        std::abs(free_part(at(-0.5, 0., -0.05), at(1.5, 0., -0.05), fold) - (0.5 + 0.15) / 2.),
        tolerance(2.));

  const auto half = [](const Point &x) { return half_plane(x, 0.2); };
  check("border, through", std::abs(free_part(at(-0.5, 0., 1.), at(-0.5, 0., -3.), half) - 1.2 / 4.),
        tolerance(4.));
  check("border, beside", free_part(at(0.5, 0., 1.), at(0.5, 0., -3.), half) == 1.);
  check("border, close beside", free_part(at(0.02, 0., 1.), at(0.02, 0., -3.), half) == 1.);
  check("border, in from beside", free_part(at(0.5, 0., -0.5), at(-2., 0., -0.5), half) == 1.);

  const auto roll = [](const Point &x) { return cylinder(x, 5., 2.); };
  // Beside the axis by a: too deep where the distance from the axis is 3.
  for (const double a : {0., 1., 2.5}) {
    const double way = 6. - std::sqrt(9. - a * a);
    check("roll, beside its axis by " + std::to_string(a).substr(0, 3),
          std::abs(free_part(at(a, 0., 6.), at(a, 0., -6.), roll) - way / 12.), tolerance(12.));
  }
  check("roll, a chord that is not so deep", free_part(at(4., 0., 6.), at(4., 0., -6.), roll) == 1.);
}

/// Two plates of n x n facets over a square of side 1, at the height 0 (facing up) and at `height` (facing
/// down).
struct Plates {
  std::vector<std::uint64_t> keys;
  std::vector<SurfaceFacet> facets;
  FacetPaths::Positions positions;

  Plates(const unsigned int n, const double height, const double shift) {
    for (unsigned int surface = 0; surface < 2; ++surface) {
      const auto first = static_cast<unsigned int>(positions.size());
      for (unsigned int j = 0; j <= n; ++j)
        for (unsigned int i = 0; i <= n; ++i) {
          keys.push_back(positions.size());
          positions.push_back(
              Point({(i + surface * shift) / n, (j + surface * shift) / n, surface * height}));
        }
      for (unsigned int j = 0; j < n; ++j)
        for (unsigned int i = 0; i < n; ++i) {
          const unsigned int a = first + j * (n + 1) + i, b = a + n + 1;
          SurfaceFacet facet{};
          facet.nodes = surface == 0 ? std::array<unsigned int, 4>{a, a + 1, b, b + 1}
                                     : std::array<unsigned int, 4>{a + 1, a, b + 1, b};
          facet.surface = surface;
          facet.key = facets.size();
          facets.push_back(facet);
        }
    }
  }
  FacetPaths paths(const double depth) const {
    return {MPI_COMM_WORLD, FacetSearch::Partners::other_surfaces, keys, facets,
            std::vector<double>(facets.size(), depth)};
  }
  /// The upper one by `upper`, both by `both`.
  FacetPaths::Positions moved(const Point &upper, const Point &both = {}) const {
    FacetPaths::Positions result = positions;
    for (std::size_t i = 0; i < result.size(); ++i)
      result[i] += both + (i >= result.size() / 2 ? upper : Point());
    return result;
  }
};

void check_facets() {
  const double depth = 0.05;
  for (const double shift : {0., 0.3}) {
    const std::string name = shift == 0. ? ", nodes above nodes" : ", nodes above facets";
    const Plates plates(4, 2., shift);
    const auto part = [&](const Point &upper, const Point &both = {}, const bool is_thorough = false) {
      return plates.paths(depth).find_free_part(plates.positions, plates.moved(upper, both), is_thorough);
    };
    const double slack = 0.25 * depth / 8.;
    check("facets, down" + name, std::abs(part(at(0., 0., -8.)) * 8. - 2.05), slack);
    check("facets, down, and both go far" + name,
          std::abs(part(at(0., 0., -8.), at(100., 50., 20.)) * 8. - 2.05), 2. * slack);
    check("facets, oblique" + name, std::abs(part(at(0.1, 0., -8.)) * 8. - 2.05), 2. * slack);
    check("facets, past each other" + name, part(at(40., 0., -8.)) == 1.);
    check("facets, not so deep" + name, part(at(0., 0., -2.04)) == 1.);
    check("facets, up" + name, part(at(0., 0., 8.)) == 1.);
  }
  const Plates touching(3, -0.04, 0.2);
  FacetPaths paths = touching.paths(depth);
  check("small motions pass",
        paths.find_free_part(touching.positions, touching.moved(at(0., 0., -0.011)), false) == 1.);
  check("but not where each is looked at",
        paths.find_free_part(touching.positions, touching.moved(at(0., 0., -0.011)), true) < 1.);
  const Plates lost(3, -1., 0.2);
  FacetPaths of_lost = lost.paths(depth);
  check("what begins behind is another's matter",
        of_lost.find_free_part(lost.positions, lost.moved(at(0., 0., -1.)), true) == 1.);
}

} // namespace

BILLET_MPI_TEST(crossing) {
  check_formulas();
  check_facets();
}

} // namespace crossing_test
