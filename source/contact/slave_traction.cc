// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/slave_traction.h"

#include "billet/geometry/facet_rotation.h"

namespace billet {

using dealii::Tensor;

SlaveMotion compute_slave_motion(const FacetCorners &corners_n, const FacetCorners &corners,
                                 const std::array<double, 4> &weights, const Tensor<1, 3> &x_n,
                                 const Tensor<1, 3> &x, const double duration) {
  const Tensor<2, 3> rotation = facet_rotation(corners_n, corners);
  const Tensor<1, 3> arm_n = x_n - facet::interpolate(weights, corners_n),
                     arm = x - facet::interpolate(weights, corners);
  return {arm - rotation * arm_n, rotation, duration};
}

SlaveTraction compute_slave_traction(const Frictionless &, const double normal_stiffness,
                                     const Tensor<1, 3> &normal, const double gap) {
  const FrameTraction t = compute_frictionless_traction(normal_stiffness, gap);
  SlaveTraction result;
  result.status = t.status;
  result.pressure = t.pressure;
  result.traction = t.pressure * normal;
  result.stored_energy = 0.5 * normal_stiffness * gap * gap;
  return result;
}

} // namespace billet
