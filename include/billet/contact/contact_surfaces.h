// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_CONTACT_SURFACES_H
#define BILLET_CONTACT_CONTACT_SURFACES_H

#include "billet/contact/moved_facets.h"
#include "billet/contact/surface_exchange.h"
#include "billet/usage.h"

#include <mpi.h>

#include <optional>
#include <vector>

namespace billet {

/// The surfaces of a contact pair at the start of the step and now. They consist of own facets and
/// nearby facets of other ranks, with the search for facets near slave nodes.
class ContactSurfaces {
public:
  using Positions = FacetSearch::Positions;

  /// `node_keys` and `facets` are as for SurfaceExchange; `margin` > 0 is that of the search
  /// [length].
  ContactSurfaces(MPI_Comm communicator, FacetSearch::Partners partners, double margin,
                  std::vector<std::uint64_t> node_keys, std::vector<SurfaceFacet> facets);
  ContactSurfaces(const ContactSurfaces &) = delete;
  ContactSurfaces &operator=(const ContactSurfaces &) = delete;

  /// Moves this rank's nodes, and ghosts. Returns whether rebuild() must follow. Collective.
  bool update(const Positions &positions_n, const Positions &positions);
  /// Rebuilds the lists of nearby facets; indices of ghosts change. With `penetration` [facet
  /// reaches], whole facets at that distance count, not only nodes within the reach. Collective.
  void rebuild(const std::vector<SlaveNode> &slaves, const std::optional<double> &penetration);
  /// Whether the last update() required a rebuild().
  bool is_rebuilt() const { return is_rebuilt_; }

  MPI_Comm communicator() const { return communicator_; }
  double margin() const { return margin_; }
  const SurfaceExchange &exchange() const { return exchange_; }
  const FacetSearch &search() const { return search_; }
  const MovedFacets &moved() const { return moved_; }
  const SurfaceFacet &facet(const unsigned int f) const { return search_.facets()[f]; }
  /// Whether the facet is this rank's.
  bool owns(const unsigned int f) const { return f < exchange_.n_own_facets(); }
  /// Returns the positions with ghosts at the start of the step; positions() returns the current
  /// ones.
  const Positions &positions_n() const { return positions_n_; }
  const Positions &positions() const { return positions_; }

private:
  double find_distance(const std::optional<double> &penetration) const;

  MPI_Comm communicator_;
  FacetSearch::Partners partners_;
  double margin_;
  SurfaceExchange exchange_;
  FacetSearch search_;
  double max_reach_ = 0.;
  Positions positions_n_, positions_;
  MovedFacets moved_{search_, positions_};
  bool is_rebuilt_ = false;
  HeldMemory memory_{Capability::body_contact}, self_memory_{Capability::self_contact};
};

} // namespace billet

#endif
