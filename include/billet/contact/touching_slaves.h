// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_TOUCHING_SLAVES_H
#define BILLET_CONTACT_TOUCHING_SLAVES_H

#include "billet/contact/contact_surfaces.h"
#include "billet/contact/facet_sharing.h"
#include "billet/contact/gap_offsets.h"
#include "billet/contact/slave_nodes.h"
#include "billet/contact/slave_start.h"
#include "billet/contact/slave_traction.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace billet {

/// Facets that a slave node touches or is near, and the traction on it.
struct SlaveState {
  TouchedFacet touched;
  bool is_near = false; ///< touches nothing yet, but may soon
  /// Normal and gap, less the offset, of the touched or near facets, and these facets, by index
  /// into the shares.
  SharedGap contact{dealii::Tensor<1, 3>(), 0.};
  std::size_t first_share = 0, end_of_shares = 0;
  SlaveTraction traction;
  double own_area = 0.; ///< of this rank's facets [length²]
  double area = 0.;     ///< of all ranks' facets [length²]
  bool rests = false;   ///< touches without pressing

  /// Whether the node is in contact: it touches, and may bear pressure or friction.
  bool presses() const { return touched.exists() && (contact.gap < 0. || rests); }
  bool has_pressure() const { return presses() && traction.pressure > 0.; }
};

/// States of all slave nodes at the last evaluation, and results that follow from them alone:
/// areas, motions, forces on nodes and facets.
class TouchingSlaves {
public:
  /// All arguments must outlive this object.
  TouchingSlaves(const ContactSurfaces &surfaces, const SlaveNodes &slaves, const GapOffsets &offsets,
                 const SlaveStart &start);

  /// Begins an evaluation at the end of a step of this duration [time]. SlaveFinder then sets the
  /// states in order.
  void start_evaluation(const double duration) {
    duration_ = duration;
    shares_.clear();
  }
  double duration() const { return duration_; }
  std::size_t size() const { return states_.size(); }
  SlaveState &operator[](const std::size_t s) { return states_[s]; }
  const SlaveState &operator[](const std::size_t s) const { return states_[s]; }
  /// Returns the shares of all slaves, in their order.
  std::vector<FacetShare> &shares() { return shares_; }
  const std::vector<FacetShare> &shares() const { return shares_; }

  /// Returns the point of a slave that touches a share's facet: the node itself, or a point of its
  /// own facet.
  dealii::Tensor<1, 3> point_of(const std::size_t s, const FacetShare &share,
                                const ContactSurfaces::Positions &positions) const {
    return share.slave_facet == FacetShare::none
               ? positions[slaves_.node(s)]
               : facet::interpolate(share.slave_weights,
                                    corners_of(surfaces_.facet(share.slave_facet), positions));
  }
  /// Returns this rank's part of the area of a share [length²].
  double area_of(const SlaveState &state, const FacetShare &share) const {
    if (share.slave_facet == FacetShare::none)
      return share.share * state.own_area;
    return surfaces_.owns(share.slave_facet) ? share.share * state.area : 0.;
  }
  /// Returns an upper bound of the area by which a share's force grows with penetration [length²].
  double spring_area_of(const SlaveState &state, const FacetShare &share) const {
    const double area = area_of(state, share);
    return area > 0. ? std::max(area, share.area) : 0.;
  }
  /// Returns the fraction of the facets around a slave that this rank owns, by number.
  double own_part(std::size_t s) const;
  /// Returns the distance of a slave that presses to the surface itself, regardless of augmentation
  /// [length].
  double penetration_of(const std::size_t s) const {
    return std::abs(states_[s].contact.gap + offsets_.augmentation[s]);
  }

  /// Computes the motion, over the step, of a slave that presses relative to the surface that it
  /// touches now.
  SlaveMotion motion_of(std::size_t s) const;
  /// Computes the motion of a slave that does not press relative to the facet that it touched at
  /// the start of the step.
  SlaveMotion motion_after_contact(std::size_t s) const;

  /// Calls visit(share, force on the slave, reaction on the corners) for each facet that a slave
  /// touches.
  template <class Visit> void visit_forces(const std::size_t s, const Visit &visit) const {
    const SlaveState &state = states_[s];
    if (!state.presses() || !(state.own_area > 0.))
      return;
    for (std::size_t i = state.first_share; i < state.end_of_shares; ++i) {
      const FacetShare &share = shares_[i];
      const double area = area_of(state, share);
      if (!(area > 0.))
        continue;
      const dealii::Tensor<1, 3> part = area * state.traction.traction;
      visit(share, part,
            surfaces_.moved().reaction(share.facet)(share.projection.weights,
                                                    point_of(s, share, surfaces_.positions()), part));
    }
  }

private:
  const ContactSurfaces &surfaces_;
  const SlaveNodes &slaves_;
  const GapOffsets &offsets_;
  const SlaveStart &start_;
  std::vector<SlaveState> states_;
  std::vector<FacetShare> shares_;
  double duration_ = 0.;
  HeldMemory memory_{Capability::contact};
};

} // namespace billet

#endif
