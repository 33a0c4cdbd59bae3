// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SCENE_TOOL_H
#define BILLET_SCENE_TOOL_H

#include "billet/geometry/placement.h"
#include "billet/geometry/rigid_surface.h"
#include "billet/parameters/tool.h"
#include "billet/scene/expression.h"

#include <memory>

namespace billet {

/// Rigid tool: a surface and its motion.
class Tool {
public:
  /// Builds the tool. Throws InputError if an expression is invalid.
  Tool(const parameters::Tool &parameters, const std::vector<parameters::Amplitude> &amplitudes);

  const std::string &name() const { return name_; }
  const RigidSurface &surface() const { return *surface_; }
  /// Returns the shapes of the surface's parts in words.
  const std::string &shapes() const { return shapes_; }
  /// Returns the placement of the prescribed motion plus `offset`: along the force direction
  /// [length], or, for a tool with a moment, about its axis [radians].
  Placement placement(double t, double offset = 0.) const;
  using Control = parameters::Motion::Control;
  Control control() const { return control_; }
  /// Whether a force or a moment determines its travel.
  bool is_driven() const { return control_ == Control::force || control_ == Control::moment; }
  /// Returns the unit direction of a force or a stop force.
  const dealii::Tensor<1, 3> &force_direction() const { return force_direction_; }
  /// Returns the force or moment that drives it or stops it. Throws SolutionFailure if a force is
  /// negative.
  double load(double t) const;
  double removal_time() const { return removal_time_; }
  double release_time() const { return release_time_; }
  /// Returns the axis of rotations and moments.
  const dealii::Tensor<1, 3> &rotation_axis() const { return axis_; }

private:
  std::string name_, shapes_;
  std::shared_ptr<const RigidSurface> surface_;
  std::vector<Expression> translation_;
  Expression angle_;
  dealii::Tensor<1, 3> axis_, centre_;
  Control control_;
  std::string load_origin_;
  std::unique_ptr<Expression> load_; ///< null if the motion is fully prescribed
  dealii::Tensor<1, 3> force_direction_;
  double removal_time_, release_time_;
};

} // namespace billet

#endif
