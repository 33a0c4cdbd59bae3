// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/facet_tree.h"

#include <algorithm>

namespace billet {

using dealii::Tensor;

namespace {

std::vector<BoundingBox> triangle_boxes(const TriangleMesh &mesh) {
  std::vector<BoundingBox> boxes;
  boxes.reserve(mesh.facets.size());
  for (const auto &facet : mesh.facets) {
    boxes.push_back(BoundingBox::empty());
    for (const unsigned int corner : facet)
      boxes.back().add(mesh.points[corner]);
  }
  return boxes;
}

} // namespace

FacetTree::FacetTree(TriangleMesh mesh) : mesh_(std::move(mesh)), tree_(triangle_boxes(mesh_)) {}

FacetTree::Foot FacetTree::nearest_on(const unsigned int facet, const Tensor<1, 3> &x) const {
  std::array<Tensor<1, 3>, 3> corners;
  for (unsigned int i = 0; i < 3; ++i)
    corners[i] = mesh_.points[mesh_.facets[facet][i]];
  const Tensor<1, 3> a = corners[1] - corners[0], b = corners[2] - corners[0], arm = x - corners[0];
  const double aa = a * a, ab = a * b, bb = b * b, xa = arm * a, xb = arm * b, det = aa * bb - ab * ab;
  if (det > 0.) { // otherwise it is a line, as at the poles of surfaces
    const double u = (bb * xa - ab * xb) / det, v = (aa * xb - ab * xa) / det;
    if (u >= 0. && v >= 0. && u + v <= 1.)
      return {facet, {1. - u - v, u, v}, (arm - u * a - v * b).norm_square()};
  }
  Foot best;
  for (unsigned int i = 0; i < 3; ++i) {
    const unsigned int j = (i + 1) % 3;
    const Tensor<1, 3> side = corners[j] - corners[i];
    const double length = side.norm_square();
    const double part = length > 0. ? std::clamp((x - corners[i]) * side / length, 0., 1.) : 0.;
    const double square = (x - corners[i] - part * side).norm_square();
    if (square < best.square) {
      best = {facet, {}, square};
      best.weights[i] = 1. - part;
      best.weights[j] = part;
    }
  }
  return best;
}

FacetTree::Foot FacetTree::nearest(const Tensor<1, 3> &x) const {
  Foot best;
  visit_near(x, best.square, [&](const Foot &foot) {
    if (foot.square < best.square)
      best = foot;
  });
  return best;
}

} // namespace billet
