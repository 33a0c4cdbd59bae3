// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_TOOL_EVALUATION_H
#define BILLET_CONTACT_TOOL_EVALUATION_H

#include "billet/contact/rigid_contact_parts.h"

#include <memory>

namespace billet {

/// Limits of nodes that are about to touch a tool: nearer than this part of their facets' size, or
/// this many steps away.
constexpr double near_gap = 0.25, near_steps = 20.;

/// Loop over nodes that finds the touched points of a tool and computes tractions. Friction, scheme
/// and kind of tangents are fixed at construction, so that no node tests for them.
class ToolEvaluation {
public:
  virtual ~ToolEvaluation() = default;
  ToolEvaluation(const ToolEvaluation &) = delete;
  ToolEvaluation &operator=(const ToolEvaluation &) = delete;

  /// Sets the states of all nodes and points at these displacements (ghosted).
  virtual void run(const Vector &displacements) = 0;
  /// Does the same in schemes without a matrix.
  virtual void run(const NodalVectors &displacements) = 0;

protected:
  ToolEvaluation() = default;
};

/// Makes the evaluation. The parts must outlive it.
std::unique_ptr<ToolEvaluation> make_tool_evaluation(RigidContactParts &parts, ContactTangent kind);

} // namespace billet

#endif
