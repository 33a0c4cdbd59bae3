// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/tool_penalties.h"

#include "billet/contact/tool_springs.h"

#include <algorithm>
#include <cmath>

namespace billet {

void ToolPenalties::take_back_augmentation() {
  for (auto &node : parts_.slaves.nodes)
    node.multiplier_offset = node.multiplier_offset_n;
  if (parts_.friction)
    parts_.friction->restart();
}

void ToolPenalties::augment() {
  auto &nodes = parts_.slaves.nodes;
  Usage::count(Capability::augmentation, nodes.size());
  memory_.set(2 * nodes.size() * sizeof(ContactPoint::multiplier_offset));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const ToolContactState &state = parts_.states[i];
    nodes[i].multiplier_offset = nodes[i].is_fixed   ? 0.
                                 : state.share == 1. ? state.pressure / nodes[i].stiffness.normal
                                                     : state.share * std::max(0., -state.gap);
  }
  if (parts_.friction)
    parts_.friction->augment(nodes);
}

void ToolPenalties::scale(const double normal, const double tangential) {
  stiffening_ *= normal;
  tangential_stiffening_ *= tangential;
  for (auto &node : parts_.slaves.nodes) {
    if (node.is_fixed) // only its spring gives its force
      continue;
    node.stiffness = {stiffening_ * node.given.normal, tangential_stiffening_ * node.given.tangential};
    node.multiplier_offset /= normal;
    node.gap_n += node.multiplier_offset_n * (1. - 1. / normal);
    node.multiplier_offset_n /= normal;
  }
}

void ToolPenalties::scale_under_load(const double normal, const double tangential) {
  scale(normal, tangential);
  for (std::size_t i = 0; i < parts_.slaves.nodes.size(); ++i) {
    ContactPoint &node = parts_.slaves.nodes[i];
    ToolContactState &state = parts_.states[i];
    if (node.is_fixed || !(state.pressure > 0.))
      continue;
    node.initial_penetration -= (1. - 1. / normal) * state.gap;
    state.gap /= normal;
    node.gap_n /= normal;
    parts_.pressures.divide_penetration(i, normal);
  }
}

void ToolPenalties::lower_under_load(const double normal, const double tangential) {
  std::vector<double> gaps; // without multipliers
  for (std::size_t i = 0; i < parts_.slaves.nodes.size(); ++i)
    gaps.push_back(parts_.states[i].gap + parts_.slaves.nodes[i].multiplier_offset);
  scale(normal, tangential);
  for (std::size_t i = 0; i < parts_.slaves.nodes.size(); ++i) {
    ContactPoint &node = parts_.slaves.nodes[i];
    ToolContactState &state = parts_.states[i];
    if (node.is_fixed || !(state.pressure > 0.) || state.share != 1.)
      continue;
    state.gap = node.gap_n = -state.pressure / node.stiffness.normal;
    node.multiplier_offset = node.multiplier_offset_n = gaps[i] - state.gap;
    parts_.pressures.divide_penetration(i, normal);
  }
}

double ToolPenalties::max_spring() const {
  double maximum = 0.;
  for (const auto &node : parts_.slaves.nodes)
    maximum =
        std::max(maximum, std::max(node.stiffness.normal, node.stiffness.tangential) * node.size * node.size);
  return maximum;
}

double ToolPenalties::augmentation_gap() const {
  double worst = 0.;
  parts_.visit_penetrations(
      [&](const ContactPoint &node, const double depth) { worst = std::max(worst, depth / node.size); });
  const std::vector<double> slips = elastic_slips();
  for (std::size_t i = 0; i < slips.size(); ++i)
    worst = std::max(worst, slips[i] / parts_.slaves.nodes[i].size);
  return worst;
}

std::vector<double> ToolPenalties::elastic_slips() const {
  std::vector<double> slips(parts_.states.size());
  if (parts_.friction)
    for (std::size_t i = 0; i < slips.size(); ++i)
      slips[i] = parts_.friction->elastic_slip(i, parts_.slaves.nodes[i], parts_.states[i]);
  return slips;
}

ContactSprings ToolPenalties::compute_springs() const {
  ContactSprings result;
  result.normal.of_nodes.resize(parts_.slaves.nodes.size());
  result.tangential.of_nodes.resize(parts_.slaves.nodes.size());
  const std::vector<double> slips = elastic_slips();
  with_tool_springs(parts_, [&](const auto &springs) {
    springs.visit_counted_areas([&](const unsigned int i, const double area) {
      const ToolContactState &state = parts_.states[i];
      const ContactPoint &node = parts_.slaves.nodes[i];
      if (node.is_fixed)
        return;
      result.add(i, area * state.traction, state.normal,
                 area * node.stiffness.normal * std::abs(state.gap + node.multiplier_offset),
                 area * node.stiffness.tangential * slips[i]);
    });
  });
  return result;
}

} // namespace billet
