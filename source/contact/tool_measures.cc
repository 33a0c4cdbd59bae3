// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/tool_measures.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {

/// Returns the maximum curvature of the surface that a node touches; a concave edge has none that
/// facets must follow.
double max_curvature(const ToolContactState &state) {
  if (is_in_concave_edge(state.gap, state.turning))
    return 0.;
  const auto principal = dealii::eigenvalues(dealii::symmetrize(state.turning));
  return std::max(std::abs(principal[0]), std::abs(principal[2]));
}

} // namespace

Penetration ToolMeasures::penetration() const {
  Penetration deepest;
  parts_.visit_penetrations(
      [&](const ContactPoint &node, const double depth) { deepest.add(depth, node.size); });
  return deepest;
}

double ToolMeasures::excessive_penetration() const {
  double maximum = 0.;
  parts_.visit_penetrations(
      [&](const ContactPoint &node, const double depth) { maximum = std::max(maximum, depth / node.reach); });
  return maximum;
}

double ToolMeasures::closing_of_new_contacts() const {
  double maximum = 0.;
  if (!parts_.pressures.is_known())
    return maximum;
  for (std::size_t i = 0; i < parts_.states.size(); ++i) {
    const ToolContactState &state = parts_.states[i];
    const PressureRecord::Entry &before = parts_.pressures[i];
    if (state.pressure > 0. && !(before.pressure > 0.))
      maximum = std::max(maximum, state.normal *
                                      (parts_.step.placement.to_space(before.position) - state.position) /
                                      parts_.slaves.nodes[i].size);
  }
  return maximum;
}

double ToolMeasures::max_sliding(const double expected) const {
  double maximum = 0.;
  if (!parts_.pressures.is_known() || parts_.step.is_removed)
    return maximum;
  for (std::size_t i = 0; i < parts_.states.size(); ++i)
    if (const PressureRecord::Entry &before = parts_.pressures[i]; before.pressure > 0.)
      maximum = std::max(
          maximum,
          ((parts_.step.placement.to_space(before.position) - parts_.states[i].position).norm() - expected) /
              parts_.slaves.nodes[i].size);
  return maximum;
}

FrictionUse ToolMeasures::friction_use() const {
  FrictionUse use;
  if (parts_.pair.has_friction())
    visit_areas(parts_, [&](const unsigned int i, const double area) {
      const ToolContactState &state = parts_.states[i];
      use.add(*parts_.pair.friction, state.status, state.normal, area, state.traction);
    });
  return use;
}

bool ToolMeasures::has_touching_nodes() const {
  return std::any_of(parts_.states.begin(), parts_.states.end(),
                     [](const ToolContactState &state) { return state.status != ContactStatus::open; });
}

std::vector<SlaveForce> ToolMeasures::slave_forces() const {
  std::vector<SlaveForce> result(parts_.states.size());
  for (std::size_t i = 0; i < parts_.states.size(); ++i)
    result[i].status = parts_.states[i].status;
  visit_areas(parts_, [&](const unsigned int i, const double area) {
    result[i].force += area * parts_.states[i].traction;
  });
  return result;
}

void ToolMeasures::add_resistances(const std::size_t body, std::vector<Resistance> &resistances) const {
  if (body != parts_.pair.body)
    return;
  for (const auto &state : parts_.states)
    if (state.status != ContactStatus::open)
      add_contact(state.position, state.normal, parts_.tool.control() == Tool::Control::force,
                  parts_.pair.has_friction(), resistances);
}

void ToolMeasures::visit_supporting(const VisitSupporting &visit) const {
  choose_friction(parts_.pair.friction, [&](const auto &law) {
    for (const auto &state : parts_.states)
      if (state.status != ContactStatus::open)
        visit(make_supporting_point(state.position, state.normal, law, state.status, state.traction),
              parts_.pair.body, parts_.pair.body);
  });
}

std::size_t ToolMeasures::history_size() const {
  return ((parts_.friction ? parts_.friction->size() : 0) + parts_.slaves.nodes.size() * sizeof(double)) /
         sizeof(double);
}

std::vector<ContactNodeReport> ToolMeasures::report() const {
  std::vector<ContactNodeReport> reports = report_nodes();
  with_tool_springs(parts_, [&](const auto &springs) { add_areas(springs, reports); });
  follow_sides(reports);
  if (!parts_.slaves.divided.empty())
    with_tool_springs(parts_, [&](const auto &springs) { average_over_points(springs, reports); });
  return reports;
}

