// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/tool_drive.h"

#include <algorithm>
#include <limits>

namespace billet {

using dealii::Tensor;

void ToolDrive::add_push(const Placement &after, Vector &forces) const {
  visit_areas(parts_, [&](const unsigned int i, const double area) {
    const ToolContactState &state = parts_.states[i];
    const Tensor<1, 3> motion =
        after.to_space(parts_.step.placement.to_tool(state.position)) - state.position;
    parts_.slaves.add_to_dofs(i, area * (state.tangent * motion), forces);
  });
}

double ToolDrive::add_derivatives(const ToolTangents &tangents, const ToolRate &rate, Vector &column,
                                  Vector &row) const {
  double power_slope = 0.;
  tangents.visit(0, parts_.slaves.facets.size(),
                 [&](const ContactFacet &facet, const dealii::FullMatrix<double> &K) {
                   const ProjectedAreas areas = compute_projected_areas(parts_.states_of(facet), false);
                   std::array<Tensor<1, 3>, 4> v, F;
                   for (unsigned int a = 0; a < 4; ++a) {
                     const ToolContactState &state = parts_.states[facet.nodes[a]];
                     v[a] = rate_at(state.position, rate);
                     F[a] = areas.areas[a] * state.traction;
                   }
                   for (unsigned int a = 0; a < 4; ++a) {
                     Tensor<1, 3> along = dealii::cross_product_3d(rate.rotation, F[a]); // ∂F_a/∂s
                     // ∂P/∂u_a: ω × x · F = x · F × ω
                     Tensor<1, 3> power = dealii::cross_product_3d(F[a], rate.rotation);
                     for (unsigned int i = 0; i < 3; ++i)
                       for (unsigned int b = 0; b < 4; ++b)
                         for (unsigned int j = 0; j < 3; ++j) {
                           along[i] += K(3 * a + i, 3 * b + j) * v[b][j];
                           power[i] -= v[b][j] * K(3 * b + j, 3 * a + i);
                         }
                     power_slope += v[a] * along;
                     // The arm rotates with the tool about a fixed centre: ω × v adds no further
                     // term.
                     parts_.slaves.add_to_dofs(facet.nodes[a], -along, column);
                     parts_.slaves.add_to_dofs(facet.nodes[a], power, row);
                   }
                 });
  return power_slope;
}

ToolDrive::Sliding ToolDrive::measure_sliding(const ToolRate &rate) const {
  Sliding sliding;
  visit_areas(parts_, [&](const unsigned int i, const double area) {
    const ToolContactState &state = parts_.states[i];
    const Tensor<1, 3> v = rate_at(state.position, rate);
    const double along_normal = state.normal * v, force = area * state.pressure;
    const double weight = force * (v - along_normal * state.normal).norm();
    sliding.touching += weight;
    sliding.slipping += state.status == ContactStatus::slip ? weight : 0.;
    sliding.power_of_pressure += force * along_normal;
  });
  return sliding;
}

double ToolDrive::distance_to_touch(const Tensor<1, 3> &direction) const {
  constexpr double min_approach = 1e-6; // cosine to the normal: less is parallel to the surface
  double minimum = std::numeric_limits<double>::infinity();
  if (parts_.step.is_removed)
    return minimum;
  const Placement &placement = parts_.step.placement;
  for (std::size_t i = 0; i < parts_.slaves.nodes.size(); ++i) {
    const auto projection = parts_.step.surface.project(placement.to_tool(parts_.states[i].position),
                                                        parts_.slaves.nodes[i].patch);
    const double approach = placement.rotation * projection.normal * direction;
    if (projection.exists && approach > min_approach)
      minimum = std::min(minimum, projection.gap / approach);
  }
  return minimum;
}

} // namespace billet
