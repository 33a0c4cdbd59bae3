// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_SLAVE_OVERLAPS_H
#define BILLET_CONTACT_SLAVE_OVERLAPS_H

#include "billet/contact/contact_surfaces.h"
#include "billet/contact/facet_overlaps.h"
#include "billet/contact/gap_offsets.h"
#include "billet/contact/slave_nodes.h"

#include <vector>

namespace billet {

/// Overlaps of facets raised by the gap offsets of their corners.
class SlaveOverlaps {
public:
  /// Lists the pairs of facets that may overlap.
  void rebuild(const ContactSurfaces &surfaces, bool with_self, bool two_pass);
  /// Computes the overlaps. Collective.
  void update(const ContactSurfaces &surfaces, const SlaveNodes &slaves, const GapOffsets &offsets);

  const FacetOverlaps &pairs() const { return overlaps_; }
  /// Returns the allowed penetrations of nodes, including ghosts; augmentation() returns their
  /// multiplier offsets. Both are empty if there are none.
  const std::vector<double> &gap_offsets() const { return gap_offsets_; }
  const std::vector<double> &augmentation() const { return augmentation_; }

private:
  FacetOverlaps overlaps_;
  std::vector<double> gap_offsets_, augmentation_;
};

} // namespace billet

#endif
