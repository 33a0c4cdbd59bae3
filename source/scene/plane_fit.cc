// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/scene/plane_fit.h"

#include "billet/errors.h"

#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>

namespace billet {

using dealii::Triangulation;
using parameters::SymmetryPlane;

namespace {

struct Limits {
  // In depths of the element behind a face.
  static constexpr double on_plane = 1e-3, beside_plane = 1e-2;
  /// Size of round-off, over that of the body: vertices nearer than this stay where they are.
  static constexpr double rounding = 1e-10;
};

double distance(const SymmetryPlane &plane, const dealii::Point<3> &x) {
  return std::abs(x * plane.normal - plane.offset);
}

/// Boundary face, with its largest distance from a plane and the depth of its element.
struct NearFace {
  std::array<unsigned int, 4> vertices;
  dealii::Point<3> centre;
  double off, depth;
};

template <class Visit>
void for_each_face(const SymmetryPlane &plane, const Triangulation<3> &mesh, const Visit &visit) {
  for (const auto &cell : mesh.active_cell_iterators()) {
    double depth = 0.;
    for (const unsigned int v : cell->vertex_indices())
      depth = std::max(depth, distance(plane, cell->vertex(v)));
    for (const unsigned int f : cell->face_indices()) {
      const auto face = cell->face(f);
      if (!face->at_boundary())
        continue;
      NearFace found{{}, face->center(), 0., depth};
      for (const unsigned int v : face->vertex_indices()) {
        found.vertices[v] = face->vertex_index(v);
        found.off = std::max(found.off, distance(plane, face->vertex(v)));
      }
      visit(cell, found);
    }
  }
}

/// Returns the vertices of all faces that are nearly on the plane.
std::set<unsigned int> find_side(const SymmetryPlane &plane, const Triangulation<3> &mesh) {
  std::set<unsigned int> side;
  for_each_face(plane, mesh, [&](const auto & /*cell*/, const NearFace &face) {
    if (face.off <= Limits::on_plane * face.depth)
      side.insert(face.vertices.begin(), face.vertices.end());
  });
  return side;
}

void check_neighbours(const SymmetryPlane &plane, const std::string &origin, const Triangulation<3> &mesh,
                      const std::set<unsigned int> &side) {
  for_each_face(plane, mesh, [&](const auto & /*cell*/, const NearFace &face) {
    const auto n_shared = std::count_if(face.vertices.begin(), face.vertices.end(),
                                        [&](const unsigned int v) { return side.count(v) > 0; });
    if (n_shared < 2 || face.off <= Limits::on_plane * face.depth ||
        face.off > Limits::beside_plane * face.depth)
      return;
    std::ostringstream message;
    message << origin << " has '" << plane.text
            << "'; allowed are planes that hold a whole side, but its face at (" << face.centre << ") is "
            << face.off << " off it, beside faces that are on it. Write the plane "
            << "or the mesh with more digits";
    throw InputError(message.str());
  });
}

} // namespace

void fit_to_planes(const parameters::Body &body, Triangulation<3> &mesh) {
  const auto corners = dealii::GridTools::compute_bounding_box(mesh).get_boundary_points();
  const double round_off = Limits::rounding * corners.first.distance(corners.second);
  // Vertices of two sides: each plane moves them off the others by less and less.
  constexpr unsigned int n_rounds = 20;
  std::vector<std::set<unsigned int>> sides;
  for (const SymmetryPlane &plane : body.symmetry_planes.value) {
    sides.push_back(find_side(plane, mesh));
    check_neighbours(plane, body.symmetry_planes.origin, mesh, sides.back());
  }
  for (unsigned int round = 0; round < n_rounds; ++round) {
    bool have_moved = false;
    for (std::size_t p = 0; p < sides.size(); ++p) {
      const SymmetryPlane &plane = body.symmetry_planes.value[p];
      std::set<unsigned int> left = sides[p];
      for (const auto &cell : mesh.active_cell_iterators())
        for (const unsigned int v : cell->vertex_indices())
          if (left.erase(cell->vertex_index(v)) > 0 && distance(plane, cell->vertex(v)) > round_off) {
            cell->vertex(v) -= (cell->vertex(v) * plane.normal - plane.offset) * plane.normal;
            have_moved = true;
          }
    }
    if (!have_moved)
      return;
  }
}

std::string describe_nearest_face(const SymmetryPlane &plane, const Triangulation<3> &mesh,
                                  const unsigned int body) {
  NearFace nearest{{}, {}, std::numeric_limits<double>::infinity(), 0.};
  for_each_face(plane, mesh, [&](const auto &cell, const NearFace &face) {
    if (cell->material_id() == body && face.off < nearest.off)
      nearest = face;
  });
  std::ostringstream text;
  text << "the nearest one, at (" << nearest.centre << "), has vertices up to " << nearest.off << " off it";
  return text.str();
}

} // namespace billet
