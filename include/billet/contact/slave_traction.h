// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_SLAVE_TRACTION_H
#define BILLET_CONTACT_SLAVE_TRACTION_H

#include "billet/contact/friction_account.h"
#include "billet/contact/friction_history.h"
#include "billet/contact/traction.h"
#include "billet/geometry/derivative.h"
#include "billet/geometry/facet_projection.h"

#include <cmath>
#include <type_traits>

namespace billet {

/// Friction history of a slave node. It belongs to the node: sliding from one facet to the next
/// does not change it. A node out of contact has a new one.
struct SlaveHistory : FrictionHistory {
  double area = 0.; ///< of the traction [length²]
};

/// Motion of a slave node and of the facet that it touches over a step.
template <class Number> struct SlaveMotionOf {
  /// Displacement of the node relative to the facet's material point that is now below it, for an
  /// observer who rotates with the facet: (x − x̂) − R (x_n − x̂_n), x̂ = Σ w_I x_I. 0 if both move
  /// as one rigid body.
  dealii::Tensor<1, 3, Number> displacement;
  dealii::Tensor<2, 3, Number> rotation; ///< R, rotation of the facet
  double duration;                       ///< [time]; 0 in a step without duration
  /// Multiplier offset: the gap is the distance less this [length].
  double multiplier_offset = 0.;
  /// Maximum distance from the facet at which a node counts as touching [length].
  double flush = 0.;
};
using SlaveMotion = SlaveMotionOf<double>;

/// Computes the motion. `_n` marks the start of the step; the weights are those of the projection
/// at its end.
template <class Number>
SlaveMotionOf<Number>
compute_slave_motion(const FacetCorners &corners_n, const FacetCornersOf<Number> &corners,
                     const std::array<Number, 4> &weights, const dealii::Tensor<1, 3, Number> &x_n,
                     const dealii::Tensor<1, 3, Number> &x, double duration);

/// Traction of a facet on a slave node, and its energies per area.
template <class Number> struct SlaveTractionOf {
  ContactStatus status = ContactStatus::open;
  double pressure = 0.;                  ///< [stress]
  dealii::Tensor<1, 3, Number> traction; ///< on the slave node [stress]
  double slip = 0.;                      ///< in this step [length]
  double dissipation = 0.;               ///< by the return map in this step, −t·γ [energy/length²]
  double stored_energy = 0.;             ///< in the penalty springs [energy/length²]
};
using SlaveTraction = SlaveTractionOf<double>;

/// Computes the traction without friction; `gap` < 0.
template <class Number>
SlaveTractionOf<Number> compute_slave_traction(const Frictionless & /*law*/, const double normal_stiffness,
                                               const dealii::Tensor<1, 3, Number> &normal,
                                               const Number &gap) {
  SlaveTractionOf<Number> result;
  result.status = ContactStatus::slip;
  const Number pressure = -normal_stiffness * gap;
  result.pressure = value_of(pressure);
  result.traction = pressure * normal;
  result.stored_energy = -0.5 * result.pressure * value_of(gap);
  return result;
}

/// Returns −∂t/∂x of the traction t on a node at fixed normal and facet, from the tangent in its
/// frame [stress/length].
template <class Number>
dealii::Tensor<2, 3> to_space(const FrameOf<Number> &frame, const FrameTraction &traction) {
  const std::array<dealii::Tensor<1, 3>, 3> axes{frame.q, frame.r, frame.n};
  dealii::Tensor<2, 3> tangent;
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j)
      tangent += traction.tangent[i][j] * dealii::outer_product(axes[i], axes[j]);
  return tangent;
}

/// Returns the part φ = g/(g − g_n) of the step in which a node was behind a facet. The node came
/// through the facet within the step. g is the distance now. Returns 1 if the node touched the
/// facet at the start.
template <class Number>
Number part_in_contact(const Number &distance, const dealii::Tensor<1, 3, Number> &normal,
                       const SlaveMotionOf<Number> &motion) {
  const Number distance_n = distance - motion.displacement * normal;
  if (!(distance_n > motion.flush))
    return 1.;
  return distance < 0. ? Number(distance / (distance - distance_n)) : Number(0.);
}

