// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/mesh_sizes.h"

#include "billet/scene/mesh_builder.h"

#include <algorithm>
#include <cmath>

namespace billet {

MeshSizes MeshSizes::of(const parameters::Body &body) {
  dealii::Triangulation<3> mesh;
  build_body_mesh(body, MeshDetail::full, mesh);
  MeshSizes sizes;
  for (const auto &cell : mesh.active_cell_iterators()) {
    sizes.volume += cell->measure();
    for (const auto &face : cell->face_iterators())
      if (face->at_boundary())
        sizes.areas[face->boundary_id()] += face->measure();
  }
  return sizes;
}

bool approach(const MeshSizes &before, const MeshSizes &now, const MeshSizes &given) {
  constexpr double rounding = 1e-9;
  const auto is_nearer = [](const double a, const double b, const double c) {
    return std::abs(c - b) <= std::abs(b - a) + rounding * c;
  };
  const auto area = [](const MeshSizes &sizes, const unsigned int id) {
    const auto found = sizes.areas.find(id);
    return found == sizes.areas.end() ? 0. : found->second;
  };
  return is_nearer(before.volume, now.volume, given.volume) &&
         std::all_of(given.areas.begin(), given.areas.end(), [&](const auto &of_given) {
           return is_nearer(area(before, of_given.first), area(now, of_given.first), of_given.second);
         });
}

} // namespace billet
