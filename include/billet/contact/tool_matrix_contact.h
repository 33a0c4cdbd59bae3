// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_TOOL_MATRIX_CONTACT_H
#define BILLET_CONTACT_TOOL_MATRIX_CONTACT_H

#include "billet/contact/matrix_contact.h"
#include "billet/contact/tool_evaluation.h"
#include "billet/contact/tool_tangents.h"

#include <memory>

namespace billet {

/// Contact with a tool in schemes with a matrix.
class ToolMatrixContact final : public MatrixContact {
public:
  /// The parts must outlive this object.
  ToolMatrixContact(RigidContactParts &parts, ContactTangent tangent);

  void update(const Vector &displacements) override;
  void add_forces(Vector &residual) const override;
  void set_tangent(ContactTangent tangent) override;
  void add_tangent(const TangentSystem &system) const override { tangents_->add(system); }
  double find_free_part(const ContactPath &path) const override;
  void begin(const ContactStep &step, const Vector &displacements) override;

  const ToolTangents &tangents() const { return *tangents_; }

private:
  RigidContactParts &parts_;
  std::unique_ptr<ToolEvaluation> evaluation_;
  std::unique_ptr<ToolTangents> tangents_;
};

} // namespace billet

#endif
