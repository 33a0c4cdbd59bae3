// SPDX-License-Identifier: LGPL-2.1-or-later
// Tools that are small beside the facets that they meet: what nodes alone do not feel, or go through.
#include "billet/contact/rigid_contact.h"

#include "billet/diagnostic_kinds.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <limits>
#include <sstream>

namespace billet {

using dealii::Tensor;

void RigidContact::measure_tool() {
  const BoundingBox &box = tool_.surface().bounding_box();
  double thickness = box.high[0] - box.low[0];
  for (unsigned int i = 1; i < 3; ++i)
    thickness = std::min(thickness, box.high[i] - box.low[i]);
  constexpr double far = 2.; // facet sizes that no node travels in a step, nor is pressed in
  const bool is_thin = thickness > 0. && std::any_of(nodes_.begin(), nodes_.end(), [&](const Node &node) {
                         return thickness < far * node.size;
                       });
  thickness_of_thin_tool_ = dealii::Utilities::MPI::max(is_thin ? thickness : 0., communicator_);
}

void RigidContact::remember_positions() {
  if (thickness_of_thin_tool_ == 0.)
    return;
  positions_on_thin_tool_.clear();
  for (const auto &state : states_)
    positions_on_thin_tool_.push_back(placement_.to_tool(state.position));
}

bool RigidContact::lets_nodes_through() const {
  if (is_removed_ || positions_on_thin_tool_.empty())
    return false;
  // Chords that cut less deep graze it.
  const double deep = 0.1 * thickness_of_thin_tool_, fine = 0.125 * thickness_of_thin_tool_;
  constexpr double middle = 0.45; // beyond it the other side is about as near
  constexpr double square = 1e-6; // cosine: what lies in one side of a square edge may come in by the other
  const RigidSurface &surface = tool_.surface();
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (states_[i].status != ContactStatus::open &&
        -(states_[i].gap + nodes_[i].lift) > middle * thickness_of_thin_tool_)
      return true;
    const Tensor<1, 3> &from = positions_on_thin_tool_[i], to = placement_.to_tool(states_[i].position);
    const Tensor<1, 3> way = to - from;
    const double length = way.norm();
    if (!(length > 0.) || states_[i].gap + lift_of(nodes_[i]) > length)
      continue;
    const auto start = surface.project(from, nodes_[i].patch), end = surface.project(to, nodes_[i].patch);
    const bool starts_inside = start.exists && start.gap < 0., ends_inside = end.exists && end.gap < 0.;
    if (starts_inside || ends_inside) {
      // From one side to the other; or, deep inside, off the end of the tool to a side: an edge cuts in.
      const double turned = start.exists && end.exists ? start.normal * end.normal : 1.;
      if (turned < -square || (turned < 0.5 && std::max(start.gap, end.gap) < -deep))
        return true;
      continue;
    }
    // From outside to outside: as far as nothing can be in between, and on from there.
    for (double done = std::max(start.gap, fine); done < length;) {
      const auto here = surface.project(from + done / length * way, nodes_[i].patch);
      if (here.exists && here.gap < -deep)
        return true;
      done += std::max(here.gap, fine);
    }
  }
  return false;
}

std::string RigidContact::describe_passage() const {
  std::ostringstream text;
  text.precision(3);
  text << "nodes of contact pair '" << pair_.name << "' go through tool '" << tool_.name() << "', which is "
       << thickness_of_thin_tool_
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
  if (unresolved_length_ == 0.)
    return {};
  std::ostringstream text;
  text.precision(3);
  text << "The tool has edges, radii or fins too small for the facets that it meets, which are up to "
       << unresolved_length_ << " long: it can enter between their points of contact";
  return {Diagnostic(diagnostic::tool_smaller_than_facets, text.str())
              .pair(pair_.name)
              .tool(tool_.name())
              .value("facet length", unresolved_length_)};
}

} // namespace billet
