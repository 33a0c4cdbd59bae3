// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_TOOL_DRIVE_H
#define BILLET_CONTACT_TOOL_DRIVE_H

#include "billet/contact/tool_springs.h"
#include "billet/contact/tool_tangents.h"

namespace billet {

/// A rigid motion of a tool: x moves by translation + rotation × (x − moved centre).
struct ToolRate {
  dealii::Tensor<1, 3> translation, rotation;
};

/// Response of contact to motions of its tool, at the last update(). Values are this rank's.
class ToolDrive {
public:
  /// The parts must outlive this object.
  explicit ToolDrive(const RigidContactParts &parts) : parts_(parts) {}

  /// Adds the force of the tool on touching nodes that do not follow its motion to `after`, to
  /// first order.
  void add_push(const Placement &after, Vector &forces) const;

  /// Adds derivatives of the residual R and of the power of the tool, P = Σ F·v, for a rate of the
  /// tool. The tool translates, or rotates about a fixed centre. Adds ∂R/∂s to `column` and ∂P/∂u
  /// to `row` (additive vectors), and returns ∂P/∂s. They follow from K = −∂F_c/∂u and the
  /// invariance of F_c under rigid motions of node and tool together. With v_b the rate at node b
  /// and ω its rotation,
  ///   ∂F_a/∂s = ω × F_a + Σ_b K_ab v_b,   ∂P/∂u_b = −Σ_a v_a·K_ab + ω × F_b·,
  ///   ∂P/∂s = Σ_a v_a·∂F_a/∂s.
  double add_derivatives(const ToolTangents &tangents, const ToolRate &rate, Vector &column,
                         Vector &row) const;

  /// Measures of full sliding at a rate of the tool. `touching` and `slipping` are Σ A p |v_t| of
  /// the nodes that touch, or slip, v_t the rate along the tool's surface. `power_of_pressure` is
  /// the power of the pressure on the body, Σ A p v_n.
  struct Sliding {
    double touching = 0., slipping = 0., power_of_pressure = 0.;
  };
  Sliding measure_sliding(const ToolRate &rate) const;

  /// Returns the distance [length] that the tool must move along `direction` (unit) to touch a
  /// node. It is infinite if the tool cannot touch any.
  double distance_to_touch(const dealii::Tensor<1, 3> &direction) const;

private:
  dealii::Tensor<1, 3> rate_at(const dealii::Tensor<1, 3> &position, const ToolRate &rate) const {
    return rate.translation +
           dealii::cross_product_3d(rate.rotation, position - parts_.step.placement.moved_centre());
  }

  const RigidContactParts &parts_;
};

} // namespace billet

#endif
