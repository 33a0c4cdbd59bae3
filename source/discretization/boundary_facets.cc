// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/discretization/boundary_facets.h"

#include "billet/discretization/node_keys.h"

#include <algorithm>
#include <cmath>

namespace billet {

namespace {

template <class IsWanted>
std::vector<BoundaryFacet> collect(const Discretization &discretization, const std::size_t body,
                                   const IsWanted &is_wanted) {
  std::vector<BoundaryFacet> facets;
  for (const auto &element : discretization.elements(body))
    for (const unsigned int f : element.cell->face_indices()) {
      const auto face = element.cell->face(f);
      if (!face->at_boundary() || !is_wanted(face->boundary_id()))
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
      facet.key = dealii::GeometryInfo<3>::faces_per_cell * element_key(element.cell) + f;
      facets.push_back(facet);
    }
  return facets;
}

} // namespace

std::array<double, 4> BoundaryFacet::corner_areas() const {
  std::array<double, 4> areas{};
  for (const auto &point : facet_points()) {
    const auto area =
        point.area_vector([&](const unsigned int a) { return dealii::Tensor<1, 3>(corners[a]); });
    for (unsigned int a = 0; a < 4; ++a)
      areas[a] += point.N[a] * area.norm();
  }
  return areas;
}

std::vector<BoundaryFacet> collect_boundary_facets(const Discretization &discretization,
                                                   const std::size_t body,
                                                   const std::vector<unsigned int> &boundary_ids) {
  return collect(discretization, body, [&](const unsigned int id) {
    return std::find(boundary_ids.begin(), boundary_ids.end(), id) != boundary_ids.end();
  });
}

std::vector<BoundaryFacet> collect_boundary_facets(const Discretization &discretization,
                                                   const std::size_t body) {
  return collect(discretization, body, [](const unsigned int /*id*/) { return true; });
}

std::map<DofIndex, FacetSize> compute_facet_sizes(const Discretization &discretization,
                                                  const std::vector<BoundaryFacet> &facets) {
  Vector sums = discretization.make_additive_vector(); // area, number and volume
  for (const auto &facet : facets) {
    const double area = facet.area_vector().norm();
    const std::array<double, 3> values{area, 1., area * facet.thickness};
    for (const auto &dofs : facet.dofs)
      sums.add(3, dofs.data(), values.data());
  }
  sums.compress(dealii::VectorOperation::add);
  Vector ghosted = discretization.make_ghosted_vector();
  ghosted = sums;
  std::map<DofIndex, FacetSize> sizes;
  for (const auto &facet : facets)
    for (const auto &dofs : facet.dofs) {
      const double area = ghosted(dofs[0]);
      sizes[dofs[0]] = {std::sqrt(area / ghosted(dofs[1])), ghosted(dofs[2]) / area};
    }
  return sizes;
}

} // namespace billet