/// Computes friction in the contact frame, eqs. (4), (5), (32)-(40) of Bittencourt & Creus (1998)
/// as in contact/traction.h. The frame at the end of the last step follows the facet's rotation and
/// is then rotated onto the new normal. A pair that sticks and rotates thus keeps its traction
/// components and creates none. A node that has come through the facet within the step slides only
/// for its part_in_contact(). `gap` < 0; `history` becomes the state at the end of the step, and
/// may alias `history_n`.
///
/// With Derivative as Number, the traction has its exact derivatives; the other results, and
/// `history`, have values only. `tangent`, unless null, becomes −∂t/∂x of this kind of tangent, as
/// in to_space().
template <class Number>
SlaveTractionOf<Number> compute_slave_traction(const FrictionLaw &law, const ContactStiffness &stiffness,
                                               const dealii::Tensor<1, 3, Number> &normal, const Number &gap,
                                               const SlaveMotionOf<Number> &motion,
                                               const SlaveHistory &history_n, SlaveHistory &history,
                                               const FrictionTangent &kind = {},
                                               dealii::Tensor<2, 3> *tangent = nullptr) {
  const FrameOf<Number> frame = history_n.is_active ? history_n.frame.transported(motion.rotation, normal)
                                                    : FrameOf<Number>::from_normal(normal);
  const Number fraction = history_n.is_active
                              ? Number(1.)
                              : part_in_contact(Number(gap + motion.multiplier_offset), normal, motion);
  const std::array<Number, 2> slid{fraction * (motion.displacement * frame.q),
                                   fraction * (motion.displacement * frame.r)};
  TangentialIncrement increment{{value_of(slid[0]), value_of(slid[1])}};
  increment.per_time = motion.duration > 0. ? 1. / motion.duration : 0.;
  increment.rate = history_n.slip_rate;
  const FrameTraction t =
      compute_traction(law, stiffness, kind, value_of(gap), history_n.tangential, increment);

  SlaveTractionOf<Number> result;
  result.status = t.status;
  result.pressure = t.pressure;
  // The differences are 0 in value; they carry the derivatives of the arguments through the return
  // map.
  const std::array<Number, 3> change{slid[0] - increment.value[0], slid[1] - increment.value[1],
                                     gap - value_of(gap)};
  std::array<Number, 3> components{t.tangential[0], t.tangential[1], t.pressure};
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j)
      components[i] -= t.tangent[i][j] * change[j];
  result.traction = components[0] * frame.q + components[1] * frame.r + components[2] * frame.n;
  result.slip = std::hypot(t.slip[0], t.slip[1]);
  result.dissipation = -(t.tangential[0] * t.slip[0] + t.tangential[1] * t.slip[1]);
  result.stored_energy =
      0.5 * stiffness.normal * value_of(gap) * value_of(gap) +
      0.5 * (t.tangential[0] * t.tangential[0] + t.tangential[1] * t.tangential[1]) / stiffness.tangential;
  if constexpr (std::is_same_v<Number, double>) {
    if (tangent != nullptr)
      *tangent = to_space(frame, t);
    const double slip_rate = increment.per_time > 0. ? result.slip * increment.per_time : history_n.slip_rate;
    history = {true, frame, t.tangential, history_n.slip + result.slip, slip_rate, 0.};
  }
  return result;
}

/// Computes the account between the states of a slave node at both ends of a step; a node out of
/// contact has no traction. The last two arguments are those of FrictionStep.
FrictionAccount compute_friction_account(const SlaveHistory &history_n, const SlaveHistory &history,
                                         const SlaveMotion &motion, const FrictionRule &rule,
                                         double part_in_contact = 1., double limit_n = 0.);

} // namespace billet

#endif
