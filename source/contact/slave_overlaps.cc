// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/slave_overlaps.h"

namespace billet {

void SlaveOverlaps::rebuild(const ContactSurfaces &surfaces, const bool with_self, const bool two_pass) {
  overlaps_.rebuild(surfaces.search(), surfaces.positions_n(), surfaces.positions(), surfaces.margin(),
                    with_self, two_pass);
}

void SlaveOverlaps::update(const ContactSurfaces &surfaces, const SlaveNodes &slaves,
                           const GapOffsets &offsets) {
  gap_offsets_.clear();
  augmentation_.clear();
  if (offsets.are_used()) {
    gap_offsets_.assign(surfaces.exchange().n_nodes(), 0.);
    augmentation_ = gap_offsets_;
    for (std::size_t s = 0; s < slaves.size(); ++s) {
      augmentation_[slaves.node(s)] = offsets.augmentation[s];
      gap_offsets_[slaves.node(s)] = offsets.of(s).now - offsets.augmentation[s];
    }
    surfaces.exchange().update(gap_offsets_);
    surfaces.exchange().update(augmentation_);
  }
  overlaps_.update(surfaces.search(), surfaces.positions_n(), surfaces.positions(), gap_offsets_,
                   augmentation_);
}

} // namespace billet
