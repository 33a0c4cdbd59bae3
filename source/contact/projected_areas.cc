// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/projected_areas.h"

#include "billet/discretization/boundary_facets.h"

namespace billet {

using dealii::Tensor;

ProjectedAreas compute_projected_areas(const CornerStates &states, const bool with_derivatives) {
  ProjectedAreas result{};
  for (const auto &point : facet_points()) {
    const auto &[N, N_xi, N_eta] = point;
    const auto [g_1, g_2] = point.tangents([&](const unsigned int a) { return states[a]->position; });
    const Tensor<1, 3> area_vector = dealii::cross_product_3d(g_1, g_2);
    for (unsigned int a = 0; a < 4; ++a) {
      const ToolContactState &node = *states[a];
      if (node.status == ContactStatus::open)
        continue;
      const double facing = -(area_vector * node.normal);
      if (facing <= 0.)
        continue;
      result.areas[a] += N[a] * facing;
      if (with_derivatives) {
        result.normal_derivatives[a] -= N[a] * area_vector;
        for (unsigned int b = 0; b < 4; ++b)
          result.derivatives[a][b] -= N[a] * (N_xi[b] * dealii::cross_product_3d(g_2, node.normal) +
                                              N_eta[b] * dealii::cross_product_3d(node.normal, g_1));
      }
    }
  }
  return result;
}

} // namespace billet
