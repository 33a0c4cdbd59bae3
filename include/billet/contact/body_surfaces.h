// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_BODY_SURFACES_H
#define BILLET_CONTACT_BODY_SURFACES_H

#include "billet/contact/contact_penalties.h"
#include "billet/contact/facet_search.h"
#include "billet/contact/traction.h"
#include "billet/discretization/local_nodes.h"
#include "billet/discretization/node_keys.h"
#include "billet/scene/scene.h"

#include <array>
#include <vector>

namespace billet {

/// The undeformed faces of this rank that may touch, of a pair of bodies or of one body with
/// itself.
struct BodySurfaces {
  BodySurfaces(const BodyPair &pair, const LocalNodes &nodes, const NodeKeys &keys);

  /// Size of a facet of the unrefined body over that of its parts, for each of the two bodies.
  /// Penalties of a refined body remain, so that its pressures continue.
  std::array<double, 2> coarse;

  // For each surface node.

  std::vector<std::uint64_t> keys;
  std::vector<unsigned int> local_nodes;
  std::vector<unsigned int> surface_of; ///< which of the two bodies it belongs to
  std::vector<double> sizes;            ///< of the facets around it [length]
  std::vector<double> penalty_lengths;  ///< penalty_length() there, of the unrefined body [length]

  // For each facet.

  std::vector<SurfaceFacet> facets;
  std::vector<double> areas;        ///< [length²]
  std::vector<double> penetrations; ///< maximum penetration of nodes along their paths [length]

  /// Returns the size of the smallest facet of all ranks [length]. Collective.
  double find_smallest_size(MPI_Comm communicator) const;
};

/// Penalties of a pair of bodies.
struct PairPenalties {
  std::vector<ContactStiffness> of_nodes;
  ContactPenalties::Limits max_stiffening;
};

/// Computes the penalties of a pair of bodies. Collective.
PairPenalties compute_penalties(const Scene &scene, const BodyPair &pair, const BodySurfaces &surfaces,
                                MPI_Comm communicator);

} // namespace billet

#endif
