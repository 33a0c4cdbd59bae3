// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_LANE_ELEMENT_H
#define BILLET_MECHANICS_LANE_ELEMENT_H

// Kernels include this file, so it uses nothing of the standard library: see explicit/kernel.h.

namespace billet {

/// Bricks that the explicit kernels compute for several elements at once. The last one determines
/// the count.
enum class LaneElement { assumed_strain, mean_dilatation, one_point };
constexpr unsigned int n_lane_elements = static_cast<unsigned int>(LaneElement::one_point) + 1;

} // namespace billet

#endif
