// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_TOOL_TANGENTS_H
#define BILLET_CONTACT_TOOL_TANGENTS_H

#include "billet/contact/rigid_contact_parts.h"

#include <deal.II/lac/full_matrix.h>

#include <functional>
#include <memory>

namespace billet {

/// Tangents of facets on a tool. The kind of tangents, friction and scheme are fixed at
/// construction, so that no facet and no node tests for them.
class ToolTangents {
public:
  virtual ~ToolTangents() = default;
  ToolTangents(const ToolTangents &) = delete;
  ToolTangents &operator=(const ToolTangents &) = delete;

  /// Function that receives a facet and −∂F_c/∂u of its nodes, 12 × 12 [force/length].
  using Visit = std::function<void(const ContactFacet &, const dealii::FullMatrix<double> &)>;
  /// Visits those of the facets begin, ..., end − 1 that touch.
  virtual void visit(std::size_t begin, std::size_t end, const Visit &visit) const = 0;

  /// Adds −∂F_c/∂u of the nodes of the mesh. The forces on points inside a divided facet are those
  /// of its corners.
  void add(const TangentSystem &system) const;

protected:
  explicit ToolTangents(const RigidContactParts &parts) : parts_(parts) {}

  const RigidContactParts &parts_;

private:
  void add_divided(const DividedFacet &divided, const TangentSystem &system) const;
};

/// Makes the tangents. The parts must outlive them.
std::unique_ptr<ToolTangents> make_tool_tangents(const RigidContactParts &parts, ContactTangent kind);

} // namespace billet

#endif
