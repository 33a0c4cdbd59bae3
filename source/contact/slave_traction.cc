// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/slave_traction.h"

#include "billet/geometry/facet_rotation.h"

namespace billet {

using dealii::Tensor;

template <class Number>
SlaveMotionOf<Number>
compute_slave_motion(const FacetCorners &corners_n, const FacetCornersOf<Number> &corners,
                     const std::array<Number, 4> &weights, const Tensor<1, 3, Number> &x_n,
                     const Tensor<1, 3, Number> &x, const double duration) {
  const Tensor<2, 3, Number> rotation = facet_rotation(corners_n, corners);
  Tensor<1, 3, Number> arm_n = x_n, arm = x;
  for (unsigned int a = 0; a < 4; ++a) {
    arm_n -= weights[a] * corners_n[a];
    arm -= weights[a] * corners[a];
  }
  return {arm - rotation * arm_n, rotation, duration, 0., 0.};
}

template SlaveMotion compute_slave_motion(const FacetCorners &, const FacetCorners &,
                                          const std::array<double, 4> &, const Tensor<1, 3> &,
                                          const Tensor<1, 3> &, double);
template SlaveMotionOf<Derivative> compute_slave_motion(const FacetCorners &,
                                                        const FacetCornersOf<Derivative> &,
                                                        const std::array<Derivative, 4> &,
                                                        const Tensor<1, 3, Derivative> &,
                                                        const Tensor<1, 3, Derivative> &, double);

FrictionAccount compute_friction_account(const SlaveHistory &history_n, const SlaveHistory &history,
                                         const SlaveMotion &motion, const FrictionRule &rule,
                                         const double part_in_contact, const double limit_n) {
  // A frame of the last step rotates with the facet; the choice of the normal does not affect
  // tangential components.
  const Tensor<1, 3> q = history.is_active ? history.frame.q : motion.rotation * history_n.frame.q,
                     r = history.is_active ? history.frame.r : motion.rotation * history_n.frame.r;
  FrictionStep step{
      {},     {}, {motion.displacement * q, motion.displacement * r}, history.is_active, part_in_contact,
      limit_n};
  if (history_n.is_active)
    step.traction_n = history_n.tangential;
  if (history.is_active)
    step.traction = history.tangential;
  return compute_friction_account(step, rule);
}

} // namespace billet
