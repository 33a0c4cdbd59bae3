// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_PLACEMENT_H
#define BILLET_GEOMETRY_PLACEMENT_H

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

namespace billet {

/// Placement of a rigid body: rotation by `rotation` about `centre`, then translation by
/// `translation`, x = c
/// + d + R (X − c).
struct Placement {
  dealii::Tensor<2, 3> rotation = dealii::unit_symmetric_tensor<3>();
  dealii::Tensor<1, 3> translation;
  dealii::Tensor<1, 3> centre;
  double rotation_angle = 0.; ///< about the motion's axis [radians], for reports

  dealii::Tensor<1, 3> to_space(const dealii::Tensor<1, 3> &X) const {
    return centre + translation + rotation * (X - centre);
  }
  dealii::Tensor<1, 3> to_tool(const dealii::Tensor<1, 3> &x) const {
    return centre + dealii::transpose(rotation) * (x - centre - translation);
  }
  /// Returns the current position of the centre.
  dealii::Tensor<1, 3> moved_centre() const { return centre + translation; }
};

} // namespace billet

#endif
