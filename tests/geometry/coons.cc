// SPDX-License-Identifier: LGPL-2.1-or-later
// Curves and Coons patches: against closed forms and differences, what holds for any surface, closest points
// against points all over the patch.
#include "billet/geometry/coons_patch.h"

#include "check_surface.h"

#include <sstream>
#include <stdexcept>

namespace coons_test {

using namespace billet;
using namespace billet::testing;
using Point = dealii::Tensor<1, 3>;
using Jet = CoonsPatch::Jet;

namespace {

struct Example {
  std::string name, curves;
  Point centre;
  double size; ///< of the box to look at
};

const std::string flat = "line: 0, 0, 1 to 4, 0, 2 ; line: 4, 0, 2 to 4, 3, 2 ; line: 4, 3, 2 to 0, 3, 1 ; "
                         "line: 0, 3, 1 to 0, 0, 1";
const std::string saddle = "line: 0, 0, 0 to 2, 0, 1 ; line: 2, 0, 1 to 2, 2, 0 ; line: 2, 2, 0 to 0, 2, 1 ; "
                           "line: 0, 2, 1 to 0, 0, 0"; // z = (x + y - x y)/2
/// A sixth of a cylinder of radius 2 about z.
const std::string cylinder = "arc: 2, 0, -1 via 1.7320508075688772, 1, -1 to 1, 1.7320508075688772, -1 ; "
                             "line: 1, 1.7320508075688772, -1 to 1, 1.7320508075688772, 3 ; "
                             "arc: 1, 1.7320508075688772, 3 via 1.7320508075688772, 1, 3 to 2, 0, 3 ; "
                             "line: 2, 0, 3 to 2, 0, -1";
/// Bounded by the sides of an octant of a sphere of radius 2, with the pole on z.
const std::string octant = "arc: 2, 0, 0 via 1.4142135623730951, 1.4142135623730951, 0 to 0, 2, 0 ; "
                           "arc: 0, 2, 0 via 0, 1.4142135623730951, 1.4142135623730951 to 0, 0, 2 ; "
                           "point: 0, 0, 2 ; "
                           "arc: 0, 0, 2 via 1.4142135623730951, 0, 1.4142135623730951 to 2, 0, 0";
/// A cone's: circles of radii 2 and 3 about y, over 150 degrees, seen from inside.
const std::string cone =
    "line: 1.2855752193730787, 0, -1.532088886237956 to 1.9283628290596182, 2, -2.298133329356934 ; "
    "arc: 1.9283628290596182, 2, -2.298133329356934 via 2.71892336110995, 2, 1.2678547852220984 "
    "to -0.5209445330007911, 2, 2.954423259036624 ; "
    "line: -0.5209445330007911, 2, 2.954423259036624 to -0.3472963553338607, 0, 1.969615506024416 ; "
    "arc: -0.3472963553338607, 0, 1.969615506024416 via 1.8126155740732999, 0, 0.8452365234813989 "
    "to 1.2855752193730787, 0, -1.532088886237956";
/// A triangle with a pole at (2.9, 2, 0), where the sides are far from straight.
const std::string sail = "spline: 0.1, 0, -0.2 via 1.6, 0.1, -0.2 to 2.9, 0, -0.1 ; "
                         "spline: 2.9, 0, -0.1 via 2.9, 1.1, -0.1 to 2.9, 2, 0 ; point: 2.9, 2, 0 ; "
                         "spline: 2.9, 2, 0 via 0.1, 1.2, -0.2 to 0.1, 0, -0.2";
const std::string splines = "spline: 0, 0, 0 via 1, 0.2, 0.6 via 2, 0, 0.2 to 3, 0, 0 ; "
                            "spline: 3, 0, 0 via 3.3, 1, -0.3 to 3, 2, 0.3 ; "
                            "arc: 3, 2, 0.3 via 1.5, 2.5, 0.2 to 0, 2, 0 ; "
                            "spline: 0, 2, 0 via -0.3, 1.4, -0.2 via 0.1, 0.7, 0.2 to 0, 0, 0";
/// X_u and X_v are parallel in the corners.
const std::string disc = "arc: 1, 0, 0 via 0.7071067811865476, 0.7071067811865476, 0 to 0, 1, 0 ; "
                         "arc: 0, 1, 0 via -0.7071067811865476, 0.7071067811865476, 0 to -1, 0, 0 ; "
                         "arc: -1, 0, 0 via -0.7071067811865476, -0.7071067811865476, 0 to 0, -1, 0 ; "
                         "arc: 0, -1, 0 via 0.7071067811865476, -0.7071067811865476, 0 to 1, 0, 0";

/// The last curve first: u becomes v.
std::string begun_later(const std::string &curves) {
  const auto last = curves.rfind(';');
  return curves.substr(last + 1) + " ; " + curves.substr(0, last);
}

CoonsPatch make_patch(const std::string &curves) {
  std::array<CurveSketch, 4> sketches;
  std::istringstream stream(curves);
  std::string curve;
  for (auto &sketch : sketches) {
    std::getline(stream, curve, ';');
    sketch = read_curve(curve);
  }
  return CoonsPatch(sketches);
}

void check_curves() {
  // Slopes ±2, knots half apart: the second derivative in the middle is -12.
  const Curve bow(read_curve("spline: 0, 0, 0 via 1, 1, 0 to 2, 0, 0"));
  WorstError closed, smooth, through;
  for (unsigned int i = 0; i <= 10; ++i) {
    const double t = 0.05 * i;
    const Curve::Jet jet = bow.at(t);
    closed.add((jet.position - Point({2. * t, t * (3. - 4. * t * t), 0.})).norm());
    closed.add((jet.first - Point({2., 3. - 12. * t * t, 0.})).norm());
    closed.add((jet.second - Point({0., -24. * t, 0.})).norm());
  }
  check("spline through three points: closed form", closed.value(), 1e-14);

  const std::vector<Point> points{Point({0., 0., 0.}), Point({1., 2., 0.}), Point({3., 1., 1.}),
                                  Point({3., 1., 4.}), Point({7., 0., 4.})};
  const Curve spline({CurveSketch::Kind::spline, points});
  double length = 0., t = 0.;
  for (std::size_t i = 1; i < points.size(); ++i)
    length += (points[i] - points[i - 1]).norm();
  for (std::size_t i = 0; i < points.size(); ++i) {
    t += i > 0 ? (points[i] - points[i - 1]).norm() / length : 0.;
    through.add((spline.at(t).position - points[i]).norm());
    const Curve::Jet before = spline.at(t - 1e-9), after = spline.at(t + 1e-9);
    smooth.add((after.first - before.first).norm() + (after.second - before.second).norm());
  }
  check("spline: through its points", through.value(), 1e-13);
  check("spline: two derivatives are continuous", smooth.value(), 1e-5); // 2e-9 times the third
  check("spline: no second derivative at the ends", spline.at(0.).second.norm() + spline.at(1.).second.norm(),
        1e-12);

  const Curve arc(read_curve("arc: 1, 0, 5 via -1, 0, 5 to 0, -1, 5")); // three quarters of a circle
  WorstError on_circle;
  for (unsigned int i = 0; i <= 12; ++i) {
    const double angle = i * M_PI / 8.;
    on_circle.add((arc.at(i / 12.).position - Point({std::cos(angle), std::sin(angle), 5.})).norm());
  }
  check("arc of more than half a circle", on_circle.value(), 1e-14);
  const Curve flat_arc(read_curve("arc: 0, 0, 0 via 1, 1e-6, 0 to 2, 0, 0"));
  check("arc with a far centre", (flat_arc.at(1.).position - Point({2., 0., 0.})).norm(), 1e-12);
}

/// u and v run along the circle and the axis, or along x and y.
void check_closed_forms() {
  const CoonsPatch round = make_patch(cylinder), bilinear = make_patch(saddle);
  Random random;
  WorstError of_cylinder, of_saddle;
  for (unsigned int i = 0; i < 100; ++i) {
    const double u = random(0., 1.), v = random(0., 1.), a = M_PI / 3., c = std::cos(a * u),
                 s = std::sin(a * u);
    const Jet j = round.at(u, v), k = bilinear.at(u, v);
    of_cylinder.add((j.position - Point({2. * c, 2. * s, 4. * v - 1.})).norm());
    of_cylinder.add((j.u - 2. * a * Point({-s, c, 0.})).norm() + (j.v - Point({0., 0., 4.})).norm());
    of_cylinder.add((j.uu + 2. * a * a * Point({c, s, 0.})).norm() + j.uv.norm() + j.vv.norm());
    of_saddle.add((k.position - Point({2. * u, 2. * v, u + v - 2. * u * v})).norm());
    of_saddle.add((k.u - Point({2., 0., 1. - 2. * v})).norm() + (k.v - Point({0., 2., 1. - 2. * u})).norm());
    of_saddle.add(k.uu.norm() + (k.uv - Point({0., 0., -2.})).norm() + k.vv.norm());
  }
  check("a piece of a cylinder is one", of_cylinder.value(), 1e-14);
  check("lines span a bilinear surface", of_saddle.value(), 1e-14);

  const auto drawn = make_surface("coons patch", "set Curves = " + cylinder);
  const auto whole =
      make_surface("cylinder", "set Point = 0, 0, 1\nset Radius = 2\nset Length = 4\nset Sector = 60");
  WorstError projections;
  unsigned int n = 0;
  for (unsigned int i = 0; i < 1000; ++i) {
    const Point x({random(-1., 4.), random(-1., 4.), random(-2., 4.)});
    const auto p = drawn->project(x), q = whole->project(x);
    projections.add(p.exists == q.exists ? std::abs(p.gap - q.gap) : 1.);
    if (p.exists) {
      projections.add((p.normal - q.normal).norm() + (p.turning - q.turning).norm());
      ++n;
    }
  }
  check("it is projected upon as the cylinder is", n > 200 ? projections.value() : 1., 1e-11);
  check("on the cylinder's axis, where many points are nearest",
        std::abs(drawn->project(Point({0., 0., 1.3})).gap + 2.), 1e-13);
  check("... no normal is the one, and it does not turn", drawn->project(Point({0., 0., 1.3})).turning.norm(),
        1e-12);
}

void check_derivatives(const Example &example) {
  const CoonsPatch patch = make_patch(example.curves);
  Random random;
  WorstError first, second, across;
  const double h = 1e-3;
  unsigned int n = 0;
  for (unsigned int i = 0; i < 200; ++i) {
    const double u = random(0.01, 0.99), v = random(0.01, 0.99);
    const Jet jet = patch.at(u, v);
    const Point normal = patch.normal(jet, u, v);
    across.add(std::abs(normal.norm() - 1.) + std::abs(normal * jet.u) + std::abs(normal * jet.v));
    // The third derivative of a spline jumps at its knots.
    const Point jump_u = patch.at(u + 2.5 * h, v).uu - 2. * jet.uu + patch.at(u - 2.5 * h, v).uu,
                jump_v = patch.at(u, v + 2.5 * h).vv - 2. * jet.vv + patch.at(u, v - 2.5 * h).vv;
    if (jump_u.norm() + jump_v.norm() > 1e-3)
      continue;
    ++n;
    const auto by_u = [&](const auto member) {
      return central_difference([&](const double s) { return patch.at(u + s, v).*member; }, h);
    };
    const auto by_v = [&](const auto member) {
      return central_difference([&](const double s) { return patch.at(u, v + s).*member; }, h);
    };
    first.add((by_u(&Jet::position) - jet.u).norm() + (by_v(&Jet::position) - jet.v).norm());
    second.add((by_u(&Jet::u) - jet.uu).norm() + (by_v(&Jet::u) - jet.uv).norm());
    second.add((by_u(&Jet::v) - jet.uv).norm() + (by_v(&Jet::v) - jet.vv).norm());
  }
  check(example.name + ": first derivatives", n > 150 ? first.value() : 1., 1e-9);
  check(example.name + ": second derivatives", second.value(), 1e-9);
  check(example.name + ": the normal is a unit vector across both", across.value(), 1e-12);
}

std::vector<Point> points_of(const CoonsPatch &patch) {
  std::vector<Point> points;
  constexpr unsigned int n = 150;
  for (unsigned int i = 0; i <= n; ++i)
    for (unsigned int j = 0; j <= n; ++j)
      points.push_back(patch.at(i / static_cast<double>(n), j / static_cast<double>(n)).position);
  return points;
}

double distance_to(const std::vector<Point> &points, const Point &x) {
  double square = std::numeric_limits<double>::infinity();
  for (const auto &point : points)
    square = std::min(square, (x - point).norm_square());
  return std::sqrt(square);
}

/// From near, from far, about the corners and the centre: no point of a grid is nearer, and one is almost as
/// near; the answer is the same whatever was asked before.
void check_against_points(const Example &example) {
  const CoonsPatch patch = make_patch(example.curves);
  const std::vector<Point> grid = points_of(patch);
  Random random;
  WorstError nearer, farther, again;
  const std::vector<Point> about{example.centre,
                                 example.centre,
                                 patch.at(0., 0.).position,
                                 patch.at(1., 0.).position,
                                 patch.at(1., 1.).position,
                                 patch.at(0., 1.).position};
  for (unsigned int i = 0; i < 600; ++i) {
    Point x = about[i % 6];
    const double reach = (i % 6 == 0 ? 30. : i % 6 == 1 ? 1. : 0.1) * example.size;
    for (unsigned int c = 0; c < 3; ++c)
      x[c] += random(-reach, reach);
    const ClosestPoint closest = patch.closest_point(x);
    const double distance = (x - closest.position).norm(), brute = distance_to(grid, x);
    nearer.add((distance - brute) / (distance + example.size));
    farther.add((brute - distance) / example.size);
    patch.closest_point(-1. * x);
    again.add((patch.closest_point(x).position - closest.position).norm());
  }
  check(example.name + ": no point of a grid is nearer", nearer.value(), 1e-14);
  check(example.name + ": the nearest one is almost as near", farther.value(), 0.02);
  check(example.name + ": the answer does not depend on what was asked before", again.value(), 0.);
}

void check_degenerate() {
  const CoonsPatch patch = make_patch(octant);
  WorstError normals;
  for (const double u : {0., 0.3, 1.})
    normals.add((patch.normal(patch.at(u, 1.), u, 1.) - Point({0., 0., 1.})).norm());
  check("pole: the normal is a limit", normals.value(), 1e-14);
  const ClosestPoint above = patch.closest_point(Point({0., 0., 3.}));
  check("pole: a point above", std::abs(above.gap - 1.) + above.is_beyond_edge, 1e-14);
  check("pole: curvatures are finite there", std::abs(dealii::trace(above.turning)) < 1.);
  const ClosestPoint beside = patch.closest_point(Point({-0.1, -0.1, 3.}));
  check("pole: a point beside", beside.is_beyond_edge ? (beside.position - Point({0., 0., 2.})).norm() : 1.,
        1e-13);
  // In all directions between the sides, very near to the pole: the foot is not the pole.
  WorstError feet;
  for (unsigned int i = 15; i <= 75; ++i) {
    const double angle = i * M_PI / 180., sine = 1e-4;
    const Point x(
        {3. * sine * std::cos(angle), 3. * sine * std::sin(angle), 3. * std::sqrt(1. - sine * sine)});
    const ClosestPoint closest = patch.closest_point(x);
    feet.add(closest.is_beyond_edge ? 1. : (x - closest.position - closest.gap * closest.normal).norm());
  }
  check("pole: points just beside it, all around", feet.value(), 1e-12);
  // Where Newton's method runs into the pole along a wrong side.
  const CoonsPatch triangle = make_patch(sail);
  const std::vector<Point> grid = points_of(triangle);
  Random random;
  WorstError nearer;
  for (unsigned int i = 0; i < 1000; ++i) {
    const Point x({2.9 + random(0., 2.), 2. + random(-0.5, 0.5), random(-1.5, 1.5)});
    nearer.add((x - triangle.closest_point(x).position).norm() - distance_to(grid, x));
  }
  check("pole: no point of a grid is nearer", nearer.value(), 1e-14);
  const CoonsPatch plate = make_patch(disc);
  check("disc: the normal in a corner is a limit",
        (plate.normal(plate.at(0., 0.), 0., 0.) - Point({0., 0., 1.})).norm(), 1e-14);
}

/// What crosses itself, though its normals turn smoothly; and what only meets itself, in a seam.
void check_crossings() {
  const auto is_refused = [](const std::string &curves) {
    try {
      make_patch(curves);
    } catch (const std::invalid_argument &error) {
      return std::string(error.what()).find("crosses itself") != std::string::npos;
    }
    return false;
  };
  check(
      "a swept loop crosses itself",
      is_refused("spline: -2, 0, 0 via 0, 0, 1 via 1, 0, 2 via 0, 0, 3 via -1, 0, 2 via 0, 0, 1 to 2, 0, 0 ; "
                 "line: 2, 0, 0 to 2, 5, 0 ; spline: 2, 5, 0 via 0, 5, 1 via -1, 5, 2 via 0, 5, 3 via 1, 5, "
                 "2 via 0, 5, 1 to "
                 "-2, 5, 0 ; line: -2, 5, 0 to -2, 0, 0"));
  check("a flat ring of more than a turn lies on itself",
        is_refused(
            "spline: 2, 0, 0 via 0, 2, 0 via -2, 0, 0 via 0, -2, 0 via 2.1, 0, 0 to 0, 2.2, 0 ; line: 0, "
            "2.2, 0 to 0, 4.2, 0 ; spline: 0, 4.2, 0 via 4.1, 0, 0 via 0, -4, 0 via -4, 0, 0 via 0, 4, 0 "
            "to 4, 0, 0 ; line: 4, 0, 0 to 2, 0, 0"));
  const CoonsPatch tube = make_patch(
      "spline: 2, 0, 0 via 0, 2, 0 via -2, 0, 0 via 0, -2, 0 to 2, 0, 0 ; line: 2, 0, 0 to 2, 0, 3 ; "
      "spline: 2, 0, 3 via 0, -2, 3 via -2, 0, 3 via 0, 2, 3 to 2, 0, 3 ; line: 2, 0, 3 to 2, 0, 0");
  check("a tube that meets itself in a seam is a patch",
        std::abs(tube.closest_point(Point({-4., 0., 1.})).gap - 2.), 1e-12);
}

} // namespace

BILLET_TEST(coons) {
  check_curves();
  check_closed_forms();
  const std::vector<Example> examples = {
      {"flat", flat, Point({2., 1.5, 1.5}), 3.},
      {"saddle", saddle, Point({1., 1., 0.5}), 2.},
      {"piece of a cylinder", cylinder, Point({1., 1., 1.}), 3.},
      {"octant with a pole", octant, Point({1., 1., 1.}), 2.},
      {"piece of a cone from inside", cone, Point({1., 1., 0.}), 3.},
      {"the same, begun at another corner", begun_later(cone), Point({1., 1., 0.}), 3.},
      {"sail with a pole", sail, Point({2., 1., 0.}), 2.},
      {"splines", splines, Point({1.5, 1., 0.}), 2.},
      {"disc of four arcs", disc, Point(), 1.2}};
  for (const auto &example : examples) {
    check_derivatives(example);
    check_surface(example.name, *make_surface("coons patch", "set Curves = " + example.curves),
                  example.centre, example.size);
    check_against_points(example);
  }
  check_degenerate();
  check_crossings();
}

} // namespace coons_test
