// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/facet_contact_parts.h"

#include <utility>

namespace billet {

FacetContactParts::FacetContactParts(MPI_Comm communicator, const FacetContactSettings &given_settings,
                                     std::vector<std::uint64_t> node_keys, std::vector<SurfaceFacet> facets,
                                     const std::vector<ContactStiffness> &stiffness,
                                     const std::vector<double> &sizes)
    : settings(given_settings), surfaces(communicator, settings.partners, settings.search_margin,
                                         std::move(node_keys), std::move(facets)),
      slaves(surfaces.exchange().facets(), settings.two_pass, sizes),
      penalties(slaves, stiffness, settings.two_pass, settings.has_friction()), start(slaves.size()),
      restless(settings.max_changes), touching(surfaces, slaves, offsets, start) {
  if (settings.method == FacetMethod::overlap)
    overlaps.emplace();
  if (settings.has_friction())
    friction.emplace(*settings.friction, touching, penalties, offsets, start);
  if (settings.edges)
    edges.emplace(settings, stiffness, penalties);
}

} // namespace billet
