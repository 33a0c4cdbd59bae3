// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/tool_evaluation.h"

#include "billet/contact/tool_node.h"

#include <algorithm>
#include <limits>

namespace billet {

using dealii::Tensor;

namespace {

template <class Node> class ToolEvaluationOf final : public ToolEvaluation {
public:
  ToolEvaluationOf(RigidContactParts &parts, const Node &node)
      : parts_(parts), slaves_(parts.slaves), states_(parts.states), node_(node) {}

  void run(const Vector &displacements) override {
    run_at([&](const std::size_t i) { return slaves_.nodes[i].displacement_in(displacements); });
  }
  void run(const NodalVectors &displacements) override {
    run_at([&](const std::size_t i) { return parts_.bound.vector_of(i, displacements); });
  }

private:
  template <class DisplacementOf> void run_at(const DisplacementOf &displacement_of) {
    if (parts_.step.is_removed)
      return;
    Usage::count(Capability::contact, slaves_.nodes.size());
    if constexpr (Node::has_friction)
      Usage::count_if(slaves_.nodes.size() > 0, Capability::friction, slaves_.nodes.size());
    for (std::size_t i = 0; i < slaves_.n_mesh_nodes; ++i)
      set_state(i, slaves_.nodes[i].reference + displacement_of(i));
    for (auto &divided : slaves_.divided) {
      if (is_far(divided))
        continue;
      divided.may_touch = false;
      for (std::size_t i = divided.first_point; i < divided.first_point + divided.n_points; ++i) {
        set_state(i, point_position(i));
        divided.may_touch = divided.may_touch || states_[i].status != ContactStatus::open;
      }
    }
  }

  void set_state(const std::size_t i, const Tensor<1, 3> &position) {
    if constexpr (Node::has_friction)
      states_[i] = node_.evaluate(i, position, &(*parts_.friction)[i]);
    else
      states_[i] = node_.evaluate(i, position, nullptr);
    slaves_.nodes[i].patch = states_[i].patch;
  }

  Tensor<1, 3> point_position(const std::size_t i) const {
    return slaves_.at(i, [&](const std::size_t parent) { return states_[parent].position; });
  }

  /// Whether a divided facet is too far from the tool for its interior points to touch. If so,
  /// releases them.
  bool is_far(DividedFacet &divided);

  RigidContactParts &parts_;
  SlaveSurface &slaves_;
  std::vector<ToolContactState> &states_;
  const Node node_;
};

template <class Node> bool ToolEvaluationOf<Node>::is_far(DividedFacet &divided) {
  if (divided.may_touch)
    return false;
  // Gaps are distances: no gap in the facet is less than that of the nearest corner minus the
  // distance to it.
  std::array<const ToolContactState *, 4> corners{};
  double minimum = std::numeric_limits<double>::infinity(), approach = 0., size = 0.;
  for (unsigned int a = 0; a < 4; ++a) {
    const ContactPoint &node = slaves_.nodes[divided.corners[a]];
    corners[a] = &states_[divided.corners[a]];
    if (corners[a]->is_behind)
      return false;
    minimum = std::min(minimum, corners[a]->gap);
    approach = std::max(approach, node.gap_n - corners[a]->gap);
    size = std::max(size, node.size);
  }
  const double way = 0.5 * std::max((corners[3]->position - corners[0]->position).norm(),
                                    (corners[2]->position - corners[1]->position).norm());
  const double gap = minimum - way;
  if (!(gap > near_gap * size + near_steps * approach))
    return false;
  for (std::size_t i = divided.first_point; i < divided.first_point + divided.n_points; ++i) {
    ToolContactState &state = states_[i];
    state.position = point_position(i);
    state.gap = gap;
    if constexpr (Node::has_friction) // it was also open before
      (*parts_.friction)[i].tool_position = parts_.step.placement.to_tool(state.position);
  }
  return true;
}

} // namespace

std::unique_ptr<ToolEvaluation> make_tool_evaluation(RigidContactParts &parts, const ContactTangent kind) {
  std::unique_ptr<ToolEvaluation> result;
  visit_tool_node(parts, kind, [&](const auto &node) {
    using Node = std::decay_t<decltype(node)>;
    result = std::make_unique<ToolEvaluationOf<Node>>(parts, node);
  });
  return result;
}

} // namespace billet
