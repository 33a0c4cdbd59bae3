// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/facet_point.h"

#include "billet/geometry/facet_projection.h"

#include <cmath>

namespace billet {

const std::array<FacetPoint, 4> &facet_points() {
  static const std::array<FacetPoint, 4> points = [] {
    std::array<FacetPoint, 4> result{};
    const double g = 1. / std::sqrt(3.);
    for (unsigned int q = 0; q < 4; ++q) {
      const auto &[xi, eta] = facet::signs[q];
      result[q].N = facet::weights({g * xi, g * eta});
      for (unsigned int a = 0; a < 4; ++a) {
        const auto &[xi_a, eta_a] = facet::signs[a];
        result[q].N_xi[a] = 0.25 * xi_a * (1. + eta_a * g * eta);
        result[q].N_eta[a] = 0.25 * eta_a * (1. + xi_a * g * xi);
      }
    }
    return result;
  }();
  return points;
}

} // namespace billet
