// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/facet_point.h"
#include "billet/loads/node_site.h"

#include <deal.II/base/symmetric_tensor.h>

#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {

/// Returns the rotation that fits K = ∫ r ⊗ (X − C) dA best, (F2). A plane surface has no third
/// axis of its own: that of the first two is taken.
Tensor<2, 3> fit_rotation(const Tensor<2, 3> &K) {
  const auto squares = dealii::symmetrize(transpose(K) * K);
  const auto axes = dealii::eigenvectors(squares); // the largest first
  std::array<Tensor<1, 3>, 3> from, to;
  for (unsigned int i = 0; i < 2; ++i) {
    from[i] = axes[i].second;
    to[i] = K * from[i];
    if (i == 1)
      to[1] -= (to[1] * to[0]) * to[0];
    to[i] /= to[i].norm();
  }
  from[2] = dealii::cross_product_3d(from[0], from[1]);
  to[2] = dealii::cross_product_3d(to[0], to[1]);
  Tensor<2, 3> rotation;
  for (unsigned int i = 0; i < 3; ++i)
    rotation += outer_product(to[i], from[i]);
  return rotation;
}

/// Sets what follows from ∫ r ⊗ r dA and K, nine numbers each.
void set_motion(const std::vector<double> &products, SurfaceMotion &motion) {
  Tensor<2, 3> squares, K;
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j) {
      squares[i][j] = products[3 * i + j];
      K[i][j] = products[9 + 3 * i + j];
    }
  const Tensor<2, 3> unit = dealii::unit_symmetric_tensor<3>();
  if (!std::isfinite(squares.norm()) || !std::isfinite(K.norm())) { // what moves there will be told
    motion.second_moment = motion.rotation = motion.turning = unit;
    return;
  }
  motion.second_moment = trace(squares) * unit - squares;
  motion.rotation = fit_rotation(K);
  const Tensor<2, 3> P = K * transpose(motion.rotation);
  motion.turning = trace(P) * unit - P;
}

/// Returns the shares of a face in its corners, or that of a selected node, about this centroid.
std::array<SurfaceNode, 4> find_shares(const LoadedFace &face, const NodalMotion &motion,
                                       const Tensor<1, 3> &centre) {
  const std::array<Tensor<1, 3>, 4> positions = face.positions(motion);
  const auto corner = [&](const unsigned int a) { return get_vector(motion.positions, face.nodes[a]); };
  std::array<SurfaceNode, 4> shares;
  if (is_node_site(face)) {
    const double part = face.areas[0];
    shares[0] = {part, part * (positions[0] - centre), part * (corner(0) - face.surface->centre)};
    return shares;
  }
  for (const auto &point : facet_points()) {
    Tensor<1, 3> arm = -centre, undeformed_arm = -face.surface->centre;
    for (unsigned int a = 0; a < 4; ++a) {
      arm += point.N[a] * positions[a];
      undeformed_arm += point.N[a] * corner(a);
    }
    const double area = point.area_vector(corner).norm();
    for (unsigned int a = 0; a < 4; ++a) {
      shares[a].area += point.N[a] * area;
      shares[a].arm += point.N[a] * area * arm;
      shares[a].undeformed_arm += point.N[a] * area * undeformed_arm;
    }
  }
  return shares;
}

} // namespace

void measure_motion(const std::vector<LoadedFace> &faces, const NodalMotion &at, LoadedSurface &surface,
                    const std::function<void(std::vector<double> &)> &sum) {
  // Two sums, so that a surface far from where it began keeps its digits.
  std::vector<double> first(3, 0.); // ∫ x − C dA
  for (const LoadedFace &face : faces)
    for (const SurfaceNode &share : find_shares(face, at, surface.centre))
      for (unsigned int i = 0; i < 3; ++i)
        first[i] += share.arm[i];
  sum(first);
  surface.motion.centre = surface.centre + Tensor<1, 3>({first[0], first[1], first[2]}) / surface.area;
  std::vector<double> products(18, 0.); // ∫ r ⊗ r dA, ∫ r ⊗ (X − C) dA: Σ r_a ⊗ p_a, Σ r_a ⊗ q_a
  surface.shares.clear();
  for (const LoadedFace &face : faces) {
    const auto &shares = surface.shares.emplace_back(find_shares(face, at, surface.motion.centre));
    const auto positions = face.positions(at);
    for (unsigned int a = 0; a < 4; ++a) {
      const Tensor<1, 3> r = positions[a] - surface.motion.centre;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j) {
          products[3 * i + j] += r[i] * shares[a].arm[j];
          products[9 + 3 * i + j] += r[i] * shares[a].undeformed_arm[j];
        }
    }
  }
  sum(products);
  set_motion(products, surface.motion);
}

} // namespace billet
