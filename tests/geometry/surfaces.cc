// SPDX-License-Identifier: LGPL-2.1-or-later
// Every closed-form surface as a user describes it: closest points, normals and curvatures, whole and
// trimmed, from outside and inside; points where many are nearest; curvatures against their closed forms.
#include "check_surface.h"

namespace surfaces_test {

using namespace billet;
using namespace billet::testing;
using dealii::Tensor;

namespace {

/// Principal curvatures on the surface at the foot of x, ascending by size of the largest two.
std::array<double, 2> curvatures(const RigidSurface &surface, const Tensor<1, 3> &x) {
  const auto p = surface.project(x);
  const auto foot = surface.project(x - p.gap * p.normal);
  const double trace = dealii::trace(foot.turning);
  const double square = dealii::scalar_product(foot.turning, foot.turning); // k1² + k2²
  const double difference = std::sqrt(std::max(0., 2. * square - trace * trace));
  return {0.5 * (trace - difference), 0.5 * (trace + difference)};
}

void check_curvatures(const std::string &name, const RigidSurface &surface, const Tensor<1, 3> &x,
                      const std::array<double, 2> &expected) {
  const auto found = curvatures(surface, x);
  check(name, std::hypot(found[0] - expected[0], found[1] - expected[1]), 1e-7);
}

void check_gap(const std::string &name, const RigidSurface &surface, const Tensor<1, 3> &x,
               const double gap) {
  const auto p = surface.project(x);
  check(name, p.exists ? std::abs(p.gap - gap) + std::abs(p.normal.norm() - 1.) : 1., 1e-12);
}

/// Where many points are as near: the normal turns with x only in the directions in which it does so around.
void check_turning(const std::string &name, const RigidSurface &surface, const Tensor<1, 3> &x,
                   const Tensor<2, 3> &expected = {}) {
  check(name + ": how the normal turns", (surface.project(x).turning - expected).norm(), 1e-12);
}

} // namespace

BILLET_TEST(surfaces) {
  const Tensor<1, 3> origin;
  const Tensor<1, 3> c({1., -2., 0.5});
  const std::string at = "set Centre = 1, -2, 0.5\n", about = "set Axis = 1, 2, 2\n",
                    inside = "set Side = inside\n";

  check_surface("plane", *make_surface("plane", "set Point = 1, 2, 3\nset Normal = 1, 1, 0"), c, 5.);
  check_surface(
      "rectangle",
      *make_surface("rectangle",
                    at + "set Normal = 1, 2, 2\nset Direction = 1, 0, 1\nset Length = 6\nset Width = 3"),
      c, 3.);
  check_surface("disc", *make_surface("disc", at + "set Normal = 1, 2, 2\nset Radius = 4"), c, 4.);
  check_surface("ring", *make_surface("disc", at + "set Radius = 4\nset Inner radius = 1"), c, 4.);
  const auto slice = make_surface(
      "disc", at + "set Normal = 0, 0, 1\nset Radius = 4\nset Start = 0, 1, 0\nset Sector = 100");
  check_surface("sector of a disc", *slice, c, 4.);
  check_gap("sector of a disc, above it", *slice, c + Tensor<1, 3>({-2., 0.1, 0.7}), 0.7);
  check("sector of a disc: not beside it", !slice->project(c + Tensor<1, 3>({2., 0.1, 0.7})).exists);
  check_surface("sector of a ring",
                *make_surface("disc", at + "set Normal = 1, 2, 2\n"
                                           "set Radius = 4\nset Inner radius = 1\nset Sector = 290"),
                c, 4.);

  const auto sphere = make_surface("sphere", at + "set Radius = 2");
  check_surface("sphere", *sphere, c, 4.);
  check_surface("sphere from inside", *make_surface("sphere", at + inside + "set Radius = 2"), c, 4.);
  check_surface("zone of a sphere",
                *make_surface("sphere", at + about +
                                            "set Radius = 2\nset From latitude = -30\nset To latitude = "
                                            "45\nset Start = 1, 0, 0\nset Sector = 200"),
                c, 3.);
  check_surface("cap", *make_surface("sphere", at + about + "set Radius = 2\nset To latitude = -20"), c, 3.);
  check_curvatures("sphere: curvature 1/R", *sphere, {}, {0.5, 0.5});
  check_gap("centre of a sphere", *sphere, c, -2.);
  check_turning("centre of a sphere", *sphere, c);

  const auto cylinder = make_surface("cylinder", "set Point = 1, -2, 0.5\n" + about + "set Radius = 2");
  check_surface("cylinder", *cylinder, c, 4.);
  check_surface(
      "piece of a cylinder from inside",
      *make_surface("cylinder",
                    inside + "set Point = 1, -2, 0.5\nset Radius = 2\nset Length = 5\nset Sector = 120"),
      c, 4.);
  check_curvatures("cylinder: curvatures 0, 1/R", *cylinder, {}, {0., 0.5});
  check_gap("axis of a cylinder", *cylinder, c, -2.);
  check_turning("axis of a cylinder", *cylinder, c);

  const auto cone =
      make_surface("cone", "set Apex = 1, -2, 0.5\n" + about + "set Half angle = 30\nset To height = 6");
  check_surface("cone", *cone, c, 6.);
  check_surface("part of a cone from inside",
                *make_surface("cone", inside + "set Apex = 1, -2, 0.5\nset Half angle = 60\nset From height "
                                               "= 1\nset To height = 3\nset Sector = 300"),
                c, 5.);
  const Tensor<1, 3> axis({1. / 3., 2. / 3., 2. / 3.});
  check_gap("behind the apex of a cone", *cone, c - 2. * axis, 2.);
  check_gap("axis of a cone", *cone, c + 3. * axis, -1.5);
  const auto tip = make_surface("cone", "set Half angle = 30\nset To height = 6");
  check("on the axis in its tip it pushes along that",
        (tip->project(Tensor<1, 3>({0., 0., 3.})).normal + Tensor<1, 3>({0., 0., 1.})).norm(), 1e-15);
  check("beside it, to the side",
        tip->project(Tensor<1, 3>({-1e-6, 0., 3.})).normal * Tensor<1, 3>({-1., 0., 0.}) > 0.8);

  const auto torus = make_surface("torus", at + about + "set Ring radius = 3\nset Tube radius = 1");
  check_surface("torus", *torus, c, 5.);
  check_surface("torus from inside",
                *make_surface("torus", at + inside + "set Ring radius = 3\nset Tube radius = 1"), c, 4.);
  check_surface("quarter fillet",
                *make_surface("torus", at + "set Ring radius = 3\nset Tube radius = 1\nset From angle = "
                                            "90\nset To angle = 180\nset Sector = 90"),
                c, 4.);
  check_gap("centre of a torus", *torus, c, 2.);
  check_gap("axis of a torus", *torus, c + 4. * axis, 4.);
  const auto upright = make_surface("torus", "set Ring radius = 3\nset Tube radius = 1");
  check_gap("in the middle of the tube", *upright, Tensor<1, 3>({3., 0., 0.}), -1.);
  Tensor<2, 3> around; // the ring, seen from outside or inside
  around[1][1] = upright->project(Tensor<1, 3>({3., 0., 0.})).normal[0] / 3.;
  check_turning("in the middle of the tube", *upright, Tensor<1, 3>({3., 0., 0.}), around);
  check_curvatures("torus, outer equator", *upright, Tensor<1, 3>({5., 0., 0.}), {0.25, 1.});
  check_curvatures("torus, inner equator", *upright, Tensor<1, 3>({1., 0., 0.}), {-0.5, 1.});
  check_curvatures("torus, top", *upright, Tensor<1, 3>({3., 0., 2.}), {0., 1.});

  // A die: wall, fillet, flange. The fillet's curvatures are a torus's.
  const auto die = make_surface("revolved profile", "set Corners = 5, -4 ; 5, 0 : 2 ; 12, 0");
  check_surface("revolved profile with a fillet", *die, origin, 12.);
  check_curvatures("fillet of a revolved profile", *die, Tensor<1, 3>({7. - 2., 0., 0.}),
                   {-(std::sqrt(0.5)) / (7. - std::sqrt(2.)), 0.5});
  check_surface("revolved profile, closed on the axis",
                *make_surface("revolved profile",
                              "set Outside = right\nset Corners = 0, -2 ; via 1.4142135623730951, "
                              "-1.4142135623730951 to 2, 0 ; 2, 3 : 0.5 ; 0, 3"),
                origin, 4.);
  check_surface("extruded profile",
                *make_surface("extruded profile",
                              "set Corners = -4, 2 ; -1, 2 : 0.7 ; -1, 0 : 0.5 ; 1, 0 ; via 2, 1 "
                              "to 3, 0 : 0.2 ; 5, 0\nset Axis = 0, 1, 0\nset Length = 6"),
                origin, 5.);

  const auto extruded_arc = make_surface(
      "extruded profile", "set Outside = right\nset Corners = -2, 0 ; via 0, -2 to 2, 0\nset Axis = 0, 0, 1");
  check_gap("axis of an extruded arc", *extruded_arc, Tensor<1, 3>({0., 0., 3.}), -2.);
  check_turning("axis of an extruded arc", *extruded_arc, Tensor<1, 3>({0., 0., 3.}));

  // A sector of the die, against the whole and against the torus that its fillet is.
  const auto part = make_surface(
      "revolved profile", "set Corners = 5, -4 ; 5, 0 : 2 ; 12, 0\nset Start = 0, 1, 0\nset Sector = 90");
  check_surface("sector of a revolved profile", *part, Tensor<1, 3>({-4., 4., 0.}), 8.);
  check("sector of a revolved profile: not beside it", !part->project(Tensor<1, 3>({6., 6., 1.})).exists);
  check("... but above it",
        std::abs(part->project(Tensor<1, 3>({-6., 6., 1.})).gap -
                 die->project(Tensor<1, 3>({-6., 6., 1.})).gap),
        1e-13);

  // The same surface, described in two ways.
  Random random;
  WorstError spheres, tori;
  const auto drawn =
      make_surface("revolved profile", "set Outside = right\nset Corners = 0, -2 ; via 2, 0 to 0, 2");
  const auto round = make_surface("sphere", "set Radius = 2");
  const auto fillet = make_surface("torus", "set Centre = 0, 0, -2\nset Ring radius = 7\nset Tube radius = "
                                            "2\nset From angle = 90\nset To angle = 180\n");
  for (unsigned int i = 0; i < 1000; ++i) {
    const Tensor<1, 3> x = random.vector(8.);
    spheres.add(std::abs(drawn->project(x).gap - round->project(x).gap));
    const auto piece = fillet->project(x);
    if (piece.exists)
      tori.add(std::abs(die->project(x).gap - piece.gap) * (die->project(x).normal - piece.normal).norm());
  }
  check("a half circle revolved is a sphere", spheres.value(), 1e-13);
  check("the die's fillet is a torus", tori.value(), 1e-12);

  // Sets: a wall and a floor that meet in a concave edge, in a convex edge, and not at all.
  const SurfacePart floor{"rectangle", "set Centre = 2, 0, 0\nset Length = 4\nset Width = 10"};
  const SurfacePart wall{
      "rectangle",
      "set Centre = 0, 0, 2\nset Normal = 1, 0, 0\nset Direction = 0, 0, 1\nset Length = 4\nset Width = 10"};
  const SurfacePart side{"rectangle", "set Centre = 0, 0, -2\nset Normal = -1, 0, 0\nset Direction "
                                      "= 0, 0, 1\nset Length = 4\nset Width = 10"};
  const auto corner = make_surface({floor, wall}), ridge = make_surface({floor, side}),
             alone = make_surface({floor});
  check_surface("corner of floor and wall", *corner, origin, 4.);
  check_surface("ridge of floor and side", *ridge, origin, 4.);
  // Edges that are round: of a disc and a cylinder or cone.
  check_surface("puck",
                *make_surface({{"disc", "set Centre = 0, 0, 1\nset Radius = 2"},
                               {"cylinder", "set Radius = 2\nset Length = 2"}}),
                origin, 3.);
  check_surface("funnel",
                *make_surface({{"disc", "set Centre = 0, 0, 1\nset Radius = 4\nset Inner radius = 2"},
                               {"cone", "set Side = inside\nset Apex = 0, 0, -1\nset From height = 1\nset "
                                        "To height = 2"}}),
                origin, 3.);
  check_gap("in the corner, nearer to the floor", *corner, Tensor<1, 3>({0.3, 0., 0.2}), 0.2);
  check_gap("behind the corner", *corner, Tensor<1, 3>({-0.3, 0., -0.4}), -0.5);
  check_gap("before the ridge", *ridge, Tensor<1, 3>({-0.3, 0., 0.4}), 0.5);
  check_gap("inside the ridge", *ridge, Tensor<1, 3>({0.3, 0., -0.2}), -0.2);
  check("beyond the border: no surface", !alone->project(Tensor<1, 3>({-0.3, 0., -0.4})).exists);
  check("... but a distance", std::abs(alone->project(Tensor<1, 3>({-0.3, 0., -0.4})).gap - 0.5), 1e-14);
}

} // namespace surfaces_test