StartGaps ToolMeasures::start_gaps() const {
  StartGaps gaps;
  const Placement &now = parts_.step.placement, at_start = parts_.tool.placement(0.);
  const std::vector<ContactNodeReport> reports = report();
  for (std::size_t i = 0; i < reports.size(); ++i) {
    const ContactPoint &node = parts_.slaves.nodes[i];
    const ToolContactState &state = parts_.states[i];
    const Tensor<1, 3> way = now.to_tool(state.position) - at_start.to_tool(node.reference),
                       normal = dealii::transpose(now.rotation) * state.normal;
    gaps.add(reports[i].pressure * reports[i].area, reports[i].area, (way - (way * normal) * normal).norm(),
             node.size, InitialOverlap::counted(node.initial_penetration, parts_.step.allowed_part));
  }
  for (std::size_t i = reports.size(); i < parts_.slaves.nodes.size(); ++i) {
    // These are points inside facets.
    const ContactPoint &point = parts_.slaves.nodes[i];
    gaps.add(0., 0., 0., point.size,
             InitialOverlap::counted(point.initial_penetration, parts_.step.allowed_part));
  }
  return gaps;
}

std::vector<ContactNodeReport> ToolMeasures::report_nodes() const {
  std::vector<ContactNodeReport> reports;
  for (std::size_t i = 0; i < parts_.slaves.n_mesh_nodes; ++i) {
    const ToolContactState &state = parts_.states[i];
    const ContactPoint &node = parts_.slaves.nodes[i];
    const bool presses = state.pressure > 0.;
    reports.push_back({node.dofs, state.status, state.pressure, state.gap + parts_.step.gap_offset(node), 0.,
                       0., state.traction, presses ? std::abs(state.gap + node.multiplier_offset) : 0.,
                       node.size, 0., presses ? max_curvature(state) : 0.});
  }
  if (parts_.friction)
    for (std::size_t i = 0; i < reports.size(); ++i) {
      reports[i].slip = (*parts_.friction)[i].slip;
      reports[i].tangential_stiffness = parts_.slaves.nodes[i].stiffness.tangential;
    }
  return reports;
}

template <bool is_explicit>
void ToolMeasures::add_areas(const ToolSprings<is_explicit> &springs,
                             std::vector<ContactNodeReport> &reports) const {
  springs.visit_counted_areas([&](const unsigned int i, const double area) {
    parts_.slaves.for_each_parent(
        i, [&](const unsigned int parent, const double weight) { reports[parent].area += weight * area; });
  });
}

void ToolMeasures::follow_sides(std::vector<ContactNodeReport> &reports) const {
  constexpr std::array<std::array<unsigned int, 2>, 4> sides{{{0, 1}, {0, 2}, {1, 3}, {2, 3}}};
  const std::size_t n_nodes = parts_.slaves.n_mesh_nodes;
  for (const auto &facet : parts_.slaves.facets)
    for (const auto &side : sides) {
      const unsigned int a = facet.nodes[side[0]], b = facet.nodes[side[1]];
      for (const unsigned int i : {a, b})
        if (const ToolContactState &state = parts_.states[i]; a < n_nodes && b < n_nodes &&
                                                              state.pressure > 0. &&
                                                              !is_in_concave_edge(state.gap, state.turning))
          reports[i].curvature =
              std::max(reports[i].curvature,
                       (state.turning * (parts_.states[a].position - parts_.states[b].position)).norm() /
                           parts_.slaves.nodes[i].size);
    }
}

template <bool is_explicit>
void ToolMeasures::average_over_points(const ToolSprings<is_explicit> &springs,
                                       std::vector<ContactNodeReport> &reports) const {
  const SlaveSurface &slaves = parts_.slaves;
  struct Sums {
    double force = 0., slipping = 0., penetration = 0., curvature = 0.;
    Tensor<1, 3> traction;
  };
  std::vector<Sums> sums(slaves.n_mesh_nodes);
  std::vector<bool> has_points(slaves.n_mesh_nodes, false);
  for (const auto &divided : slaves.divided)
    for (const unsigned int corner : divided.corners)
      has_points[corner] = true;
  springs.visit_counted_areas([&](const unsigned int i, const double area) {
    const ToolContactState &state = parts_.states[i];
    slaves.for_each_parent(i, [&](const unsigned int parent, const double weight) {
      const double force = weight * area * state.pressure;
      sums[parent].force += force;
      sums[parent].penetration =
          std::max(sums[parent].penetration, std::abs(state.gap + slaves.nodes[i].multiplier_offset));
      sums[parent].curvature = std::max(sums[parent].curvature, max_curvature(state));
      sums[parent].slipping += state.status == ContactStatus::slip ? force : 0.;
      sums[parent].traction += weight * area * state.traction;
    });
  });
  for (std::size_t i = 0; i < slaves.n_mesh_nodes; ++i) {
    if (!has_points[i] || !(sums[i].force > 0.))
      continue;
    reports[i].pressure = sums[i].force / reports[i].area;
    reports[i].traction = sums[i].traction / reports[i].area;
    reports[i].penetration = sums[i].penetration;
    reports[i].curvature = sums[i].curvature;
    // A tool that is thin compared with the facets counts as a radius of half its thickness.
    if (parts_.thin_tool && parts_.thin_tool->thickness() < 0.5 * slaves.nodes[i].size)
      reports[i].curvature = std::max(reports[i].curvature, 2. / parts_.thin_tool->thickness());
    reports[i].status = sums[i].slipping > 0.5 * sums[i].force ? ContactStatus::slip : ContactStatus::stick;
  }
}

} // namespace billet
