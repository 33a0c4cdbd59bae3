// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_SLAVE_TRACTION_H
#define BILLET_CONTACT_SLAVE_TRACTION_H

#include "billet/contact/traction.h"
#include "billet/geometry/facet_projection.h"
#include "billet/geometry/frame.h"

#include <cmath>
#include <type_traits>

namespace billet {

/// What friction keeps of a slave node from step to step. It belongs to the node: sliding from one facet to
/// the next does not touch it. A node out of contact has a fresh one.
struct SlaveHistory {
  bool is_active = false; ///< the rest has been set
  Frame frame;
  std::array<double, 2> tangential{}; ///< traction on the frame's q and r [stress]
  double slip = 0.;                   ///< length of the path slipped [length]
  double slip_rate = 0.;              ///< [length/time]
};

/// How a slave node and the facet that it touches moved over a step.
struct SlaveMotion {
  /// Of the node, relative to the facet's material point that now is below it, as an observer sees it who
  /// turns with the facet: (x − x̂) − R (x_n − x̂_n), x̂ = Σ w_I x_I. 0 if both move as one rigid body.
  dealii::Tensor<1, 3> displacement;
  dealii::Tensor<2, 3> rotation; ///< R, of the facet
  double duration;               ///< [time]; 0 in a step that takes no time
};

/// `_n` marks the start of the step; the weights are those of the projection at its end.
SlaveMotion compute_slave_motion(const FacetCorners &corners_n, const FacetCorners &corners,
                                 const std::array<double, 4> &weights, const dealii::Tensor<1, 3> &x_n,
                                 const dealii::Tensor<1, 3> &x, double duration);

/// What a facet does to a slave node, per area.
struct SlaveTraction {
  ContactStatus status = ContactStatus::open;
  double pressure = 0.;          ///< [stress]
  dealii::Tensor<1, 3> traction; ///< on the slave node [stress]
  double slip = 0.;              ///< in this step [length]
  double dissipation = 0.;       ///< by friction in this step [energy/length²]
  double stored_energy = 0.;     ///< in the penalty springs [energy/length²]
};

/// Without friction; `gap` < 0.
SlaveTraction compute_slave_traction(const Frictionless &law, double normal_stiffness,
                                     const dealii::Tensor<1, 3> &normal, double gap);

/// Friction in the contact frame, eqs. (4), (5), (32)-(40) of Bittencourt & Creus (1998) as in
/// contact/traction.h. The frame of the last step's end goes along with the facet's rotation and is turned
/// onto the new normal, so that a pair that sticks and rotates keeps its traction components and creates
/// none. A node that has come through the facet within the step slides for the part φ = g/(g − g_n) of it
/// only. `gap` < 0; `history` becomes the state at the end of the step, and may be what `history_n` is.
template <class Law>
SlaveTraction compute_slave_traction(const Law &law, const ContactStiffness &stiffness,
                                     const dealii::Tensor<1, 3> &normal, const double gap,
                                     const SlaveMotion &motion, const SlaveHistory &history_n,
                                     SlaveHistory &history) {
  static_assert(!std::is_same_v<Law, Frictionless>, "nothing is kept for it");
  const Frame frame =
      history_n.is_active ? history_n.frame.transported(motion.rotation, normal) : Frame::from_normal(normal);
  TangentialIncrement increment{{motion.displacement * frame.q, motion.displacement * frame.r}};
  increment.per_time = motion.duration > 0. ? 1. / motion.duration : 0.;
  increment.rate = history_n.slip_rate;
  const double gap_n = gap - motion.displacement * normal;
  const double fraction = !history_n.is_active && gap_n > 0. ? gap / (gap - gap_n) : 1.;
  const FrameTraction t = compute_traction(law, {stiffness.normal, fraction * stiffness.tangential},
                                           ContactTangent::consistent, gap, history_n.tangential, increment);

  SlaveTraction result;
  result.status = t.status;
  result.pressure = t.pressure;
  result.traction = t.tangential[0] * frame.q + t.tangential[1] * frame.r + t.pressure * frame.n;
  result.slip = fraction * std::hypot(t.slip[0], t.slip[1]);
  result.dissipation = -fraction * (t.tangential[0] * t.slip[0] + t.tangential[1] * t.slip[1]);
  result.stored_energy =
      0.5 * stiffness.normal * gap * gap +
      0.5 * (t.tangential[0] * t.tangential[0] + t.tangential[1] * t.tangential[1]) / stiffness.tangential;
  const double slip_rate = increment.per_time > 0. ? result.slip * increment.per_time : history_n.slip_rate;
  history = {true, frame, t.tangential, history_n.slip + result.slip, slip_rate};
  return result;
}

} // namespace billet

#endif
