// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/tool_node.h"

#include <algorithm>
#include <limits>

namespace billet {

using dealii::Tensor;

template <class Law, bool has_inertia, bool is_exact>
ToolContactState ToolNode<Law, has_inertia, is_exact>::evaluate(const std::size_t i,
                                                                const Tensor<1, 3> &position,
                                                                ToolFriction::History *history) const {
  const ContactPoint &node = parts_.slaves.nodes[i];
  const RigidSurface &surface = parts_.step.surface;
  const Placement &placement = parts_.step.placement;
  ToolContactState state;
  state.position = position;
  const Tensor<1, 3> on_tool = placement.to_tool(position);
  auto projection = surface.project(on_tool, node.patch);
  const double width = fading_width * node.size;
  if constexpr (has_inertia) {
    state.is_behind = parts_.missed_edge.is_missed_by(node, position, on_tool, projection);
    state.is_passed = state.is_behind && projection.exists;
  }
  const bool fades = !state.is_behind && !projection.exists && projection.beyond < width &&
                     !parts_.neighbours.is_near(position, node.size, placement.rotation * projection.normal);
  EdgeFading fading{};
  if (fades) {
    RigidSurface::EdgePoint edge_point = surface.edge_point(on_tool, projection.patch, width);
    projection = {true, edge_point.normal, edge_point.gap, edge_point.turning, projection.patch};
    edge_point.normal = placement.rotation * edge_point.normal;
    edge_point.outward = placement.rotation * edge_point.outward;
    edge_point.spreading = placement.rotation * edge_point.spreading * dealii::transpose(placement.rotation);
    edge_point.turning = placement.rotation * edge_point.turning * dealii::transpose(placement.rotation);
    fading =
        compute_edge_fading(edge_point, width, node.spring(), edge_point.gap - parts_.step.gap_offset(node));
    state.share = fading.share;
    state.fading_stiffness = fading.stiffness;
  }
  state.gap = projection.gap - parts_.step.gap_offset(node);
  if constexpr (has_inertia)
    if (state.is_passed) // distance to the front
      state.gap = -state.gap;
  state.patch = projection.patch;
  // A node that starts on the tool counts as touching: its stiffness may be the only constraint of
  // the body. With inertia the body needs no constraint, and a stiffness without a force would
  // mislead Newton's method at lift-off. The node then counts only while its lift-off is within
  // round-off.
  const double on_it = node.touching_gap;
  constexpr double of_projection = 1e-13, of_position = 4. * std::numeric_limits<double>::epsilon();
  const double rounding = of_projection * node.size + of_position * position.norm();
  const bool rests = node.gap_n <= on_it && state.gap <= std::min(on_it, node.gap_n + rounding);
  const bool touches = projection.exists && !state.is_behind && (state.gap < 0. || rests);
  if (touches) {
    state.normal = placement.rotation * projection.normal;
    state.turning = placement.rotation * projection.turning * dealii::transpose(placement.rotation);
  }
  if constexpr (has_friction) {
    if (touches)
      parts_.friction->template press<is_exact>(i, node, kind_, fades ? &fading : nullptr, state, *history);
    else
      parts_.friction->release(i, node, projection.normal, state, *history);
    history->tool_position = on_tool;
  } else if (touches) {
    const double penalty = state.share * node.spring().secant(std::max(-state.gap, 0.));
    const FrameTraction t = compute_frictionless_traction(penalty, state.gap);
    state.status = t.status;
    state.pressure = t.pressure;
    state.traction = t.pressure * state.normal;
    state.tangent = penalty * dealii::outer_product(state.normal, state.normal);
    // Across a concave edge the stiffness is as large as along the normal, and symmetric: Newton's
    // method needs it.
    if (is_exact || is_in_concave_edge(projection.gap, projection.turning))
      state.tangent -= t.pressure * state.turning;
  }
  if (fades && touches) { // all except friction is pressure
    state.pressure = (state.pressure * state.normal + fading.push).norm();
    state.traction += fading.push;
    state.tangent += fading.tangent;
  }
  return state;
}

template class ToolNode<Frictionless, false, false>;
template class ToolNode<Frictionless, false, true>;
template class ToolNode<Frictionless, true, false>;
template class ToolNode<Frictionless, true, true>;
template class ToolNode<FrictionLaw, false, false>;
template class ToolNode<FrictionLaw, false, true>;
template class ToolNode<FrictionLaw, true, false>;
template class ToolNode<FrictionLaw, true, true>;

} // namespace billet
