// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/tool_forces.h"

#include "billet/geometry/facet_point.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

ContactLoad ToolForces::add(NodalVectors &forces, NodalVectors &bounds) {
  ContactLoad load;
  for (auto &facet : parts_.slaves.facets)
    add_facet(facet, forces, bounds, load);
  bounds_.add_near(bounds);
  if (parts_.friction)
    works_.add_released(load);
  return load;
}

ToolForces::CornerSprings ToolForces::stretch(ContactFacet &facet, const CornerStates &states) const {
  CornerSprings result;
  for (unsigned int a = 0; a < 4; ++a)
    if (states[a]->status != ContactStatus::open) {
      const SpringEnergy energy = springs_.of(facet.nodes[a]);
      if (!energy.is_split())
        facet.shallow_areas[a] = SpringEnergy::no_area; // set below
      result.energies[a] = energy.on_current_area;
      const double stiffness = parts_.slaves.nodes[facet.nodes[a]].stiffness.normal;
      result.penetration = std::max(result.penetration, 2. * energy.total / stiffness);
      result.hardening = std::max(result.hardening, bounds_.stiffness_ahead(facet.nodes[a]) / stiffness);
    }
  result.penetration = std::sqrt(result.penetration);
  return result;
}

ToolForces::CornerForces ToolForces::resist(const CornerStates &states,
                                            const std::array<double, 4> &energies) {
  CornerForces result;
  for (const auto &point : facet_points()) {
    const auto [g_1, g_2] = point.tangents([&](const unsigned int a) { return states[a]->position; });
    const Tensor<1, 3> area_vector = dealii::cross_product_3d(g_1, g_2);
    Tensor<1, 3> m;
    for (unsigned int a = 0; a < 4; ++a) {
      const double facing =
          states[a]->status != ContactStatus::open ? -(area_vector * states[a]->normal) : 0.;
      if (facing <= 0.)
        continue;
      result.areas[a] += point.N[a] * facing;
      m += point.N[a] * energies[a] * states[a]->normal;
      result.by_area[a] += point.N[a] * energies[a] * (states[a]->turning * area_vector);
    }
    const Tensor<1, 3> by_xi = dealii::cross_product_3d(g_2, m), by_eta = dealii::cross_product_3d(m, g_1);
    for (unsigned int b = 0; b < 4; ++b)
      result.by_area[b] += point.N_xi[b] * by_xi + point.N_eta[b] * by_eta;
  }
  return result;
}

void ToolForces::add_facet(ContactFacet &facet, NodalVectors &forces, NodalVectors &bounds,
                           ContactLoad &load) const {
  const CornerStates states = parts_.states_of(facet);
  if (!any_touches(states))
    return;
  const CornerSprings stretched = stretch(facet, states);
  const CornerForces corners = resist(states, stretched.energies);
  const double penetration = stretched.penetration;
  for (unsigned int b = 0; b < 4; ++b) {
    const std::size_t i = facet.nodes[b];
    const ContactPoint &node = parts_.slaves.nodes[i];
    const auto add_bound = [&](const double bound) {
      parts_.slaves.for_each_parent(i, [&](const unsigned int parent, const double weight) {
        bounds[std::size_t{nodal_stride} * parts_.bound.local[parent]] += weight * bound;
      });
    };
    Tensor<1, 3> force = corners.by_area[b];
    load.force += force;
    load.moment +=
        dealii::cross_product_3d(states[b]->position - parts_.step.placement.moved_centre(), force);
    add_bound(stretched.hardening * node.stiffness.normal *
              std::min(penetration, penetration_on_current_areas(node)) * (node.spacing + penetration));
    if (states[b]->status != ContactStatus::open) {
      if (facet.shallow_areas[b] == SpringEnergy::no_area)
        facet.shallow_areas[b] = corners.areas[b];
      force += works_.add_corner(springs_, facet, b, corners.areas[b], load);
      load.ramp_work += (parts_.step.allowed_part_n - parts_.step.allowed_part) * node.initial_penetration *
                        states[b]->pressure * corners.areas[b];
      add_bound(
          springs_.of(i).max_area(corners.areas[b], facet.shallow_areas[b]) *
          (std::max(bounds_.stiffness_ahead(i), node.stiffness.tangential) + states[b]->fading_stiffness));
    }
    parts_.slaves.for_each_parent(i, [&](const unsigned int parent, const double weight) {
      add_vector(forces.data(), parts_.bound.local[parent], weight * force);
    });
  }
}

} // namespace billet
