// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/facet_works.h"

#include "billet/contact/rank_sums.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {

void sum_over_ranks(FacetContactLoad &load, MPI_Comm communicator) {
  RankParts{{&load.stored_energy, &load.dissipation, &load.area, &load.n_touching, &load.absolute_force,
             &load.damping},
            {&load.force, &load.moment, &load.residual_force, &load.residual_moment},
            {&load.deepest, &load.deepest_relative}}
      .reduce(communicator);
}

} // namespace

bool FacetWorks::hands_over() const {
  if (!parts_.friction->accounting().counts_hand_over)
    return false;
  bool presses = false;
  for (std::size_t s = 0; s < parts_.touching.size(); ++s)
    presses = presses || parts_.touching[s].has_pressure();
  return presses_at_both_ends(parts_.start.pressed_anywhere(), presses, parts_.surfaces.communicator());
}

FacetContactLoad FacetWorks::compute_load() const {
  FacetContactLoad load;
  for (std::size_t s = 0; s < parts_.touching.size(); ++s)
    add_slave(s, load);
  if (parts_.friction)
    add_friction(load);
  if (parts_.edges)
    parts_.edges->add_load(parts_.surfaces.positions(), load);
  sum_over_ranks(load, parts_.surfaces.communicator());
  return load;
}

void FacetWorks::add_friction(FacetContactLoad &load) const {
  const auto dissipation = counted_dissipation();
  for (std::size_t s = 0; s < parts_.touching.size(); ++s) {
    const FrictionWorks &works = parts_.friction->works(s);
    load.dissipation += works.*dissipation;
    load.damping += works.damping;
  }
}

void FacetWorks::add_slave(const std::size_t s, FacetContactLoad &load) const {
  const SlaveState &state = parts_.touching[s];
  if (!state.presses())
    return;
  add_forces(s, load);
  load.absolute_force += state.own_area * state.traction.traction.norm();
  const double augmentation = parts_.offsets.augmentation[s];
  // Multipliers do not stretch springs.
  load.stored_energy += parts_.offsets.augmentation.is_empty()
                            ? state.own_area * state.traction.stored_energy
                            : 0.5 * state.own_area * parts_.penalties[s].normal *
                                  (state.contact.gap + augmentation) * (state.contact.gap + augmentation);
  load.area += state.own_area;
  load.n_touching += 1.;
  const FacetCorners corners = parts_.surfaces.moved().corners(state.touched.facet);
  const double size =
      std::sqrt(0.5 * dealii::cross_product_3d(corners[3] - corners[0], corners[2] - corners[1]).norm());
  const double penetration = state.touched.offset - state.contact.gap - parts_.offsets.of(s).now;
  load.deepest = std::max(load.deepest, penetration);
  load.deepest_relative = std::max(load.deepest_relative, penetration / size);
}

void FacetWorks::add_forces(const std::size_t s, FacetContactLoad &load) const {
  const FacetSearch::Positions &positions = parts_.surfaces.positions();
  parts_.touching.visit_forces(
      s, [&](const FacetShare &share, const Tensor<1, 3> &force, const FacetCorners &reaction) {
        const FacetCorners corners = parts_.surfaces.moved().corners(share.facet);
        const Tensor<1, 3> point = parts_.touching.point_of(s, share, positions);
        load.residual_force += force;
        for (unsigned int a = 0; a < 4; ++a) {
          load.residual_force += reaction[a];
          load.residual_moment += dealii::cross_product_3d(corners[a] - point, reaction[a]);
        }
        const unsigned int of_node = parts_.slaves.surface(s),
                           of_facet = parts_.surfaces.facet(share.facet).surface;
        if (of_node == of_facet) // the sum is 0
          return;
        if (of_node == 0) {
          load.force += force;
          load.moment += dealii::cross_product_3d(point, force);
        }
        if (of_facet == 0) {
          load.force -= force;
          for (unsigned int a = 0; a < 4; ++a)
            load.moment += dealii::cross_product_3d(corners[a], reaction[a]);
        }
      });
}

double FacetWorks::local_dissipation() const {
  double dissipation = 0.;
  if (parts_.friction)
    for (std::size_t s = 0; s < parts_.touching.size(); ++s)
      dissipation += parts_.friction->works(s).dissipation;
  return dissipation;
}

StepWorks FacetWorks::compute_step_works(const double weight) const {
  StepWorks works;
  if (parts_.friction) {
    const auto dissipation = counted_dissipation();
    works = local_step_works(weight, [&](const std::size_t s) {
      const FrictionWorks &friction = parts_.friction->works(s);
      return friction.taken_beyond - friction.missed - (friction.*dissipation - friction.dissipation);
    });
  } else
    works = local_step_works(weight, [](const std::size_t) { return 0.; });
  works.touching = dealii::Utilities::MPI::sum(works.touching, parts_.surfaces.communicator());
  works.ramp = dealii::Utilities::MPI::sum(works.ramp, parts_.surfaces.communicator());
  return works;
}

template <class Friction>
StepWorks FacetWorks::local_step_works(const double weight, const Friction &miscounted_friction) const {
  StepWorks works;
  for (std::size_t s = 0; s < parts_.touching.size(); ++s) {
    const SlaveState &state = parts_.touching[s];
    works.touching -= miscounted_friction(s);
    const SlaveStart::Pressure &before = parts_.start.pressed(s);
    const double ramp_penetration = parts_.offsets.penetrations.ramp(s);
    if (state.has_pressure()) {
      const double penetration = std::max(0., -(state.contact.gap + parts_.offsets.augmentation[s]));
      const double closing =
          ramp_penetration - parts_.touching.motion_of(s).displacement * state.contact.normal;
      works.add(before.pressure * state.own_area, state.traction.pressure * state.own_area,
                before.penetration, penetration, closing, ramp_penetration, weight);
    } else if (before.pressure > 0. && parts_.start.touched(s).exists()) {
      const SlaveMotion motion = parts_.touching.motion_after_contact(s);
      const Tensor<1, 3> normal = motion.rotation * before.normal;
      works.add(before.pressure * parts_.touching.own_part(s) * before.area, 0., before.penetration, 0.,
                ramp_penetration - motion.displacement * normal, ramp_penetration, weight);
    }
  }
  return works;
}

} // namespace billet
