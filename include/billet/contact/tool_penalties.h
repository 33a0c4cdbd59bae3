// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_TOOL_PENALTIES_H
#define BILLET_CONTACT_TOOL_PENALTIES_H

#include "billet/contact/contact_penalties.h"
#include "billet/contact/rigid_contact_parts.h"

namespace billet {

/// Penalties of contact with a tool, and its augmented Lagrangian by Uzawa's method: a multiplier
/// acts as an offset λ/k of its node's gap. The spring of a sticking node starts from its augmented
/// traction.
class ToolPenalties final : public ContactPenalties {
public:
  /// The parts must outlive this object.
  explicit ToolPenalties(RigidContactParts &parts)
      : ContactPenalties(parts.pair.penetration_tolerance.value_or(0.),
                         {parts.slaves.max_stiffening, parts.slaves.max_tangential_stiffening},
                         parts.slaves.is_sheet),
        parts_(parts) {}

  void augment() override;
  void take_back_augmentation() override;
  ContactSprings compute_springs() const override;
  void scale(double normal, double tangential) override;
  void scale_under_load(double normal, double tangential) override;
  /// Reduces penalties and keeps tractions: multipliers take over what springs lose. At the start
  /// of a step, after update().
  void lower_under_load(double normal, double tangential);
  double stiffening() const override { return stiffening_; }
  double tangential_stiffening() const override { return tangential_stiffening_; }
  double max_spring() const override;

private:
  double augmentation_gap() const override;
  /// Returns the elastic slip of each node; 0 without friction [length].
  std::vector<double> elastic_slips() const;

  RigidContactParts &parts_;
  double stiffening_ = 1., tangential_stiffening_ = 1.;
  HeldMemory memory_{Capability::augmentation};
};

} // namespace billet

#endif
