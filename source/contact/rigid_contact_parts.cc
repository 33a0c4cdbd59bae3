// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/rigid_contact_parts.h"

#include "billet/contact/facing_gaps.h"
#include "billet/contact/spring_energy.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace billet {

using dealii::Tensor;

RigidContactParts::RigidContactParts(const Scene &scene, const ContactPair &of_pair,
                                     const Discretization &of_discretization)
    : pair(of_pair), tool(scene.tools()[pair.tool]), discretization(of_discretization),
      communicator(discretization.communicator()), has_inertia(scene.parameters().scheme().has_inertia),
      is_explicit(!scene.parameters().scheme().has_matrix),
      slaves(pair, tool, discretization, scene.bodies()[pair.body].young_modulus,
             has_inertia && !is_explicit ? 0. : touching_gap),
      states(slaves.nodes.size()), step(tool.surface(), tool.placement(0.)), missed_edge(step, neighbours) {
  if (!has_inertia) {
    const std::set<DofIndex> fixed = collect_fixed_nodes(scene, discretization);
    for (auto &node : slaves.nodes)
      node.is_fixed = fixed.count(node.dofs[0]) > 0;
  }
  if (pair.has_friction()) // multipliers do not stretch springs
    friction.emplace(*pair.friction, !pair.is_augmented(), slaves.nodes.size(), step, pressures);
  const BoundingBox &box = tool.surface().bounding_box();
  double tool_size = 0.;
  for (unsigned int i = 0; i < 3; ++i)
    for (const double end : {box.low[i], box.high[i]})
      tool_size = std::max(tool_size, std::isfinite(end) ? std::abs(end) : 0.);
  for (std::size_t i = 0; i < slaves.nodes.size(); ++i)
    states[i].position = slaves.nodes[i].reference;
  for (const auto &projection : start_gaps()) {
    const double curvature = projection.turning.norm();
    if (curvature > 0.)
      tool_reach = std::max(tool_reach, std::min(1. / curvature, tool_size));
  }
  start_friction();
  double max_size = 0.;
  for (const auto &node : slaves.nodes)
    max_size = std::max(max_size, node.size);
  thin_tool = ThinToolWatch::make(tool.surface(), dealii::Utilities::MPI::max(max_size, communicator));
  if (is_explicit && !pair.input->penalty.is_given && thin_tool)
    slaves.harden_springs(thin_tool->thickness());
  for (auto &node : slaves.nodes)
    node.given = node.stiffness;
  record_positions();
  record_pressures();
  memory.set(slaves.nodes.size() * (sizeof(ContactPoint) + sizeof(ToolContactState)) +
             slaves.facets.size() * sizeof(ContactFacet));
}

std::vector<RigidSurface::Projection> RigidContactParts::start_gaps() {
  std::vector<RigidSurface::Projection> projections;
  for (std::size_t i = 0; i < slaves.nodes.size(); ++i) {
    ContactPoint &node = slaves.nodes[i];
    projections.push_back(tool.surface().project(step.placement.to_tool(states[i].position)));
    node.patch = projections.back().patch;
    node.initial_penetration = allows(projections.back()) ? -projections.back().gap : 0.;
  }
  if (changes_gaps(pair.overlap))
    carry_gaps(projections);
  for (std::size_t i = 0; i < slaves.nodes.size(); ++i)
    states[i].gap = slaves.nodes[i].gap_n = projections[i].gap - step.gap_offset(slaves.nodes[i]);
  return projections;
}

void RigidContactParts::carry_gaps(const std::vector<RigidSurface::Projection> &projections) {
  const auto starts_in_contact = [&](const std::size_t i) {
    return projections[i].exists && projections[i].gap <= pair.overlap.closed_gap;
  };
  FacingGaps facing;
  for (std::size_t i = 0; i < projections.size(); ++i)
    if (starts_in_contact(i))
      facing.add(-projections[i].normal,
                 pair.overlap.is_allowed ? projections[i].gap : std::max(projections[i].gap, 0.));
  facing.reduce(communicator);
  std::vector<Tensor<1, 3>> positions;
  for (const auto &state : states)
    positions.push_back(step.placement.to_tool(state.position));
  const std::vector<Tensor<1, 3>> outward = slaves.sum_normals(positions, discretization);
  for (std::size_t i = 0; i < projections.size(); ++i)
    if (!starts_in_contact(i))
      slaves.nodes[i].initial_penetration = facing.carried_penetration(
          outward[i], projections[i].exists ? projections[i].gap : FacingGaps::unknown);
}

bool RigidContactParts::allows(const RigidSurface::Projection &projection) const {
  return projection.exists &&
         ((pair.overlap.is_allowed && projection.gap < 0.) || pair.overlap.closes(projection.gap));
}

void RigidContactParts::count_changes() {
  std::vector<std::uint64_t> changing(states.size());
  for (std::size_t i = 0; i < states.size(); ++i)
    if (states[i].pressure > 0.)
      changing[i] = 4 * std::uint64_t{states[i].patch} + static_cast<std::uint64_t>(states[i].status) + 1;
  restless.count(std::move(changing));
}

