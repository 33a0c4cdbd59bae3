// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_ELEMENT_POINTS_H
#define BILLET_SOLVE_ELEMENT_POINTS_H

#include "billet/mechanics/thickness.h"

#include <vector>

namespace billet {

/// States of the points of an element, and its axis through the thickness if there are more than
/// two along it.
struct ElementPoints {
  ElementStress stress;
  ThicknessAxis axis = {};
};

/// Solution that has the states of the points of its elements.
class HasElementPoints {
public:
  virtual ~HasElementPoints() = default;
  /// Returns one entry for each owned element of the body, in the order of
  /// Discretization::elements().
  virtual std::vector<ElementPoints> element_points(std::size_t body) const = 0;
};

} // namespace billet

#endif
