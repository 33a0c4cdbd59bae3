// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/facet_penetration.h"

#include "billet/contact/rigid_contact_parts.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {

/// Nodes around a sample of a facet; the second two repeat the first two on a side.
using Around = std::array<unsigned int, 4>;
constexpr std::array<Around, 5> samples{
    {{0, 3, 1, 2}, {0, 1, 0, 1}, {0, 2, 0, 2}, {1, 3, 1, 3}, {2, 3, 2, 3}}};

/// The depth at a sample; `facet_length` between the nodes around it.
struct Depth {
  double length, facet_length;
};

class FacetSamples {
public:
  explicit FacetSamples(const RigidContactParts &parts) : parts_(parts) {}

  /// Whether the tool may be in the facet between its nodes: it is near, and not flat there.
  bool may_be_entered(const CornerStates &states) const {
    const double reach = 0.5 * std::max((states[3]->position - states[0]->position).norm(),
                                        (states[2]->position - states[1]->position).norm());
    constexpr double flat = 1e-6; // change of a unit normal
    bool is_near = false, is_flat = true;
    for (const ToolContactState *state : states) {
      if (state->is_behind)
        return false;
      is_near = is_near || state->gap < reach;
      is_flat = is_flat && state->status != ContactStatus::open &&
                (state->normal - states[0]->normal).norm() < flat;
    }
    return is_near && !is_flat;
  }

  Tensor<1, 3> position(const CornerStates &states, const Around &around) const {
    Tensor<1, 3> x;
    for (const unsigned int a : around)
      x += 0.25 * states[a]->position;
    return x;
  }

  Depth depth(const ContactFacet &facet, const CornerStates &states, const Around &around,
              const Tensor<1, 3> &area) const {
    const ToolStep &step = parts_.step;
    const Tensor<1, 3> x = position(states, around);
    const auto projection = step.surface.project(step.placement.to_tool(x), states[around[0]]->patch);
    double of_nodes = 0., gap = projection.gap;
    for (const unsigned int a : around) {
      const ContactPoint &node = parts_.slaves.nodes[facet.nodes[a]];
      of_nodes += 0.25 * std::min(0., states[a]->gap + node.multiplier_offset);
      gap += 0.25 * InitialOverlap::counted(node.initial_penetration, step.allowed_part);
    }
    const auto distance = [&](const unsigned int a, const unsigned int b) {
      return (states[around[b]]->position - states[around[a]]->position).norm();
    };
    const double length = std::max(distance(0, 1), distance(2, 3));
    // A tool has no back: what is deeper than a facet, or faces away, is behind it.
    const bool is_behind = -gap >= length || (step.placement.rotation * projection.normal) * area >= 0.;
    return projection.exists && !is_behind ? Depth{std::max(0., of_nodes - gap), length} : Depth{0., 1.};
  }

private:
  const RigidContactParts &parts_;
};

FacetPenetration max_over_ranks(const FacetPenetration &local, const MPI_Comm communicator) {
  const Tensor<1, 3> &x = local.position;
  FacetPenetration maximum;
  for (const auto &of_rank : dealii::Utilities::MPI::all_gather(
           communicator,
           std::array<double, 6>{local.length, local.of_facet, local.facet_length, x[0], x[1], x[2]}))
    maximum.add({of_rank[0], of_rank[1], of_rank[2], Tensor<1, 3>({of_rank[3], of_rank[4], of_rank[5]})});
  return maximum;
}

} // namespace

FacetPenetration find_facet_penetration(const RigidContactParts &parts) {
  FacetPenetration found;
  if (!parts.step.is_removed) {
    const FacetSamples facets(parts);
    for (const auto &facet : parts.slaves.facets) {
      const CornerStates states = parts.states_of(facet);
      if (!facets.may_be_entered(states))
        continue;
      const Tensor<1, 3> area = dealii::cross_product_3d(states[3]->position - states[0]->position,
                                                         states[2]->position - states[1]->position);
      for (const Around &around : samples) {
        const Depth depth = facets.depth(facet, states, around, area);
        found.add({depth.length, depth.length / depth.facet_length, depth.facet_length,
                   facets.position(states, around)});
      }
    }
  }
  return max_over_ranks(found, parts.communicator);
}

} // namespace billet
