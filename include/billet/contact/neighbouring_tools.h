// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_NEIGHBOURING_TOOLS_H
#define BILLET_CONTACT_NEIGHBOURING_TOOLS_H

#include "billet/contact/tool_step.h"

#include <optional>
#include <vector>

namespace billet {

/// The other tools that a body may touch. Where one of them continues a tool's surface, pressure
/// does not fade beyond the edge, and no node misses it.
class NeighbouringTools {
public:
  /// Adds a tool, which must outlive this object.
  void add(const ToolStep &other) { others_.push_back(&other); }

  /// Whether one of the tools has a surface nearer than `near` at this position. If given, `facing`
  /// is the direction (in space) that it must face: a tool that presses the other side of a sheet
  /// does not count.
  bool is_near(const dealii::Tensor<1, 3> &position, double near,
               const std::optional<dealii::Tensor<1, 3>> &facing = {}) const;

private:
  std::vector<const ToolStep *> others_;
};

} // namespace billet

#endif
