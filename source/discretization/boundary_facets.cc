// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/discretization/boundary_facets.h"

#include <algorithm>
#include <cmath>

namespace billet {

std::vector<BoundaryFacet> collect_boundary_facets(const Discretization &discretization,
                                                   const std::size_t body,
                                                   const std::vector<unsigned int> &boundary_ids) {
  std::vector<BoundaryFacet> facets;
  for (const auto &element : discretization.elements(body))
    for (const unsigned int f : element.cell->face_indices()) {
      const auto face = element.cell->face(f);
      if (!face->at_boundary() ||
          std::find(boundary_ids.begin(), boundary_ids.end(), face->boundary_id()) == boundary_ids.end())
        continue;
      BoundaryFacet facet;
      for (unsigned int v = 0; v < 4; ++v) {
        for (unsigned int i = 0; i < 3; ++i)
          facet.dofs[v][i] = face->vertex_dof_index(v, i);
        facet.corners[v] = face->vertex(v);
      }
      if (facet.area_vector() * (face->center() - element.cell->center()) < 0.) {
        std::swap(facet.dofs[1], facet.dofs[2]);
        std::swap(facet.corners[1], facet.corners[2]);
      }
      facet.thickness = element.cell->measure() / facet.area_vector().norm();
      facets.push_back(facet);
    }
  return facets;
}

const std::array<FacetPoint, 4> &facet_points() {
  static const std::array<FacetPoint, 4> points = [] {
    std::array<FacetPoint, 4> result{};
    const auto sign = [](const unsigned int corner, const unsigned int axis) {
      return ((corner >> axis) & 1U) != 0U ? 1. : -1.;
    };
    const double g = 1. / std::sqrt(3.);
    for (unsigned int q = 0; q < 4; ++q)
      for (unsigned int a = 0; a < 4; ++a) {
        const double along_xi = 1. + sign(a, 0) * sign(q, 0) * g,
                     along_eta = 1. + sign(a, 1) * sign(q, 1) * g;
        result[q].N[a] = 0.25 * along_xi * along_eta;
        result[q].N_xi[a] = 0.25 * sign(a, 0) * along_eta;
        result[q].N_eta[a] = 0.25 * sign(a, 1) * along_xi;
      }
    return result;
  }();
  return points;
}

} // namespace billet
