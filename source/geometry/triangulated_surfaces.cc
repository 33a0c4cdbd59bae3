// SPDX-License-Identifier: LGPL-2.1-or-later
// Surfaces from files of triangles.
#include "billet/geometry/curved_triangles.h"
#include "billet/geometry/surface_type.h"

#include <cmath>
#include <stdexcept>

namespace billet {

namespace {

using Kind = TypeParameter::Kind;

/// Tolerance for merging points that rounding to single precision, or to six digits, has separated;
/// relative to the size of the surface.
constexpr double weld_tolerance = 1e-6;

TriangleMesh read_welded(const TypeInput &input) {
  TriangleMesh mesh;
  try {
    mesh = read_stl(input.file("File"));
  } catch (const std::invalid_argument &error) {
    input.reject("File", std::string("an STL file; ") + error.what());
  }
  const double size = mesh.size();
  if (size > 0.)
    mesh = weld(mesh, weld_tolerance * size);
  if (size == 0. || !mesh.has_area())
    input.reject("File", "an STL file with facets that have an area");
  return mesh;
}

TriangleEdges connect(const TypeInput &input, const TriangleMesh &mesh) {
  try {
    return TriangleEdges(mesh);
  } catch (const std::invalid_argument &error) {
    input.reject("File", std::string("a surface with facets of one orientation; ") + error.what());
    throw;
  }
}

SurfacePatches make(const TypeInput &input) {
  const double scale = input.positive("Scale");
  const auto translation = input.vector("Translation");
  const double sharp_angle = input.number("Feature angle");
  const bool is_smoothed = input.flag("Smoothing");
  if (!(sharp_angle >= 0. && sharp_angle <= 90.))
    input.reject("Feature angle", "a number from 0 to 90");
  if (!is_smoothed && input.is_set("Feature angle"))
    input.reject("Feature angle", "no value: without 'Smoothing' every edge remains as it is");

  TriangleMesh mesh = read_welded(input);
  const double sign = side_sign(input);
  if (sign < 0.)
    for (auto &facet : mesh.facets)
      std::swap(facet[1], facet[2]);
  const TriangleEdges edges = connect(input, mesh);
  if (input.flag("Closed")) {
    const std::string open_edges = edges.describe_open_edges(mesh);
    if (!open_edges.empty())
      input.reject("File",
                   "a closed surface; " + open_edges + ". 'Closed = false' allows edges of the surface");
    if (sign * mesh.six_volumes() < 0.)
      input.reject("File", "a closed surface with normals that point outwards; these point inwards");
  }
  for (auto &point : mesh.points)
    point = scale * point + translation;
  return CurvedTriangles::patches(
      std::make_shared<const CurvedTriangles>(mesh, edges, sharp_angle * M_PI / 180., is_smoothed));
}

} // namespace

SurfaceType stl_type() {
  return {
      "STL",
      "Triangles of an STL file, ASCII or binary. Each triangle is curved to follow the normals of the "
      "original surface.",
      {{"File", "", Kind::text, "Name of the file, relative to the scene file."},
       {"Scale", "1", Kind::number, "> 0. Factor from the file's numbers to lengths of the scene."},
       {"Translation", "0, 0, 0", Kind::text, "Position of the file's origin. [length]"},
       {"Side", "outside", Kind::choice,
        "outside|inside: Side of the bodies. The normals of the facets, by the order of their corners, point "
        "to the outside."},
       {"Closed", "true", Kind::flag,
        "Whether every edge must have two facets. Otherwise edges with one facet are edges of the tool."},
       {"Smoothing", "true", Kind::flag, "Whether triangles are curved. Otherwise they are flat."},
       {"Feature angle", "30", Kind::number,
        ">= 0 and <= 90. Edges at which the normals of the facets differ by more remain sharp. [degrees]"}},
      make};
}

} // namespace billet
