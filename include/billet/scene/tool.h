// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_TOOL_H
#define BILLET_SCENE_TOOL_H

#include "billet/geometry/placement.h"
#include "billet/geometry/rigid_surface.h"
#include "billet/parameters/tool.h"
#include "billet/scene/expression.h"

#include <memory>

namespace billet {

/// A rigid surface and its motion.
class Tool {
public:
  /// Throws InputError where an expression does not make sense.
  Tool(const parameters::Tool &parameters, const std::vector<parameters::Amplitude> &amplitudes);

  const std::string &name() const { return name_; }
  const RigidSurface &surface() const { return *surface_; }
  /// In words.
  const std::string &shapes() const { return shapes_; }
  Placement placement(double t) const;
  /// Of the motion; moments and turns are about it.
  const dealii::Tensor<1, 3> &rotation_axis() const { return axis_; }

private:
  std::string name_, shapes_;
  std::shared_ptr<const RigidSurface> surface_;
  std::vector<Expression> translation_;
  Expression angle_;
  dealii::Tensor<1, 3> axis_, centre_;
};

} // namespace billet

#endif
