// SPDX-License-Identifier: LGPL-2.1-or-later
// Surfaces from STL files: closest points of curved triangles against brute force, closed and open surfaces,
// sharp edges, flat faces beside fillets, and the order at which error of gap and normal falls with the mesh.
#include "check_surface.h"
#include "stl_meshes.h"

#include "billet/geometry/curved_triangles.h"

namespace triangulated_test {

using namespace billet;
using namespace billet::testing;
using dealii::Tensor;

namespace {

SharedSurface read(const TriangleMesh &mesh, const std::string &lines = "") {
  write_ascii(mesh, "surface.stl");
  return make_surface("STL", "set File = surface.stl\n" + lines);
}

/// Distance of x from a flat triangle: from its inside, or from its sides.
double distance_from_facet(const Tensor<1, 3> &x, const std::array<Tensor<1, 3>, 3> &p) {
  const Tensor<1, 3> normal = dealii::cross_product_3d(Tensor<1, 3>(p[1] - p[0]), Tensor<1, 3>(p[2] - p[0]));
  bool is_above = true;
  double distance = std::numeric_limits<double>::infinity();
  for (unsigned int i = 0; i < 3; ++i) {
    const Tensor<1, 3> side = p[(i + 1) % 3] - p[i], arm = x - p[i];
    is_above = is_above && dealii::cross_product_3d(normal, side) * arm >= 0.;
    const double part = std::clamp(arm * side / side.norm_square(), 0., 1.);
    distance = std::min(distance, (arm - part * side).norm());
  }
  return is_above ? std::abs((x - p[0]) * normal) / normal.norm() : distance;
}

/// No sample of a bent triangle is nearer than what it calls the closest point. Bends are up to `bend` times
/// a side, points up to `reach` away.
void check_closest_point(const std::string &name, const double bend, const double reach) {
  Random random;
  WorstError nearer, not_square, turning;
  for (unsigned int i = 0; i < 300; ++i) {
    std::array<Tensor<1, 3>, 3> corners, bends;
    for (auto &corner : corners)
      corner = random.vector(1.);
    for (auto &b : bends)
      b = random.vector(bend);
    const Tensor<1, 3> flat = dealii::cross_product_3d(Tensor<1, 3>(corners[1] - corners[0]),
                                                       Tensor<1, 3>(corners[2] - corners[0]));
    if (flat.norm() < 0.5)
      continue;
    std::array<CurvedTriangle::Seam, 3> seams{};
    for (auto &seam : seams)
      seam = {static_cast<float>(random(-bend, bend)), static_cast<float>(random(-bend, bend))};
    const CurvedTriangle triangle(corners, bends, seams);
    const auto shape = triangle.shape();
    for (unsigned int j = 0; j < 20; ++j) {
      const Tensor<1, 3> x = random.vector(reach);
      const auto closest = triangle.closest_point(x, shape);
      const double distance = (x - closest.position).norm();
      constexpr unsigned int n = 40;
      for (unsigned int a = 0; a <= n; ++a)
        for (unsigned int b = 0; a + b <= n; ++b)
          nearer.add((distance - (x - triangle.position(double(a) / n, double(b) / n)).norm()) / reach);
      if (!closest.is_beyond_edge)
        not_square.add(std::abs(std::abs(closest.gap) - distance) / reach);
      const bool is_refused = triangle.is_farther(x, distance * distance * (1. - 1e-9));
      const bool is_kept = !triangle.is_farther(x, distance * distance * (1. + 1e-9));
      turning.add(is_kept || is_refused ? 0. : 1.);
      turning.add(is_kept ? 0. : 1.);
    }
  }
  check(name + ": no sample is nearer", nearer.value(), 1e-12);
  check(name + ": straight above, the gap is the distance", not_square.value(), 1e-9);
  check(name + ": the quick test never leaves out what is near", turning.value(), 0.);
}

/// Largest errors of gap and normal of an approximation near a surface.
struct Errors {
  double gap, normal;
};
template <class Approximation>
Errors errors_near(const SharedSurface &exact, const Approximation &surface, const double size,
                   const double min_z) {
  Random random;
  WorstError gap, normal;
  for (unsigned int n = 0; n < 2000;) {
    Tensor<1, 3> x = random.vector(size);
    auto truth = exact->project(x);
    if (!truth.exists || std::abs(truth.gap) > 0.1 * size || x[2] < min_z)
      continue;
    x -= (truth.gap + random(-1e-3, 1e-3)) * truth.normal;
    truth = exact->project(x);
    const auto found = surface->project(x);
    gap.add(found.exists ? std::abs(found.gap - truth.gap) : 1.);
    normal.add((found.normal - truth.normal).norm());
    ++n;
  }
  return {gap.value(), normal.value()};
}

/// The errors fall at least at these orders from mesh to mesh, each with sides half as long, and are smaller
/// than those of the flat facets by the last factor.
template <class Mesh>
void check_order(const std::string &name, const SharedSurface &exact, const Mesh &mesh, const double size,
                 const std::string &lines, const double gap_order, const double normal_order,
                 const double min_gain, const double min_z = -1e9) {
  std::array<Errors, 3> errors{};
  for (unsigned int i = 0; i < 3; ++i)
    errors[i] = errors_near(exact, read(mesh(i), lines), size, min_z);
  const Errors flat = errors_near(
      exact, read(mesh(2), lines.substr(0, lines.find("set Feature angle")) + "set Smoothing = false\n"),
      size, min_z);
  double gap = 10., normal = 10.;
  for (unsigned int i = 0; i < 2; ++i) {
    gap = std::min(gap, std::log2(errors[i].gap / errors[i + 1].gap));
    normal = std::min(normal, std::log2(errors[i].normal / errors[i + 1].normal));
  }
  check(name + ": the gap's error falls with the mesh", std::max(0., gap_order - gap), 0.);
  check(name + ": the normal's error falls with the mesh", std::max(0., normal_order - normal), 0.);
  check(name + ": better than flat facets", errors[2].gap * min_gain / flat.gap, 1.);
}

void check_cube() {
  const auto cube = read(testing::cube());
  check_surface("cube", *cube, {}, 2.);
  check_surface("cube from inside", *read(testing::cube(), "set Side = inside"), {}, 1.5);
  Random random;
  WorstError outside, inside, moved;
  const auto elsewhere = read(testing::cube(), "set Scale = 2\nset Translation = 3, 0, -1\n");
  for (unsigned int i = 0; i < 1000; ++i) {
    const Tensor<1, 3> x = random.vector(3.);
    double square = 0., depth = 1.;
    for (unsigned int c = 0; c < 3; ++c) {
      square += std::pow(std::max(0., std::abs(x[c]) - 1.), 2);
      depth = std::min(depth, 1. - std::abs(x[c]));
    }
    if (square > 0.)
      outside.add(std::abs(cube->project(x).gap - std::sqrt(square)));
    else
      inside.add(std::abs(cube->project(x).gap + depth));
    moved.add(
        std::abs(elsewhere->project(2. * x + Tensor<1, 3>({3., 0., -1.})).gap - 2. * cube->project(x).gap));
  }
  check("a cube stays a cube, seen from outside", outside.value(), 1e-14);
  check("a cube stays a cube, seen from inside", inside.value(), 1e-14);
  check("scale and translation", moved.value(), 1e-14);
}

void check_files() {
  TriangleMesh mesh = torus(3., 1., 12);
  for (auto &point : mesh.points)
    for (unsigned int c = 0; c < 3; ++c)
      point[c] = std::round(1024. * point[c]) / 1024.; // single precision holds it
  write_ascii(mesh, "ascii.stl");
  write_binary(mesh, "binary.stl");
  const auto ascii = make_surface("STL", "set File = ascii.stl");
  const auto binary = make_surface("STL", "set File = binary.stl");
  Random random;
  WorstError difference;
  for (unsigned int i = 0; i < 500; ++i) {
    const auto x = random.vector(5.);
    const auto a = ascii->project(x), b = binary->project(x);
    difference.add(std::abs(a.gap - b.gap) + (a.normal - b.normal).norm() + (a.turning - b.turning).norm());
  }
  check("ASCII and binary files give the same", difference.value(), 0.);
}

void check_brute_force() {
  const TriangleMesh mesh = torus(3., 1., 12);
  const auto surface = read(mesh, "set Smoothing = false");
  Random random;
  WorstError error;
  for (unsigned int i = 0; i < 1000; ++i) {
    const auto x = random.vector(i % 2 == 0 ? 5. : 100.);
    double nearest = 1e9;
    for (const auto &[a, b, c] : mesh.facets)
      nearest = std::min(nearest, distance_from_facet(x, {mesh.points[a], mesh.points[b], mesh.points[c]}));
    error.add(std::abs(std::abs(surface->project(x).gap) - nearest));
  }
  check("flat facets against brute force", error.value(), 1e-12);
}

/// A torus of uneven triangles, some of them bent until they nearly fold: whatever the point, a closed
/// surface lies before it.
void check_closed(const double sharp_angle) {
  Random random;
  TriangleMesh mesh = torus(3., 1., 8);
  const std::vector<Tensor<1, 3>> points = mesh.points;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j)
      if ((points[j] - points[i]).norm() < 1e-9) { // the seams' points come twice
        mesh.points[i] = j < i ? mesh.points[j] : points[i] + random.vector(0.25);
        break;
      }
  const auto surface = read(mesh, "set Feature angle = " + std::to_string(sharp_angle));
  unsigned int n_missing = 0;
  for (unsigned int i = 0; i < 6000; ++i) {
    const double reach = i % 3 == 0 ? 5. : i % 3 == 1 ? 30. : 1000.;
    n_missing += surface->project(random.vector(reach)).exists ? 0 : 1;
  }
  check("a closed surface has no slits, sharp from " + std::to_string(static_cast<int>(sharp_angle)) +
            " degrees",
        n_missing == 0);
}

/// Largest difference between the normals of two triangles along their edge.
double max_kink(const TriangleMesh &mesh) {
  const TriangleEdges edges(mesh);
  const CurvedTriangles triangles(mesh, edges, 1., true);
  WorstError kink;
  for (const auto &edge : edges.edges)
    for (const double t : {0., 0.03, 0.2, 0.5, 0.8, 0.97, 1.}) {
      std::array<Tensor<1, 3>, 2> normals;
      for (unsigned int side = 0; side < 2; ++side) {
        std::array<double, 3> weights{};
        const double part = side == 0 ? t : 1. - t;
        weights[edge.corners[side]] = 1. - part;
        weights[(edge.corners[side] + 1) % 3] = part;
        normals[side] = triangles.triangle(edge.facets[side]).area_normal(weights[1], weights[2]);
        normals[side] /= normals[side].norm();
      }
      kink.add((normals[1] - normals[0]).norm());
    }
  return kink.value();
}

void check_kinks() {
  check("sphere of 320 triangles: one normal along edges", max_kink(icosphere(2)), 1e-8);
  const double coarse = max_kink(weld(torus(3., 1., 16), 1e-9)),
               fine = max_kink(weld(torus(3., 1., 32), 1e-9));
  check("torus of 1024 triangles: nearly one normal along edges", coarse, 2e-4);
  check("torus: of fifth order in their size", fine / coarse, 1. / 25.);
}

/// A can with caps, coarse: its rims are sharp and round, its caps flat.
void check_can() {
  const auto can = read(revolve({{0., -1.}, {2., -1.}, {2., 1.}, {0., 1.}}, 24));
  check_surface("can with sharp rims", *can, {}, 3.);
  Random random;
  WorstError cap, rim;
  for (unsigned int i = 0; i < 500; ++i) {
    const double angle = random(0., 2. * M_PI), radius = random(0., 1.99);
    const Tensor<1, 3> outwards({std::cos(angle), std::sin(angle), 0.});
    Tensor<1, 3> x = radius * outwards;
    x[2] = random(1., 2.);
    cap.add(std::abs(can->project(x).gap - (x[2] - 1.)));
    x = random(2.1, 3.) * outwards;
    x[2] = random(1.1, 2.);
    rim.add(std::abs(can->project(x).gap - std::hypot(outwards * x - 2., x[2] - 1.)));
  }
  check("caps stay flat", cap.value(), 1e-14);
  // The chord of a 24th part is off by 2 (1 − cos 7.5°) = 0.017.
  check("rims are round", rim.value(), 2e-4);
}

/// A square plate of which one side has a corner in its middle that the other lacks: a sliver without area
/// closes the slit.
void check_sliver() {
  TriangleMesh mesh;
  mesh.points = {Tensor<1, 3>({0., 0., 0.}), Tensor<1, 3>({1., 0., 0.}), Tensor<1, 3>({1., 1., 0.}),
                 Tensor<1, 3>({0., 1., 0.}), Tensor<1, 3>({0.5, 0.5, 0.})};
  mesh.facets = {{0, 1, 2}, {0, 2, 4}, {0, 4, 3}, {4, 2, 3}};
  const auto plate = read(mesh, "set Closed = false");
  WorstError error;
  Random random;
  for (unsigned int i = 0; i < 200; ++i) {
    const double along = i % 2 == 0 ? random(0.01, 0.99) : 0.5;
    const double across = i < 100 ? 0. : random(-1e-9, 1e-9);
    const auto p = plate->project(Tensor<1, 3>({along + across, along - across, -0.2}));
    error.add(p.exists ? std::abs(p.gap + 0.2) + std::abs(p.normal[2] - 1.) : 1.);
  }
  check("a sliver leaves no slit", error.value(), 1e-12);
}

} // namespace

