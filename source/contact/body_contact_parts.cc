// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/body_contact_parts.h"

#include "billet/contact/facet_contact.h"
#include "billet/contact/facing_gaps.h"
#include "billet/contact/overlap.h"
#include "billet/friction/friction_of_pass.h"

#include <algorithm>

namespace billet {

FacetSearch::Partners partners_of(const BodyPair &pair) {
  return pair.is_self_contact ? FacetSearch::Partners::other_surfaces_and_self
                              : FacetSearch::Partners::other_surfaces;
}

BodyContactParts::BodyContactParts(const Scene &scene, const BodyPair &of_pair, const LocalNodes &of_nodes)
    : pair(of_pair), nodes(of_nodes), communicator(nodes.discretization().communicator()),
      surfaces(pair, nodes, NodeKeys(nodes.discretization())), positions(surfaces.local_nodes.size()) {
  FacetContactSettings settings;
  settings.method = pair.facets;
  settings.two_pass = pair.two_passes || pair.is_self_contact;
  settings.friction = settings.two_pass && pair.has_friction()
                          ? std::make_shared<const FrictionOfPass>(pair.friction)
                          : pair.friction;
  settings.edges = pair.edges;
  settings.partners = partners_of(pair);
  settings.search_margin =
      std::max(pair.search_margin * surfaces.find_smallest_size(communicator), 2. * pair.overlap.closed_gap);
  settings.limits.zone = pair.smoothing;
  if (scene.parameters().scheme().has_matrix)
    settings.max_changes = RestlessNodes::max_changes;
  if (!scene.parameters().scheme().has_inertia)
    settings.touching_gap = touching_gap;
  const PairPenalties penalties = compute_penalties(scene, pair, surfaces, communicator);
  settings.penetration_tolerance = pair.penetration_tolerance.value_or(0.);
  settings.max_stiffening = penalties.max_stiffening;
  settings.touching_gap *= std::min(1., settings.max_stiffening.normal);
  contact = std::make_unique<FacetContact>(communicator, settings, surfaces.keys, surfaces.facets,
                                           penalties.of_nodes, surfaces.sizes);
}

BodyContactParts::~BodyContactParts() = default;

void BodyContactParts::evaluate(const double step_duration) {
  if (positions_n.size() != positions.size())
    positions_n = positions;
  forces.assign(positions.size(), dealii::Tensor<1, 3>());
  contact->add_forces(positions_n, positions, step_duration, forces);
}

void BodyContactParts::allow_overlap() {
  if (pair.overlap.closed_gap > 0.) {
    contact->close_initial_gaps(positions, pair.overlap.closed_gap);
    evaluate(0.);
  }
  if (!pair.overlap.is_allowed && !(pair.overlap.closed_gap > 0.))
    return;
  allow_penetrations();
  if (!changes_gaps(pair.overlap) || pair.is_self_contact)
    return;
  contact->carry_initial_gaps(positions);
  evaluate(0.);
  allow_penetrations();
}

void BodyContactParts::allow_penetrations() {
  // A node's mean gap over overlapping facets hides larger penetrations in parts of them.
  // Repetition reduces these until none remain.
  constexpr unsigned int max_times = 200;
  constexpr double none = 1e-10; // facet sizes
  for (unsigned int i = 0; i < max_times; ++i) {
    if (dealii::Utilities::MPI::max(contact->allow_initial_penetrations(), communicator) <= none)
      return;
    evaluate(0.);
  }
}

} // namespace billet
