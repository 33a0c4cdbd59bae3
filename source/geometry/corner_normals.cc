// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/corner_normals.h"

#include "billet/disjoint_sets.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace billet {

using dealii::Tensor;

namespace {

constexpr double flat_angle = 2e-4; // maximum angle between the normals of a flat region [radians]
// Minimum height of a facet with an area, over the size of the mesh.
constexpr double min_height = 3e-7;

/// Connected facets in one plane.
struct FlatRegion {
  double radius;  ///< radius about the centroid [length]
  bool is_single; ///< whether it is one facet
};

FlatRegion measure(const TriangleMesh &mesh, const FacetNormals &facets,
                   const std::vector<unsigned int> &region) {
  Tensor<1, 3> centroid;
  double area = 0.;
  for (const unsigned int f : region) {
    area += facets.areas[f];
    for (const unsigned int point : mesh.facets[f])
      centroid += facets.areas[f] / 3. * mesh.points[point];
  }
  double radius = 0.;
  if (area > 0.)
    for (const unsigned int f : region)
      for (const unsigned int point : mesh.facets[f])
        radius = std::max(radius, (mesh.points[point] - centroid / area).norm());
  return {radius, region.size() == 1};
}

/// Returns the region of each facet. Large facets collect their regions first.
std::vector<FlatRegion> flat_regions(const TriangleMesh &mesh, const TriangleEdges &edges,
                                     const FacetNormals &facets) {
  std::vector<unsigned int> seeds(mesh.facets.size());
  std::iota(seeds.begin(), seeds.end(), 0U);
  std::stable_sort(seeds.begin(), seeds.end(), [&facets](const unsigned int a, const unsigned int b) {
    return facets.areas[a] > facets.areas[b];
  });
  std::vector<FlatRegion> result(mesh.facets.size());
  std::vector<bool> is_taken(mesh.facets.size());
  std::vector<unsigned int> region;
  for (const unsigned int seed : seeds) {
    if (is_taken[seed])
      continue;
    is_taken[seed] = true;
    region = {seed};
    for (std::size_t i = 0; i < region.size(); ++i)
      for (const unsigned int e : edges.of_facet[region[i]])
        for (const unsigned int other : edges.edges[e].facets)
          if (other != TriangleEdges::none && !is_taken[other] &&
              angle_between(facets.normals[seed], facets.normals[other]) < flat_angle) {
            is_taken[other] = true;
            region.push_back(other);
          }
    const FlatRegion measured = measure(mesh, facets, region);
    for (const unsigned int f : region)
      result[f] = measured;
  }
  return result;
}

} // namespace

double angle_between(const Tensor<1, 3> &a, const Tensor<1, 3> &b) {
  return 2. * std::atan2((a - b).norm(), (a + b).norm());
}

FacetNormals::FacetNormals(const TriangleMesh &mesh, const TriangleEdges &edges) {
  const double tiny = min_height * mesh.size();
  std::vector<unsigned int> slivers;
  for (unsigned int f = 0; f < mesh.facets.size(); ++f) {
    std::array<Tensor<1, 3>, 3> sides;
    double longest = 0.;
    for (unsigned int i = 0; i < 3; ++i) {
      sides[i] = mesh.points[mesh.facets[f][(i + 1) % 3]] - mesh.points[mesh.facets[f][i]];
      longest = std::max(longest, sides[i].norm());
    }
    const Tensor<1, 3> cross = dealii::cross_product_3d(sides[0], sides[1]);
    const bool is_sliver = cross.norm() <= tiny * longest;
    if (is_sliver) {
      slivers.push_back(f);
      sliver_height = tiny;
    }
    areas.push_back(is_sliver ? 0. : 0.5 * cross.norm());
    normals.push_back(is_sliver ? Tensor<1, 3>() : cross / cross.norm());
  }
  // A sliver takes the normal of the facet at its longest side. A chain of slivers needs as many
  // passes as its length.
  for (bool continues = true; continues;) {
    continues = false;
    for (const unsigned int f : slivers) {
      if (normals[f].norm_square() > 0.)
        continue;
      double longest = 0.;
      unsigned int neighbour = TriangleEdges::none;
      for (const unsigned int e : edges.of_facet[f]) {
        const auto &edge = edges.edges[e];
        const double length = (mesh.points[edge.points[1]] - mesh.points[edge.points[0]]).norm();
        const unsigned int other = edge.facets[edge.facets[0] == f ? 1 : 0];
        if (other != TriangleEdges::none && normals[other].norm_square() > 0. && length > longest) {
          longest = length;
          neighbour = other;
        }
      }
      if (neighbour == TriangleEdges::none)
        continue;
      normals[f] = normals[neighbour];
      continues = true;
    }
  }
}

CornerNormals corner_normals(const TriangleMesh &mesh, const TriangleEdges &edges, const FacetNormals &facets,
                             const double sharp_angle) {
  const auto n_facets = static_cast<unsigned int>(mesh.facets.size());
  DisjointSets groups(3 * static_cast<std::size_t>(n_facets));
  for (const auto &edge : edges.edges) {
    if (facets.is_sharp(edge, sharp_angle))
      continue;
    const auto [a, b] = edge.facets;
    // The second facet traverses the edge in the opposite direction.
    const auto [i, j] = edge.corners;
    groups.join(3 * a + i, 3 * b + (j + 1) % 3);
    groups.join(3 * a + (i + 1) % 3, 3 * b + j);
  }

  const std::vector<FlatRegion> regions = flat_regions(mesh, edges, facets);
  std::vector<double> min_radius(3 * static_cast<std::size_t>(n_facets),
                                 std::numeric_limits<double>::infinity());
  for (unsigned int f = 0; f < n_facets; ++f)
    for (unsigned int i = 0; i < 3 && facets.areas[f] > 0.; ++i) {
      double &minimum = min_radius[groups.find(3 * f + i)];
      minimum = std::min(minimum, regions[f].radius);
    }

  std::vector<Tensor<1, 3>> sums(3 * static_cast<std::size_t>(n_facets));
  for (unsigned int f = 0; f < n_facets; ++f)
    for (unsigned int i = 0; i < 3 && facets.areas[f] > 0.; ++i) {
      const auto &point = mesh.points[mesh.facets[f][i]];
      const double sides = (mesh.points[mesh.facets[f][(i + 1) % 3]] - point).norm_square() *
                           (mesh.points[mesh.facets[f][(i + 2) % 3]] - point).norm_square();
      const unsigned int group = groups.find(3 * f + i);
      const double ratio = regions[f].is_single ? 1. : regions[f].radius / (1.4 * min_radius[group]);
      sums[group] += facets.areas[f] / sides * std::max(1., std::pow(ratio, 8)) * facets.normals[f];
    }

  CornerNormals normals(n_facets);
  for (unsigned int f = 0; f < n_facets; ++f)
    for (unsigned int i = 0; i < 3; ++i) {
      const Tensor<1, 3> &sum = sums[groups.find(3 * f + i)];
      normals[f][i] = sum.norm() > 0. ? sum / sum.norm() : facets.normals[f];
    }
  return normals;
}

} // namespace billet
