// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/tool_bounds.h"

#include "billet/contact/tool_evaluation.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

double ToolBounds::stiffness_ahead(const std::size_t i) const {
  const double gap = parts_.states[i].gap;
  const ContactPoint &node = parts_.slaves.nodes[i];
  return node.spring().slope(std::max(0., -gap) + std::max(0., node.gap_n - gap));
}

template <class Add> void ToolBounds::visit_near(const Add &add) const {
  for (unsigned int i = 0; i < parts_.slaves.nodes.size(); ++i) {
    const ContactPoint &node = parts_.slaves.nodes[i];
    const double gap = parts_.states[i].gap;
    // The step in which a node enters must be short enough already, and equal steps conserve energy
    // best.
    const bool is_near = gap < near_gap * node.size || gap + near_steps * (gap - node.gap_n) < 0.;
    if (parts_.states[i].status == ContactStatus::open && gap >= 0. && is_near && parts_.bound.is_owned[i])
      add(i, node.spacing * node.spacing);
  }
}

void ToolBounds::add_near(NodalVectors &bounds) const {
  visit_near([&](const unsigned int i, const double area) {
    // w (Σ w_b v_b)² <= w Σ w_b v_b²
    parts_.slaves.for_each_parent(i, [&](const unsigned int parent, const double weight) {
      bounds[std::size_t{nodal_stride} * parts_.bound.local[parent]] +=
          weight * (area * std::max(stiffness_ahead(i), parts_.slaves.nodes[i].stiffness.tangential));
    });
  });
}

void ToolBounds::add_crossings(Crossings &crossings) const {
  if (parts_.step.is_removed || parts_.step.duration == 0.)
    return;
  for (std::size_t i = 0; i < parts_.slaves.nodes.size(); ++i)
    if (parts_.bound.is_owned[i]) {
      const ContactPoint &node = parts_.slaves.nodes[i];
      const double moved = parts_.states[i].gap - node.gap_n;
      crossings.add(node.spring().slope(moved) * node.spacing * node.spacing, parts_.states[i].gap, moved);
    }
}

void ToolBounds::add_start_crossings(Crossings &crossings, const NodalVectors &velocities,
                                     const double step) const {
  const Placement &placement = parts_.step.placement;
  for (std::size_t i = 0; i < parts_.slaves.nodes.size(); ++i) {
    const ContactPoint &node = parts_.slaves.nodes[i];
    const ToolContactState &state = parts_.states[i];
    const Tensor<1, 3> v = parts_.slaves.at(
        i, [&](const std::size_t parent) { return parts_.bound.vector_of(parent, velocities); });
    if (!parts_.bound.is_owned[i] || std::abs(state.gap) >= 2. * step * v.norm())
      continue;
    const auto projection = parts_.step.surface.project(placement.to_tool(state.position), node.patch);
    const double moved = step * (v * (placement.rotation * projection.normal));
    crossings.add(node.spring().slope(moved) * node.spacing * node.spacing, state.gap, moved);
  }
}

double ToolBounds::stiffness_against_tool() const {
  double sum = 0.;
  if (parts_.step.is_removed || !parts_.tool.is_driven())
    return sum;
  const Placement &placement = parts_.step.placement;
  const bool turns = parts_.tool.control() == Tool::Control::moment;
  const Tensor<1, 3> along = turns ? Tensor<1, 3>() : parts_.tool.force_direction(),
                     about = turns ? parts_.tool.rotation_axis() : Tensor<1, 3>();
  // Adds the part of the normal spring; returns (a·a) − (a·n)², a the motion of the node with the
  // tool.
  const auto add_normal = [&](const unsigned int i, const double area) {
    const ToolContactState &state = parts_.states[i];
    const Tensor<1, 3> n = // undefined for open nodes
        state.status != ContactStatus::open
            ? state.normal
            : placement.rotation *
                  parts_.step.surface.project(placement.to_tool(state.position), parts_.slaves.nodes[i].patch)
                      .normal;
    const Tensor<1, 3> a = along + dealii::cross_product_3d(about, state.position - placement.moved_centre());
    const double normal = a * n;
    sum += area * stiffness_ahead(i) * normal * normal;
    return a * a - normal * normal;
  };
  const auto visit_all = [&](const auto &add) {
    with_tool_springs(parts_, [&](const auto &springs) {
      visit_touching(parts_, [&](const ContactFacet &facet, const unsigned int corner, const double area) {
        add(facet.nodes[corner], springs.of(facet.nodes[corner]).max_area(area, facet.shallow_areas[corner]));
      });
    });
    visit_near(add);
  };
  if (parts_.pair.has_friction())
    visit_all([&](const unsigned int i, const double area) {
      const double across = add_normal(i, area);
      sum += area * parts_.slaves.nodes[i].stiffness.tangential * across;
    });
  else
    visit_all(add_normal);
  return sum;
}

} // namespace billet
