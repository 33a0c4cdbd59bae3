// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DISCRETIZATION_POINT_LOCATION_H
#define BILLET_DISCRETIZATION_POINT_LOCATION_H

#include "billet/discretization/discretization.h"

#include <optional>
#include <string>
#include <vector>

namespace billet {

/// Point of an undeformed element of this rank.
struct LocatedPoint {
  std::size_t element;          ///< in Discretization::elements() of its body
  std::uint64_t key;            ///< of the element
  dealii::Point<3> coordinates; ///< in the unit cube
};

/// Points that are asked for, and by whom.
struct PointRequest {
  std::vector<dealii::Point<3>> points;
  bool takes_nearest_nodes; ///< instead of points of the body
  std::string body, origin; ///< for messages: name of the body, and place in the scene file
  std::string allowed;      ///< for messages: what is allowed instead of a point outside the body
};

/// Finds points in a body, each on one rank: in the element with the least key, or at the node that
/// is nearest. Throws InputError if a point is outside the body, or farther from it than a tenth of
/// the scene's radius. Collective.
std::vector<std::optional<LocatedPoint>> locate_points(const Discretization &discretization, std::size_t body,
                                                       const PointRequest &request);

} // namespace billet

#endif
