// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/discretization/contact_neighbours.h"

#include "billet/geometry/box_tree.h"

#include <algorithm>

namespace billet {

using dealii::Tensor;

namespace {

/// Boundary faces on one side of a pair.
struct Side {
  std::vector<unsigned int> cells; ///< active index
  std::vector<Tensor<1, 3>> middles;
  std::vector<double> sizes;
};

Side collect_side(const dealii::Triangulation<3> &mesh, const std::size_t body,
                  const std::vector<unsigned int> &boundary_ids) {
  Side side;
  for (const auto &cell : mesh.active_cell_iterators()) {
    if (cell->material_id() != body)
      continue;
    for (const unsigned int f : cell->face_indices())
      if (cell->face(f)->at_boundary() &&
          std::count(boundary_ids.begin(), boundary_ids.end(), cell->face(f)->boundary_id()) > 0) {
        side.cells.push_back(cell->active_cell_index());
        side.middles.push_back(cell->face(f)->center());
        side.sizes.push_back(std::sqrt(cell->face(f)->measure()));
      }
  }
  return side;
}

void add_nearest(const Side &from, const Side &to, dealii::DynamicSparsityPattern &pattern) {
  std::vector<BoundingBox> points(to.cells.size(), BoundingBox::empty());
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i].add(to.middles[i]);
  const BoxTree tree(points);
  for (std::size_t i = 0; i < from.cells.size(); ++i) {
    // Maximum distance: the diagonals of both faces.
    double square = 2. * from.sizes[i] * from.sizes[i];
    unsigned int nearest = dealii::numbers::invalid_unsigned_int;
    tree.visit_near(from.middles[i], square, [&](const unsigned int other) {
      const double distance = (to.middles[other] - from.middles[i]).norm_square();
      if (distance <= square && to.cells[other] != from.cells[i]) {
        square = distance;
        nearest = other;
      }
    });
    if (nearest != dealii::numbers::invalid_unsigned_int) {
      pattern.add(from.cells[i], to.cells[nearest]);
      pattern.add(to.cells[nearest], from.cells[i]);
    }
  }
}

} // namespace

void add_contact_neighbours(const Scene &scene, const dealii::Triangulation<3> &mesh,
                            dealii::DynamicSparsityPattern &pattern) {
  for (const auto &pair : scene.body_pairs()) {
    if (pair.is_self_contact) // its faces are already neighbours, or far apart
      continue;
    const Side first = collect_side(mesh, pair.bodies[0], pair.boundary_ids[0]),
               second = collect_side(mesh, pair.bodies[1], pair.boundary_ids[1]);
    add_nearest(first, second, pattern);
    add_nearest(second, first, pattern);
  }
}

} // namespace billet
