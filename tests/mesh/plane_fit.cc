// SPDX-License-Identifier: LGPL-2.1-or-later
// A sector of a ring whose nodes have few digits: its sides are moved onto their symmetry planes; sides that
// are beside a plane in part, or that no plane means, are not.

#include "../testing.h"

#include "billet/errors.h"
#include "billet/scene/plane_fit.h"

#include <deal.II/grid/grid_generator.h>

#include <cmath>

namespace plane_fit_test {

using namespace billet;
using billet::testing::check;
using dealii::Point;
using dealii::Triangulation;

namespace {

constexpr double angle = dealii::numbers::PI / 6.;

/// Calls f(vertex) once for each vertex.
template <class F> void for_each_vertex(Triangulation<3> &mesh, const F &f) {
  std::vector<bool> is_done(mesh.n_vertices(), false);
  for (const auto &cell : mesh.active_cell_iterators())
    for (const unsigned int v : cell->vertex_indices())
      if (!is_done[cell->vertex_index(v)]) {
        is_done[cell->vertex_index(v)] = true;
        f(cell->vertex(v));
      }
}

/// Sector of 30 degrees between the radii 5 and 10; positions are rounded to so many digits after the point.
void make_sector(Triangulation<3> &mesh, const int digits) {
  dealii::GridGenerator::subdivided_hyper_rectangle(mesh, {8U, 4U, 2U}, Point<3>(5., 0., 0.),
                                                    Point<3>(10., 1., 1.));
  const double unit = std::pow(10., digits);
  for_each_vertex(mesh, [&](Point<3> &x) {
    const double r = x[0], phi = angle * x[1];
    x[0] = std::round(unit * r * std::cos(phi)) / unit;
    x[1] = std::round(unit * r * std::sin(phi)) / unit;
  });
}

parameters::Body make_body() {
  parameters::Body body;
  body.symmetry_planes.origin = "scene.prm:3: 'Symmetry planes'";
  const auto add = [&](const dealii::Tensor<1, 3> &normal, const std::string &text) {
    parameters::SymmetryPlane plane;
    plane.normal = normal / normal.norm();
    plane.offset = 0.;
    plane.text = text;
    body.symmetry_planes.value.push_back(plane);
  };
  add(dealii::Tensor<1, 3>({0., 1., 0.}), "y = 0");
  add(dealii::Tensor<1, 3>({-std::sin(angle), std::cos(angle), 0.}), "side");
  add(dealii::Tensor<1, 3>({0., 0., 1.}), "z = 0");
  return body;
}

/// Largest distance of boundary faces from the second plane, of those whose centre is at most 0.02 off it.
double distance_of_side(const Triangulation<3> &mesh, const parameters::Body &body) {
  const auto &plane = body.symmetry_planes.value[1];
  double largest = 0.;
  for (const auto &face : mesh.active_face_iterators())
    if (face->at_boundary() && std::abs(face->center() * plane.normal) < 0.02)
      for (const unsigned int v : face->vertex_indices())
        largest = std::max(largest, std::abs(face->vertex(v) * plane.normal));
  return largest;
}

std::string refusal(const parameters::Body &body, Triangulation<3> &mesh) {
  try {
    fit_to_planes(body, mesh);
  } catch (const InputError &error) {
    return error.what();
  }
  return "";
}

} // namespace

BILLET_TEST(plane_fit) {
  const parameters::Body body = make_body();
  for (const int digits : {3, 4, 7, 8}) {
    Triangulation<3> mesh;
    make_sector(mesh, digits);
    const std::string name = std::to_string(digits) + " digits";
    check(name + ", the side is off its plane", distance_of_side(mesh, body) > 1e-10);
    fit_to_planes(body, mesh);
    check(name + ", and on it afterwards", distance_of_side(mesh, body), 1e-9);
  }
  Triangulation<3> exact, fitted;
  make_sector(exact, 15);
  make_sector(fitted, 15);
  fit_to_planes(body, fitted);
  bool is_same = true;
  for (std::size_t v = 0; v < exact.n_vertices(); ++v)
    is_same = is_same && exact.get_vertices()[v] == fitted.get_vertices()[v];
  check("a mesh with all digits keeps its bits", is_same);
  Triangulation<3> curved, rough;
  make_sector(rough, 15);
  bool is_moved = false;
  for_each_vertex(rough, [&](Point<3> &x) {
    if (!is_moved && std::abs(x * body.symmetry_planes.value[1].normal) < 1e-9 && x.norm() > 9.) {
      x += 5e-3 * body.symmetry_planes.value[1].normal; // 4e-3 of the element's depth
      is_moved = true;
    }
  });
  const std::string message = refusal(body, rough);
  check("a face beside the plane is refused",
        message.find("'side'") != std::string::npos && message.find("more digits") != std::string::npos);
  make_sector(curved, 15);
  for_each_vertex(curved, [&](Point<3> &x) { x[1] += 0.05 * x[2]; }); // leaves both sides
  const std::string none = refusal(body, curved);
  check("a side that is off by much is none", none.empty() && distance_of_side(curved, body) > 1e-3);
}

} // namespace plane_fit_test
