// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_HEXAHEDRON_H
#define BILLET_MECHANICS_HEXAHEDRON_H

#include "billet/mechanics/mean_dilatation.h"

#include <deal.II/base/point.h>

#include <optional>

namespace billet {

/// Trilinear hexahedron.
class Hexahedron {
public:
  explicit Hexahedron(const ElementVectors &corners);

  /// Returns the reference coordinates of a point, in the unit cube; none if it is outside by more
  /// than round-off.
  std::optional<dealii::Point<3>> find(const dealii::Tensor<1, 3> &point) const;

  /// Returns a distance of a point outside that is not below the true one, infinity if there is
  /// none. In front of a face of a parallelepiped with right angles both are equal.
  double distance(const dealii::Tensor<1, 3> &point) const;

private:
  ElementVectors corners_;
  dealii::Tensor<1, 3> low_, high_; ///< of its bounding box, with a margin for round-off
};

} // namespace billet

#endif
