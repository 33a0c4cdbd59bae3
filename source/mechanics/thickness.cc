// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/thickness.h"

#include <deal.II/base/exceptions.h>
#include <deal.II/base/numbers.h>
#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <cmath>

namespace billet {

namespace {

/// Returns the rule; deal.II's points are in increasing order.
GaussRule make_rule(const unsigned int n_through) {
  GaussRule rule;
  const dealii::QGauss<1> gauss(n_through);
  for (unsigned int l = 0; l < n_through; ++l) {
    rule.points.push_back(2. * gauss.point(l)[0] - 1.);
    rule.weights.push_back(gauss.weight(l));
  }
  // The two halves are symmetric to the last bit.
  for (unsigned int l = 0; 2 * l < n_through; ++l) {
    const unsigned int other = n_through - 1 - l;
    rule.points[l] = l == other ? 0. : -rule.points[other];
    rule.weights[l] = rule.weights[other];
  }
  if (n_through == 2)
    rule = {{-1. / std::sqrt(3.), 1. / std::sqrt(3.)}, {0.5, 0.5}};
  return rule;
}

/// Replaces a column of layers with means over the parts of the thickness of other layers.
void transfer_column(std::vector<PointStress> &column, const unsigned int n_through) {
  if (column.size() == n_through)
    return;
  const GaussRule &from = gauss_rule(static_cast<unsigned int>(column.size())), &to = gauss_rule(n_through);
  std::vector<PointStress> result(n_through);
  double to_begin = 0.;
  for (unsigned int l = 0; l < n_through; ++l) {
    const double to_end = to_begin + to.weights[l];
    double from_begin = 0.;
    for (unsigned int m = 0; m < column.size(); ++m) {
      const double from_end = from_begin + from.weights[m];
      const double part = (std::min(to_end, from_end) - std::max(to_begin, from_begin)) / to.weights[l];
      if (part > 0.) {
        result[l].add(part, column[m]);
      }
      from_begin = from_end;
    }
    to_begin = to_end;
  }
  column = result;
}

} // namespace

void PointStress::add(const double part, const PointStress &other) {
  deviator += part * other.deviator;
  equivalent_plastic_strain += part * other.equivalent_plastic_strain;
  memory.resize(other.memory.size());
  for (std::size_t k = 0; k < memory.size(); ++k)
    memory[k] += part * other.memory[k];
}

const GaussRule &gauss_rule(const unsigned int n_through) {
  static const std::array<GaussRule, all_points_through.size()> rules = [] {
    std::array<GaussRule, all_points_through.size()> made;
    std::transform(all_points_through.begin(), all_points_through.end(), made.begin(), make_rule);
    return made;
  }();
  const auto found = std::find(all_points_through.begin(), all_points_through.end(), n_through);
  AssertThrow(found != all_points_through.end(), dealii::ExcInternalError());
  return rules.at(static_cast<std::size_t>(found - all_points_through.begin()));
}

std::optional<ThicknessAxis> find_thickness_axis(const ElementVectors &positions,
                                                 const dealii::Tensor<1, 3> &direction) {
  const auto modes = compute_modes(positions);
  std::array<double, 3> cosines{}, angles{};
  for (unsigned int k = 0; k < 3; ++k) {
    const double lengths = modes[k].norm() * direction.norm();
    if (!(lengths > 0.))
      return {};
    cosines[k] = modes[k] * direction / lengths;
    angles[k] = std::acos(std::min(1., std::abs(cosines[k])));
  }
  const auto nearest =
      static_cast<unsigned int>(std::min_element(angles.begin(), angles.end()) - angles.begin());
  constexpr double clearly = 10. / 180. * dealii::numbers::PI;
  if (std::min(angles[(nearest + 1) % 3], angles[(nearest + 2) % 3]) < angles[nearest] + clearly)
    return {};
  return ThicknessAxis{nearest, cosines[nearest] < 0.};
}

std::array<unsigned int, n_element_nodes> turn_corners(const ThicknessAxis &axis) {
  // (j, k, i) is a rotation of (i, j, k), and so is (k, j, −i).
  const unsigned int next = (axis.axis + 1) % 3, last = (axis.axis + 2) % 3;
  const std::array<unsigned int, 3> bits = {axis.is_reversed ? last : next, axis.is_reversed ? next : last,
                                            axis.axis};
  std::array<unsigned int, n_element_nodes> nodes{};
  for (unsigned int a = 0; a < n_element_nodes; ++a) {
    for (unsigned int i = 0; i < 3; ++i)
      nodes[a] |= ((a >> i) & 1U) << bits[i];
    if (axis.is_reversed)
      nodes[a] ^= 1U << axis.axis;
  }
  return nodes;
}

ElementStress ElementStress::transfer(const unsigned int n_through, const ThicknessAxis &axis) const {
  if (n_through == 2 && n_through_ == 2)
    return *this;
  if (n_through > 2 && n_through_ > 2 && !(axis == axis_))
    return transfer(2).transfer(n_through, axis);
  ElementStress result(n_through, axis);
  const auto corners = turn_corners(n_through == 2 ? axis_ : axis);
  for (unsigned int c = 0; c < 4; ++c) {
    std::vector<PointStress> column;
    for (unsigned int l = 0; l < n_through_; ++l)
      column.push_back(points_[n_through_ == 2 ? corners[4 * l + c] : 4 * l + c]);
    transfer_column(column, n_through);
    for (unsigned int l = 0; l < n_through; ++l)
      result[n_through == 2 ? corners[4 * l + c] : 4 * l + c] = column[l];
  }
  return result;
}

} // namespace billet
