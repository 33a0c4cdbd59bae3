// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/discretization/smooth_facets.h"

#include "billet/algebra/gather.h"
#include "billet/geometry/bilinear_facet.h"

#include <cmath>
#include <unordered_map>

namespace billet {

using dealii::Tensor;

double mean_distance(const FacetBulge &bulge) {
  double sum = 0.;
  for (const double height : bulge)
    sum += std::abs(height);
  return sum / 3.;
}

std::vector<SmoothFacet> make_smooth_facets(const Discretization &discretization,
                                            const std::vector<BoundaryFacet> &own_facets,
                                            const Vector *displacements) {
  std::vector<std::array<double, 16>> own;
  for (const auto &facet : own_facets) {
    std::array<double, 16> numbers{};
    for (unsigned int a = 0; a < 4; ++a) {
      for (unsigned int i = 0; i < 3; ++i)
        numbers[4 * a + i] =
            facet.corners[a][i] + (displacements != nullptr ? (*displacements)(facet.dofs[a][i]) : 0.);
      numbers[4 * a + 3] = static_cast<double>(facet.dofs[a][0]);
    }
    own.push_back(numbers);
  }
  const MPI_Comm communicator = discretization.communicator();
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(communicator);
  auto parts = all_gather(communicator, own);
  std::swap(parts[0], parts[rank]); // own ones first
  std::vector<SmoothFacet> facets;
  for (const auto &part : parts)
    for (const auto &numbers : part) {
      SmoothFacet facet{};
      for (std::size_t a = 0; a < 4; ++a) {
        facet.corners[a] = Tensor<1, 3>({numbers[4 * a], numbers[4 * a + 1], numbers[4 * a + 2]});
        facet.nodes[a] = static_cast<DofIndex>(numbers[4 * a + 3]);
      }
      const Tensor<1, 3> area = 4. * facet::Expansion(facet.corners).mean_area_vector();
      facet.size = std::sqrt(area.norm());
      if (facet.size > 0.)
        facet.normal = area / area.norm();
      facets.push_back(facet);
    }
  std::unordered_map<DofIndex, std::vector<Tensor<1, 3>>> normals_at;
  for (const auto &facet : facets)
    for (const DofIndex node : facet.nodes)
      normals_at[node].push_back(facet.normal);
  for (auto &facet : facets) {
    constexpr double cosine_of_edge = 0.64; // of 50 degrees: eight facets still form a circle
    FacetCorners normals;
    for (unsigned int a = 0; a < 4; ++a) {
      for (const auto &normal : normals_at[facet.nodes[a]])
        if (normal * facet.normal > cosine_of_edge)
          normals[a] += normal;
      if (normals[a].norm() > 0.)
        normals[a] /= normals[a].norm();
    }
    facet.bulge = facet::bulge_from_normals(facet.corners, normals);
    for (unsigned int i = 0; i < 4; ++i) {
      const Tensor<1, 3> edge = facet.corners[facet::around[(i + 1) % 4]] - facet.corners[facet::around[i]];
      const double curvature = edge.norm() > 0. ? 8. * facet.bulge[i] / edge.norm_square() : 0.;
      if (std::abs(curvature) > std::abs(facet.curvature))
        facet.curvature = curvature;
    }
  }
  return facets;
}

} // namespace billet
