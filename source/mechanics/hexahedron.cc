// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/hexahedron.h"

#include "billet/mechanics/reference_point.h"

#include <deal.II/base/geometry_info.h>

#include <algorithm>
#include <limits>

namespace billet {

using dealii::Tensor;
using Unit = dealii::GeometryInfo<3>;

namespace {

constexpr double outside = 1e-6; // of the unit cube, as round-off

} // namespace

Hexahedron::Hexahedron(const ElementVectors &corners) : corners_(corners) {
  for (unsigned int i = 0; i < 3; ++i) {
    double low = corners[i], high = corners[i];
    for (unsigned int a = 1; a < n_element_nodes; ++a) {
      low = std::min(low, corners[3 * a + i]);
      high = std::max(high, corners[3 * a + i]);
    }
    const double margin = outside * (high - low);
    low_[i] = low - margin;
    high_[i] = high + margin;
  }
}

std::optional<dealii::Point<3>> Hexahedron::find(const Tensor<1, 3> &point) const {
  for (unsigned int i = 0; i < 3; ++i)
    if (!(point[i] >= low_[i] && point[i] <= high_[i]))
      return {};
  const auto xi = find_reference_point(corners_, point);
  if (!xi || Unit::distance_to_unit_cell(*xi) > outside)
    return {};
  return Unit::project_to_unit_cell(*xi);
}

double Hexahedron::distance(const Tensor<1, 3> &point) const {
  const auto xi = find_reference_point(corners_, point);
  if (!xi)
    return std::numeric_limits<double>::infinity();
  const dealii::Point<3> nearest = Unit::project_to_unit_cell(*xi);
  Tensor<1, 3> from_point = -point;
  for (unsigned int a = 0; a < n_element_nodes; ++a)
    for (unsigned int i = 0; i < 3; ++i)
      from_point[i] += Unit::d_linear_shape_function(nearest, a) * corners_[3 * a + i];
  return from_point.norm();
}

} // namespace billet
