// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_SLAVE_FINDER_H
#define BILLET_CONTACT_SLAVE_FINDER_H

#include "billet/contact/facet_contact_parts.h"

namespace billet {

/// Finds the facets that a slave node touches or is near, as a Facet sees them (PlanedFacet, MeanGapFacet or
/// BilinearFacet), with normal, gap and areas.
template <class Facet> class SlaveFinder {
public:
  /// Reads the parts but for their TouchingSlaves, which it writes.
  explicit SlaveFinder(FacetContactParts &parts) : parts_(parts) {}

  /// Sets the state of a slave, without traction, and appends its shares. Slaves come one after the other.
  void find(std::size_t s);

private:
  TouchedFacet choose(std::size_t s, const TouchedFacet &last_iteration) const;
  /// Takes a slave that touches nothing as resting on the facet below, or as near to it.
  void find_below(std::size_t s, SlaveState &state);
  /// Whether the slave was before this facet by no more than `on_it` at the start of the step, or behind it.
  bool is_resting(const TouchedFacet &below, std::size_t s, double on_it) const;
  void compute_areas(std::size_t s, SlaveState &state) const;

  FacetContactParts &parts_;
};

/// ... or the mean over the overlaps of its own facets with others.
template <> class SlaveFinder<OverlapFacet> {
public:
  explicit SlaveFinder(FacetContactParts &parts) : parts_(parts) {}
  void find(std::size_t s);

private:
  FacetContactParts &parts_;
};

} // namespace billet

#endif
