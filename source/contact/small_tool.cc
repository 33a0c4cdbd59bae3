// SPDX-License-Identifier: LGPL-2.1-or-later Contact of tools that are small compared with facets, which
// nodes alone miss or pass through.
#include "billet/contact/rigid_contact.h"

#include "billet/diagnostic_kinds.h"

#include <deal.II/base/mpi.h>

#include <sstream>
#include <utility>

namespace billet {

using dealii::Tensor;

void RigidContact::remember_positions() {
  if (!thin_tool_)
    return;
  std::vector<Tensor<1, 3>> positions;
  for (const auto &state : states_)
    positions.push_back(placement_.to_tool(state.position));
  thin_tool_->remember(std::move(positions));
}

bool RigidContact::lets_nodes_through() const {
  if (is_removed_ || !thin_tool_ || !thin_tool_->knows_positions())
    return false;
  for (std::size_t i = 0; i < slaves_.nodes.size(); ++i) {
    const ToolContactState &state = states_[i];
    const double penetration =
        state.status != ContactStatus::open ? -(state.gap + slaves_.nodes[i].lift) : 0.;
    if (thin_tool_->passes(i, {placement_.to_tool(state.position), slaves_.nodes[i].patch,
                               state.gap + lift_of(slaves_.nodes[i]), penetration}))
      return true;
  }
  return false;
}

std::string RigidContact::describe_passage() const {
  std::ostringstream text;
  text.precision(3);
  text << "nodes of contact pair '" << pair_.name << "' go through tool '" << tool_.name() << "', which is "
       << thin_tool_->thickness()
       << " thick: they travel further in a step, or its penalty lets them in as deep. Try "
       << (is_explicit_ ? "a smaller 'Safety factor'" : "a smaller 'Maximum step'")
       << ", a larger 'Normal penalty', or facets as small as the tool";
  return text.str();
}

DiagnosticList RigidContact::check_step() const {
  if (!has_inertia_ || dealii::Utilities::MPI::max(has_nodes_behind_ ? 1 : 0, communicator_) == 0)
    return {};
  return {
      Diagnostic(diagnostic::nodes_behind_tool,
                 "Nodes have moved around the edge of a tool whose surface has no back; they are free there")
          .pair(pair_.name)
          .tool(tool_.name())};
}

DiagnosticList RigidContact::check_start() const {
  if (slaves_.unresolved_length == 0.)
    return {};
  std::ostringstream text;
  text.precision(3);
  text << "The tool has edges, radii or fins too small for the facets that it meets, which are up to "
       << slaves_.unresolved_length << " long: it can enter between their points of contact";
  return {Diagnostic(diagnostic::tool_smaller_than_facets, text.str())
              .pair(pair_.name)
              .tool(tool_.name())
              .value("facet length", slaves_.unresolved_length)};
}

} // namespace billet
