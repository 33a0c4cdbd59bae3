// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/tool_checks.h"

#include "billet/contact/restless_report.h"
#include "billet/diagnostic_kinds.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace billet {

using dealii::Tensor;

bool ToolChecks::lets_nodes_through() const {
  if (parts_.step.is_removed || !parts_.thin_tool || !parts_.thin_tool->knows_positions())
    return false;
  for (std::size_t i = 0; i < parts_.slaves.nodes.size(); ++i) {
    const ToolContactState &state = parts_.states[i];
    const ContactPoint &node = parts_.slaves.nodes[i];
    const double penetration =
        state.status != ContactStatus::open ? -(state.gap + node.multiplier_offset) : 0.;
    if (parts_.thin_tool->passes(i, {parts_.step.placement.to_tool(state.position), node.patch,
                                     state.gap + parts_.step.gap_offset(node), penetration}))
      return true;
  }
  return false;
}

Explanation ToolChecks::describe_passage() const {
  std::ostringstream text;
  text.precision(3);
  text << "nodes of contact pair '" << parts_.pair.name << "' go through tool '" << parts_.tool.name()
       << "', which is " << parts_.thin_tool->thickness()
       << " thick: they travel further in a step, or its penalty lets them in as deep";
  return {text.str(), std::string("Try a smaller ") +
                          (parts_.is_explicit ? "'Safety factor'" : "'Maximum step'") +
                          ", a larger 'Normal penalty', or facets as small as the tool"};
}

std::string ToolChecks::describe_obstacle() const {
  return "nodes of contact pair '" + parts_.pair.name + "' would go through tool '" + parts_.tool.name() +
         "'";
}

DiagnosticList ToolChecks::check_step() const {
  if (!parts_.has_inertia ||
      dealii::Utilities::MPI::max(parts_.missed_edge.has_nodes_behind() ? 1 : 0, parts_.communicator) == 0)
    return {};
  return {
      Diagnostic(diagnostic::nodes_behind_tool,
                 "Nodes have moved around the edge of a tool whose surface has no back; they are free there")
          .pair(parts_.pair.name)
          .tool(parts_.tool.name())};
}

DiagnosticList ToolChecks::check_start() const {
  const double length = parts_.slaves.unresolved_length;
  if (length == 0.)
    return {};
  std::ostringstream text;
  text.precision(3);
  text << "The tool has edges, radii or fins too small for the facets that it meets, which are up to "
       << length << " long: it can enter between their points of contact";
  return {Diagnostic(diagnostic::tool_smaller_than_facets, text.str())
              .pair(parts_.pair.name)
              .tool(parts_.tool.name())
              .value("facet length", length)};
}

Explanation ToolChecks::describe_restless() const {
  std::vector<RestlessNode> nodes;
  bool is_at_edge = false;
  parts_.restless.visit([&](const std::size_t i, const unsigned int n_changes) {
    nodes.push_back({parts_.states[i].position, n_changes});
    is_at_edge = is_at_edge || is_at_sharp_edge(i);
  });
  const std::string what =
      describe_restless_nodes(nodes, parts_.pair.name, "status or surface", parts_.communicator);
  if (what.empty())
    return {};
  is_at_edge = dealii::Utilities::MPI::max(is_at_edge ? 1 : 0, parts_.communicator) != 0;
  return {what, is_at_edge ? "Try a fillet at the sharp edge of the tool, or a lower penalty"
                           : "Try smaller bricks where the tool is curved, or a lower penalty"};
}

bool ToolChecks::is_at_sharp_edge(const std::size_t i) const {
  constexpr double near = 0.5, sharp = 0.7; // facet sizes; cosine of 45 degrees
  const Tensor<1, 3> &position = parts_.states[i].position;
  const ContactPoint &node = parts_.slaves.nodes[i];
  if (parts_.step.is_removed || !std::isfinite(position.norm()))
    return false;
  const RigidSurface &surface = parts_.step.surface;
  const Tensor<1, 3> x = parts_.step.placement.to_tool(position);
  const auto here = surface.project(x, node.patch);
  if (!here.exists || std::abs(here.gap) > node.size)
    return false;
  const Frame along = Frame::from_normal(here.normal);
  const std::array<Tensor<1, 3>, 4> ways{along.q, -along.q, along.r, -along.r};
  return std::any_of(ways.begin(), ways.end(), [&](const Tensor<1, 3> &way) {
    const auto there = surface.project(x + near * node.size * way, node.patch);
    return there.exists && there.normal * here.normal < sharp;
  });
}

bool ToolChecks::has_node_on_edge(const Tensor<1, 3> &position) const {
  constexpr double same = 1e-8, near = 0.1; // facet sizes
  if (parts_.step.is_removed)
    return false;
  const RigidSurface &surface = parts_.step.surface;
  for (std::size_t i = 0; i < parts_.slaves.nodes.size(); ++i) {
    const ContactPoint &node = parts_.slaves.nodes[i];
    if ((parts_.states[i].position - position).norm() > same * node.size)
      continue;
    const Tensor<1, 3> x = parts_.step.placement.to_tool(position);
    const auto here = surface.project(x, node.patch);
    if (parts_.states[i].share < 1.)
      return true;
    if (std::abs(here.gap) > node.size)
      continue;
    const Frame along = Frame::from_normal(here.normal);
    for (const auto &way : {along.q, -along.q, along.r, -along.r})
      if (surface.project(x + near * node.size * way, node.patch).exists != here.exists)
        return true;
  }
  return false;
}

} // namespace billet
