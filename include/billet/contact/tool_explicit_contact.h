// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_TOOL_EXPLICIT_CONTACT_H
#define BILLET_CONTACT_TOOL_EXPLICIT_CONTACT_H

#include "billet/contact/explicit_contact.h"
#include "billet/contact/tool_bounds.h"
#include "billet/contact/tool_evaluation.h"
#include "billet/contact/tool_forces.h"

#include <memory>

namespace billet {

/// Contact with a tool in schemes without a matrix.
class ToolExplicitContact final : public ExplicitContact {
public:
  /// Finds the nodes of the pair among those of the rank. The parts must outlive this object.
  ToolExplicitContact(RigidContactParts &parts, const LocalNodes &nodes);

  void update(const NodalVectors &displacements) override { evaluation_->run(displacements); }
  /// Without friction F_c = −∂Π/∂u, Π the stored energy, including the forces due to changes of
  /// area.
  ContactLoad add_forces(NodalVectors &forces, NodalVectors &bounds) override {
    return forces_.add(forces, bounds);
  }
  void add_crossings(Crossings &crossings) const override { bounds_.add_crossings(crossings); }
  void add_start_crossings(Crossings &crossings, const NodalVectors &velocities, double step) const override {
    bounds_.add_start_crossings(crossings, velocities, step);
  }
  double stiffness_against_tool() const override { return bounds_.stiffness_against_tool(); }
  void begin(const ContactStep &step, const NodalVectors &displacements) override;

private:
  RigidContactParts &parts_;
  std::unique_ptr<ToolEvaluation> evaluation_;
  ToolBounds bounds_;
  ToolForces forces_;
};

} // namespace billet

#endif
