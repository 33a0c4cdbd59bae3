// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/self_crossing.h"

#include "billet/geometry/box_tree.h"

#include <algorithm>
#include <cmath>

namespace billet {

using Vertex = dealii::Tensor<1, 3>;

namespace {

using Corners = std::array<Vertex, 3>;

constexpr double on_it = 1e-9; // tolerance, relative to the triangle's size

struct FacetTriangle {
  Corners corners;
  Vertex normal; ///< unit vector
  double size, area;
};

FacetTriangle make_triangle(const Corners &x) {
  const Vertex normal = dealii::cross_product_3d(x[1] - x[0], x[2] - x[0]);
  const double twice = normal.norm();
  return {x, twice > 0. ? normal / twice : Vertex(), std::max((x[1] - x[0]).norm(), (x[2] - x[0]).norm()),
          0.5 * twice};
}

/// Whether a point of the triangle's plane is inside it, within round-off.
bool contains(const FacetTriangle &triangle, const Vertex &x, const double slack) {
  for (unsigned int i = 0; i < 3; ++i) {
    const Vertex &a = triangle.corners[i], &b = triangle.corners[(i + 1) % 3];
    if (dealii::cross_product_3d(b - a, x - a) * triangle.normal < -slack * triangle.size * triangle.size)
      return false;
  }
  return true;
}

/// Whether an edge of the first pierces the second.
bool pierces(const FacetTriangle &first, const FacetTriangle &second) {
  const double nothing = on_it * second.size;
  for (unsigned int i = 0; i < 3; ++i) {
    const Vertex &a = first.corners[i], &b = first.corners[(i + 1) % 3];
    const double above = (a - second.corners[0]) * second.normal,
                 below = (b - second.corners[0]) * second.normal;
    if (std::min(std::abs(above), std::abs(below)) <= nothing || above * below > 0.)
      continue;
    if (contains(second, a + above / (above - below) * (b - a), on_it))
      return true;
  }
  return false;
}

/// Whether the two lie in one plane and share more than an edge. For generic triangles, a corner of
/// one is then inside the other, or edges cross.
bool overlap_in_plane(const FacetTriangle &first, const FacetTriangle &second) {
  for (const auto &corner : first.corners)
    if (std::abs((corner - second.corners[0]) * second.normal) > on_it * second.size)
      return false;
  for (const auto &[one, other] :
       {std::pair<const FacetTriangle &, const FacetTriangle &>(first, second), {second, first}})
    for (const auto &corner : one.corners)
      if (contains(other, corner, -on_it))
        return true;
  const auto side = [&](const Vertex &a, const Vertex &b, const Vertex &x) {
    const double area = dealii::cross_product_3d(b - a, x - a) * second.normal;
    return std::abs(area) <= on_it * second.size * second.size ? 0. : area;
  };
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j) {
      const Vertex &a = first.corners[i], &b = first.corners[(i + 1) % 3];
      const Vertex &c = second.corners[j], &d = second.corners[(j + 1) % 3];
      if (side(a, b, c) * side(a, b, d) < 0. && side(c, d, a) * side(c, d, b) < 0.)
        return true;
    }
  return false;
}

} // namespace

std::optional<Vertex> find_self_crossing(const std::vector<Vertex> &points,
                                         const std::vector<std::array<unsigned int, 3>> &triangles) {
  std::vector<FacetTriangle> made;
  std::vector<BoundingBox> boxes;
  for (const auto &corners : triangles) {
    made.push_back(make_triangle({points[corners[0]], points[corners[1]], points[corners[2]]}));
    boxes.push_back(BoundingBox::empty());
    for (const auto &corner : made.back().corners)
      boxes.back().add(corner);
  }
  const BoxTree tree(boxes);
  std::optional<Vertex> found;
  for (unsigned int i = 0; i < made.size() && !found; ++i) {
    const Vertex middle = 0.5 * (boxes[i].low + boxes[i].high);
    const double reach_square = 0.25 * (boxes[i].high - boxes[i].low).norm_square();
    tree.visit_near(middle, reach_square, [&](const unsigned int j) {
      const auto &first = triangles[i], &second = triangles[j];
      if (found ||
          std::find_first_of(first.begin(), first.end(), second.begin(), second.end()) != first.end() ||
          !boxes[i].overlaps(boxes[j]) || made[i].area == 0. || made[j].area == 0.)
        return;
      if (pierces(made[i], made[j]) || (j > i && overlap_in_plane(made[i], made[j])))
        found = middle;
    });
  }
  return found;
}

} // namespace billet
