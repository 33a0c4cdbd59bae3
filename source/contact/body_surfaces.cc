// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/body_surfaces.h"

#include "billet/contact/overlap.h"
#include "billet/contact/surface_correction.h"
#include "billet/discretization/boundary_facets.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace billet {

namespace {

struct BodySurfacesLimits {
  /// Reach of the search over the largest gap that counts as closed, so that gaps at this limit are
  /// found.
  static constexpr double beyond_gap = 1.1;
  /// Penetration over the size or the wall of a facet up to which nodes are found. All methods find
  /// nodes there, and all elements are thicker.
  static constexpr double part_of_facet = 0.4;
};

/// Returns the key of a facet: unique, and the same on any number of ranks. It is made of those of
/// two opposite corners, unless these are of a refined body and have too many bits.
std::uint64_t make_key(const BoundaryFacet &facet, const NodeKeys &keys) {
  const std::uint64_t first = keys(facet.dofs[0][0]), second = keys(facet.dofs[3][0]);
  constexpr std::uint64_t refined = std::uint64_t{1} << 63U;
  if (std::max(first, second) >> 32U != 0)
    return refined | facet.key;
  return (std::min(first, second) << 32U) | std::max(first, second);
}

} // namespace

BodySurfaces::BodySurfaces(const BodyPair &pair, const LocalNodes &nodes, const NodeKeys &node_keys) {
  const Discretization &discretization = nodes.discretization();
  std::map<DofIndex, unsigned int> index;
  for (unsigned int side = 0; side < 2; ++side)
    coarse[side] = std::exp2(discretization.levels()[pair.bodies[side]]);
  const unsigned int n_surfaces = pair.is_self_contact ? 1 : 2;
  std::vector<BoundaryFacet> all;
  for (unsigned int surface = 0; surface < n_surfaces; ++surface)
    for (const auto &boundary :
         collect_boundary_facets(discretization, pair.bodies[surface], pair.boundary_ids[surface])) {
      all.push_back(boundary);
      SurfaceFacet facet{};
      facet.surface = surface;
      facet.key = make_key(boundary, node_keys);
      areas.push_back(boundary.area_vector().norm());
      facet.reach =
          std::max(contact_reach(boundary), BodySurfacesLimits::beyond_gap * pair.overlap.closed_gap);
      facet.bulge = bulge_of(boundary, pair.correction);
      facet.wall = boundary.thickness;
      penetrations.push_back(BodySurfacesLimits::part_of_facet *
                             std::min(std::sqrt(areas.back()), boundary.thickness));
      for (unsigned int a = 0; a < 4; ++a) {
        const auto [entry, is_new] =
            index.emplace(boundary.dofs[a][0], static_cast<unsigned int>(local_nodes.size()));
        if (is_new) {
          local_nodes.push_back(nodes.find(boundary.dofs[a][0]));
          surface_of.push_back(surface);
        }
        facet.nodes[a] = entry->second;
      }
      facets.push_back(facet);
    }
  const auto sizes_around = compute_facet_sizes(discretization, all);
  for (const unsigned int node : local_nodes) {
    keys.push_back(node_keys(nodes.dofs(node)[0]));
    const FacetSize size = sizes_around.at(nodes.dofs(node)[0]);
    sizes.push_back(size.size);
    penalty_lengths.push_back(coarse[surface_of[penalty_lengths.size()]] *
                              penalty_length(pair.penalty_counts_thickness, size.size, size.thickness));
  }
}

double BodySurfaces::find_smallest_size(MPI_Comm communicator) const {
  double minimum = std::numeric_limits<double>::infinity();
  for (const double area : areas)
    minimum = std::min(minimum, std::sqrt(area));
  return dealii::Utilities::MPI::min(minimum, communicator);
}

PairPenalties compute_penalties(const Scene &scene, const BodyPair &pair, const BodySurfaces &surfaces,
                                MPI_Comm communicator) {
  std::array<double, 6> totals{}; // area, number of facets and volume below them, for each surface
  for (std::size_t f = 0; f < surfaces.facets.size(); ++f) {
    totals[surfaces.facets[f].surface] += surfaces.areas[f];
    totals[2 + surfaces.facets[f].surface] += 1.;
    totals[4 + surfaces.facets[f].surface] += surfaces.areas[f] * surfaces.facets[f].wall;
  }
  MPI_Allreduce(MPI_IN_PLACE, totals.data(), 6, MPI_DOUBLE, MPI_SUM, communicator);
  const auto young = [&](const unsigned int surface) {
    return scene.bodies()[pair.bodies[surface]].young_modulus;
  };
  const auto mean_length = [&](const unsigned int surface) {
    return surfaces.coarse[surface] * penalty_length(pair.penalty_counts_thickness,
                                                     std::sqrt(totals[surface] / totals[2 + surface]),
                                                     totals[4 + surface] / totals[surface]);
  };
  std::vector<double> lengths = surfaces.penalty_lengths;
  // These pass a uniform pressure exactly if all penalties are equal.
  if (pair.facets == FacetMethod::overlap)
    for (std::size_t i = 0; i < lengths.size(); ++i)
      lengths[i] = mean_length(surfaces.surface_of[i]);
  const auto of_sides =
      pair.penalty_of == parameters::ContactPair::PenaltyOf::stiffer
          ? +[](const double own, const double other) { return std::max(own, other); }
          : +[](const double own, const double other) { return own * other / (own + other); };
  const auto unit_of = pair.penalty_is_factor ? +[](const double of_factor) { return of_factor; }
                                              : +[](const double) { return 1.; };
  PairPenalties penalties;
  double enough = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < surfaces.local_nodes.size(); ++i) {
    const unsigned int own = surfaces.surface_of[i], other = pair.is_self_contact ? 0 : 1 - own;
    const double of_factor = of_sides(young(own) / lengths[i], young(other) / mean_length(other)),
                 unit = unit_of(of_factor);
    penalties.of_nodes.push_back({unit * pair.normal_penalty, unit * pair.tangential_penalty});
    enough = std::min(enough, enough_penalty * of_factor / unit);
  }
  penalties.max_stiffening.normal = enough / pair.normal_penalty;
  if (pair.has_friction())
    penalties.max_stiffening.tangential = enough / pair.tangential_penalty;
  return penalties;
}

} // namespace billet