BILLET_TEST(triangulated) {
  check_closest_point("slightly bent triangles", 0.1, 2.);
  check_closest_point("strongly bent triangles", 0.3, 3.);
  check_closest_point("bent triangles from afar", 0.2, 100.);
  check_closest_point("flat triangles", 0., 3.);
  check_files();
  check_brute_force();
  check_closed(20.);
  check_closed(80.);
  check_kinks();
  check_cube();
  check_can();
  check_sliver();

  const Tensor<1, 3> origin;
  check_surface("sphere of 80 triangles", *read(icosphere(1), "set Feature angle = 60"), origin, 2.);
  check_surface("sphere of 1280 triangles", *read(icosphere(3)), origin, 2.);
  check_surface("sphere of 320 triangles from inside", *read(icosphere(2), "set Side = inside"), origin, 0.9);
  check_surface("sphere of 320 flat triangles", *read(icosphere(2), "set Smoothing = false"), origin, 2.);
  check_surface("torus", *read(torus(3., 1., 16)), origin, 5.);

  const auto half = read(revolve({{1., 0.}, {2., 0.}, {2., 1.}}, 24, 0.5), "set Closed = false");
  check_surface("open surface", *half, origin, 3.);
  check("open surface: beyond the border there is none",
        !half->project(Tensor<1, 3>({0., -1.5, 0.1})).exists &&
            !half->project(Tensor<1, 3>({0., 0.9, -0.1})).exists &&
            half->project(Tensor<1, 3>({0., 1.5, 0.1})).exists);

  check_order(
      "sphere", make_surface("sphere", "set Radius = 1"),
      [](const unsigned int i) { return icosphere(i + 1); }, 1.2, "set Feature angle = 60\n", 3.5, 2.5, 500.);
  check_order(
      "torus", make_surface("torus", "set Ring radius = 3\nset Tube radius = 1"),
      [](const unsigned int i) { return torus(3., 1., 12U << i); }, 4., "set Feature angle = 60\n", 2.8, 1.8,
      30.);
  // A die: flange, fillet and wall.
  check_order(
      "die", make_surface("revolved profile", "set Corners = 5, -4 ; 5, 0 : 2 ; 12, 0"),
      [](const unsigned int i) {
        std::vector<std::array<double, 2>> polygon{{12., 0.}};
        const unsigned int n = 4U << i;
        for (unsigned int j = 0; j <= n; ++j) {
          const double angle = 0.5 * M_PI * (1. + double(j) / n);
          polygon.push_back({7. + 2. * std::cos(angle), -2. + 2. * std::sin(angle)});
        }
        polygon.push_back({5., -4.});
        return revolve(polygon, 32 * n);
      },
      8., "set Closed = false\n", 2., 1., 100., -3.9);
}

} // namespace triangulated_test