void RigidContactParts::remove_tool() {
  step.is_removed = true;
  for (auto &state : states)
    state = ToolContactState();
  if (friction)
    friction->clear();
}

void RigidContactParts::commit() {
  for (std::size_t i = 0; i < slaves.nodes.size(); ++i)
    slaves.nodes[i].gap_n = states[i].gap;
  missed_edge.commit(slaves.nodes, states);
  for (std::size_t i = 0; i < slaves.nodes.size(); ++i) {
    ContactPoint &node = slaves.nodes[i];
    if (states[i].status == ContactStatus::open) { // it returns without an offset
      node.gap_n += node.multiplier_offset;
      node.multiplier_offset = 0.;
      if (fading_gaps)
        leave_depth(i);
      // A node that has left rests no more: a stiffness without a force would slow its return.
      if (node.gap_n > 0. && node.gap_n <= node.touching_gap)
        node.gap_n = std::nextafter(node.touching_gap, node.size);
    }
    node.multiplier_offset_n = node.multiplier_offset;
  }
  if (friction)
    friction->commit();
  record_positions();
  if (friction && !is_explicit)
    for (auto &facet : slaves.facets) {
      const CornerStates corners = states_of(facet);
      facet.friction_areas =
          any_touches(corners) ? compute_projected_areas(corners, false).areas : std::array<double, 4>{};
    }
  record_pressures();
  if (is_explicit) // only after the springs' energy is released
    for (auto &facet : slaves.facets)
      for (unsigned int a = 0; a < 4; ++a)
        if (states[facet.nodes[a]].status == ContactStatus::open)
          facet.shallow_areas[a] = SpringEnergy::no_area;
}

void RigidContactParts::begin(const ContactStep &at, const std::vector<Tensor<1, 3>> &displacements) {
  const Placement &placement = at.tools_at_start[pair.tool];
  step.placement_n = step.placement = placement;
  step.allowed_part = allowed_part(at.start);
  for (auto &divided : slaves.divided)
    divided.may_touch = true;
  for (std::size_t i = 0; i < slaves.nodes.size(); ++i) {
    const Tensor<1, 3> position = slaves.nodes[i].reference + slaves.at(i, [&](const std::size_t parent) {
      return displacements[parent];
    });
    states[i] = ToolContactState();
    states[i].position = position;
    slaves.nodes[i].multiplier_offset = slaves.nodes[i].multiplier_offset_n = 0.;
    slaves.nodes[i].is_behind = false;
  }
  start_gaps();
  start_friction();
  record_positions();
  record_pressures();
  for (auto &facet : slaves.facets) {
    facet.shallow_areas.fill(SpringEnergy::no_area);
    facet.friction_areas.fill(0.);
  }
}

void RigidContactParts::keep_gaps() {
  constexpr double rounding = 1e-9; // of facets
  for (std::size_t i = 0; i < slaves.nodes.size(); ++i) {
    ContactPoint &node = slaves.nodes[i];
    const double gap = states[i].gap - node.multiplier_offset, excess = std::min(node.gap_n, 0.) - gap;
    node.initial_penetration = excess > rounding * node.size ? excess : 0.;
  }
}

void RigidContactParts::fade_gaps(const FadingGaps &gaps, const bool is_finer) {
  const bool fades = !has_inertia || is_explicit;
  if (is_finer && !fades) // a raised penalty allows depths there that must not fade
    return;
  if (is_finer)
    keep_gaps();
  else if (!fading_gaps || fading_gaps->fade() == fades) // there are none, or they go on as before
    return;
  else
    for (ContactPoint &node : slaves.nodes)
      node.initial_penetration *= step.allowed_part;
  step.allowed_part_n = step.allowed_part = 1.;
  fading_gaps = {gaps.begin, fades ? gaps.end : std::numeric_limits<double>::infinity()};
}

void RigidContactParts::leave_depth(const std::size_t i) {
  ContactPoint &node = slaves.nodes[i];
  const double part = step.allowed_part;
  const double left = part > 0. ? std::min(node.initial_penetration, std::max(0., states[i].gap) / part)
                                : node.initial_penetration;
  node.initial_penetration -= left;
  node.gap_n -= part * left;
}

void RigidContactParts::start_friction() {
  if (!friction)
    return;
  for (std::size_t i = 0; i < states.size(); ++i)
    friction->start(i, step.placement.to_tool(states[i].position));
  friction->commit();
}

void RigidContactParts::record_positions() {
  if (!thin_tool)
    return;
  std::vector<Tensor<1, 3>> positions;
  for (const auto &state : states)
    positions.push_back(step.placement.to_tool(state.position));
  thin_tool->remember(std::move(positions));
}

void RigidContactParts::record_pressures() {
  step.allowed_part_n = step.allowed_part;
  if (!is_explicit)
    pressures.record(states, slaves.nodes, step.placement);
}

} // namespace billet
