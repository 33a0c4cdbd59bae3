// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_CONTACT_PARTS_H
#define BILLET_CONTACT_FACET_CONTACT_PARTS_H

#include "billet/contact/contact_surfaces.h"
#include "billet/contact/edge_springs.h"
#include "billet/contact/facet_contact_settings.h"
#include "billet/contact/gap_offsets.h"
#include "billet/contact/restless_nodes.h"
#include "billet/contact/slave_friction.h"
#include "billet/contact/slave_nodes.h"
#include "billet/contact/slave_overlaps.h"
#include "billet/contact/slave_start.h"
#include "billet/contact/touching_slaves.h"

#include <optional>

namespace billet {

/// State of contact between surfaces, which FacetContact advances and its evaluations and measures
/// read.
struct FacetContactParts {
  /// Constructs the parts from the arguments of FacetContact.
  FacetContactParts(MPI_Comm communicator, const FacetContactSettings &settings,
                    std::vector<std::uint64_t> node_keys, std::vector<SurfaceFacet> facets,
                    const std::vector<ContactStiffness> &stiffness, const std::vector<double> &sizes);
  FacetContactParts(const FacetContactParts &) = delete;
  FacetContactParts &operator=(const FacetContactParts &) = delete;

  FacetContactSettings settings;
  ContactSurfaces surfaces;
  SlaveNodes slaves;
  SlavePenalties penalties;
  GapOffsets offsets;
  SlaveStart start;
  RestlessNodes restless;
  TouchingSlaves touching;
  std::optional<SlaveOverlaps> overlaps; ///< only with FacetMethod::overlap
  std::optional<SlaveFriction> friction; ///< none without friction
  std::optional<EdgeSprings> edges;      ///< none unless the settings enable them
  /// Forces on this rank's nodes and ghosts at the last evaluation. Those of other ranks' facets on
  /// a node are on one of the ranks that have it.
  ContactSurfaces::Positions nodal_forces;
};

} // namespace billet

#endif
