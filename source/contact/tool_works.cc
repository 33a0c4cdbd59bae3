// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/tool_works.h"

#include "billet/contact/rank_sums.h"

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace billet {

using dealii::Tensor;

template <bool is_explicit>
Tensor<1, 3> ToolWorks::add_corner(const ToolSprings<is_explicit> &springs, const ContactFacet &facet,
                                   const unsigned int corner, const double area, ContactLoad &load) const {
  const std::size_t i = facet.nodes[corner];
  const ToolContactState &state = parts_.states[i];
  const SpringEnergy energy = springs.of(i);
  const double counted = energy.counted_area(area, facet.shallow_areas[corner]);
  if (!(counted > 0.))
    return {};
  const Tensor<1, 3> force = counted * state.traction;
  load.force += force;
  load.moment += dealii::cross_product_3d(state.position - parts_.step.placement.moved_centre(), force);
  load.area += area;
  load.stored_energy += energy.on_areas(area, facet.shallow_areas[corner]);
  if constexpr (is_explicit)
    load.dissipation += state.friction.dissipated(counted, counted);
  load.deepest = std::max(load.deepest, -(state.gap + parts_.slaves.nodes[i].multiplier_offset));
  return force;
}

template Tensor<1, 3> ToolWorks::add_corner(const ToolSprings<true> &, const ContactFacet &, unsigned int,
                                            double, ContactLoad &) const;

ContactLoad ToolWorks::compute_load() const {
  const bool hands_over =
      parts_.friction && parts_.friction->accounting().counts_hand_over && presses_at_both_ends();
  const ContactLoad load =
      with_tool_springs(parts_, [&](const auto &springs) { return local_load(springs, hands_over); });
  return sum_over_ranks(load, parts_.communicator);
}

bool ToolWorks::presses_at_both_ends() const {
  const bool presses = std::any_of(parts_.states.begin(), parts_.states.end(),
                                   [](const ToolContactState &state) { return state.pressure > 0.; });
  return billet::presses_at_both_ends(parts_.pressures.has_pressure(), presses, parts_.communicator);
}

template <bool is_explicit>
ContactLoad ToolWorks::local_load(const ToolSprings<is_explicit> &springs, const bool hands_over) const {
  ContactLoad load;
  visit_touching(parts_, [&](const ContactFacet &facet, const unsigned int corner, const double area) {
    add_corner(springs, facet, corner, area, load);
  });
  if (!parts_.friction)
    return load;
  if constexpr (is_explicit)
    add_released(load);
  else
    visit_friction(hands_over, [&](const FrictionAccount &account, const double area_n, const double area) {
      load.dissipation += account.dissipated(area_n, area);
      load.damping += area * account.damping;
    });
  return load;
}

template <class Visit> void ToolWorks::visit_friction(const bool hands_over, const Visit &visit) const {
  for (const auto &facet : parts_.slaves.facets) {
    const CornerStates states = parts_.states_of(facet);
    const std::array<double, 4> areas =
        any_touches(states) ? compute_projected_areas(states, false).areas : std::array<double, 4>{};
    for (unsigned int a = 0; a < 4; ++a)
      visit(hands_over ? states[a]->friction.handed_over() : states[a]->friction, facet.friction_areas[a],
            areas[a]);
  }
}

void ToolWorks::add_released(ContactLoad &load) const {
  const auto is_released = [](const ToolContactState &state) {
    return state.status == ContactStatus::open && state.friction.dissipation_n != 0.;
  };
  if (std::none_of(parts_.states.begin(), parts_.states.end(), is_released))
    return;
  const ToolSprings<true> springs(parts_);
  for (const auto &facet : parts_.slaves.facets) {
    const CornerStates states = parts_.states_of(facet);
    if (std::none_of(states.begin(), states.end(),
                     [&](const ToolContactState *node) { return is_released(*node); }))
      continue;
    const auto areas = projected_shares(states, [&](const unsigned int a) { return states[a]->normal; });
    for (unsigned int a = 0; a < 4; ++a)
      if (is_released(*states[a]))
        load.dissipation += springs.of(facet.nodes[a], states[a]->friction.dissipation_n)
                                .on_areas(areas[a], facet.shallow_areas[a]);
  }
}

template <class NormalOf> std::vector<double> ToolWorks::areas_along(const NormalOf &normal_of) const {
  std::vector<double> areas(parts_.slaves.nodes.size(), 0.);
  for (const auto &facet : parts_.slaves.facets) {
    const auto shares = projected_shares(parts_.states_of(facet),
                                         [&](const unsigned int a) { return normal_of(facet.nodes[a]); });
    for (unsigned int a = 0; a < 4; ++a)
      areas[facet.nodes[a]] += shares[a];
  }
  return areas;
}

bool ToolWorks::has_moved() const {
  if (parts_.step.is_removed || !parts_.pressures.is_known())
    return false;
  for (std::size_t i = 0; i < parts_.states.size(); ++i) {
    const bool presses = parts_.states[i].pressure > 0.;
    if (presses != (parts_.pressures[i].pressure > 0.) ||
        (presses && parts_.step.allowed_part != parts_.step.allowed_part_n &&
         parts_.slaves.nodes[i].initial_penetration > 0.))
      return true;
  }
  return false;
}

void ToolWorks::add_pressure_works(const double weight, StepWorks &works) const {
  const Placement &placement = parts_.step.placement;
  const auto normal_of = [&](const std::size_t i) {
    return parts_.states[i].pressure > 0. ? parts_.states[i].normal
                                          : placement.rotation * parts_.pressures[i].normal;
  };
  const std::vector<double> areas = areas_along(normal_of);
  for (std::size_t i = 0; i < parts_.slaves.nodes.size(); ++i) {
    const ToolContactState &state = parts_.states[i];
    const PressureRecord::Entry &before = parts_.pressures[i];
    if (!(state.pressure > 0.) && !(before.pressure > 0.))
      continue;
    const double ramp_penetration =
        (parts_.step.allowed_part_n - parts_.step.allowed_part) * parts_.slaves.nodes[i].initial_penetration;
    const double closing =
        ramp_penetration - normal_of(i) * (state.position - placement.to_space(before.position));
    works.add(before.pressure * areas[i], state.pressure * areas[i], before.penetration,
              pressed_depth(state, parts_.slaves.nodes[i]), closing, ramp_penetration, weight);
  }
}

StepWorks ToolWorks::compute_step_works(const double weight) const {
  StepWorks works;
  if (has_moved())
    add_pressure_works(weight, works);
  if (parts_.friction && parts_.friction->accounting().counts_hand_over &&
      !parts_.step.is_removed) // the same on all ranks
    visit_friction(presses_at_both_ends(),
                   [&](const FrictionAccount &account, const double area_n, const double area) {
                     works.touching -= account.taken_beyond(area_n, area) - account.missed(area_n);
                   });
  works.touching = dealii::Utilities::MPI::sum(works.touching, parts_.communicator);
  works.ramp = dealii::Utilities::MPI::sum(works.ramp, parts_.communicator);
  return works;
}

} // namespace billet
