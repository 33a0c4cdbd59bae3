// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_PROJECTED_AREAS_H
#define BILLET_CONTACT_PROJECTED_AREAS_H

#include "billet/contact/tool_contact_state.h"
#include "billet/geometry/facet_point.h"

#include <deal.II/base/tensor.h>

#include <algorithm>
#include <array>

namespace billet {

/// States of a facet's corners.
using CornerStates = std::array<const ToolContactState *, 4>;

/// Whether any of these nodes touches the tool.
inline bool any_touches(const CornerStates &states) {
  return std::any_of(states.begin(), states.end(),
                     [](const ToolContactState *state) { return state->status != ContactStatus::open; });
}

/// Area shares of a facet's corners, ∫ N_a <−ν·n_a> dξdη over the current facet. ν is its outward
/// area vector, and n_a the normal of the tool at corner a. The share of a corner without contact
/// is 0.
struct ProjectedAreas {
  std::array<double, 4> areas; ///< [length²]
  /// ∂A_a/∂x_b at fixed normals
  std::array<std::array<dealii::Tensor<1, 3>, 4>, 4> derivatives;
  /// ∂A_a/∂n_a
  std::array<dealii::Tensor<1, 3>, 4> normal_derivatives;
};

/// Integrates by 2 × 2 Gauss points. Derivatives are 0 unless `with_derivatives`.
ProjectedAreas compute_projected_areas(const CornerStates &states, bool with_derivatives);

/// Returns the area shares of the corners by 2 × 2 Gauss points, whether they touch or not, along
/// the normals normal_of(corner).
template <class NormalOf>
std::array<double, 4> projected_shares(const CornerStates &states, const NormalOf &normal_of) {
  std::array<double, 4> shares{};
  for (const auto &point : facet_points()) {
    const auto area_vector = point.area_vector([&](const unsigned int a) { return states[a]->position; });
    for (unsigned int a = 0; a < 4; ++a)
      shares[a] += point.N[a] * std::max(0., -(area_vector * normal_of(a)));
  }
  return shares;
}

} // namespace billet

#endif
