// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_SLAVE_FINDER_H
#define BILLET_CONTACT_SLAVE_FINDER_H

#include "billet/contact/facet_contact_parts.h"

namespace billet {

/// Finds the facets that a slave node touches or is near, by type Facet (PlanedFacet, MeanGapFacet
/// or BilinearFacet), with normal, gap and areas.
template <class Facet> class SlaveFinder {
public:
  /// Constructs the finder, which reads the parts except their TouchingSlaves, which it writes.
  explicit SlaveFinder(FacetContactParts &parts) : parts_(parts) {}

  /// Sets the state of a slave, without traction, and appends its shares. Must be called for slaves
  /// in their order.
  void find(std::size_t s);

private:
  TouchedFacet choose(std::size_t s, const TouchedFacet &last_iteration) const;
  /// Marks a slave without contact as resting on the facet below, or as near to it.
  void find_below(std::size_t s, SlaveState &state);
  /// Whether the slave was in front of this facet by at most `on_it` at the start of the step, or
  /// behind it.
  bool is_resting(const TouchedFacet &below, std::size_t s, double on_it) const;
  void compute_areas(std::size_t s, SlaveState &state) const;

  FacetContactParts &parts_;
};

/// Specialisation for overlaps: finds the mean over the overlaps of a slave's own facets with
/// others.
template <> class SlaveFinder<OverlapFacet> {
public:
  explicit SlaveFinder(FacetContactParts &parts) : parts_(parts) {}
  void find(std::size_t s);

private:
  FacetContactParts &parts_;
};

} // namespace billet

#endif
