// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_THICKNESS_H
#define BILLET_MECHANICS_THICKNESS_H

#include "billet/mechanics/modal_geometry.h"

#include <deal.II/base/symmetric_tensor.h>

#include <array>
#include <optional>
#include <vector>

namespace billet {

/// Numbers of integration points through a thickness that a scene may ask for.
inline constexpr std::array<unsigned int, 4> all_points_through = {2, 3, 5, 7};

/// Gauss points on [−1, 1] in increasing order, and their weights, which sum to 1.
struct GaussRule {
  std::vector<double> points, weights;
};
/// Returns the rule with one of `all_points_through`.
const GaussRule &gauss_rule(unsigned int n_through);

/// Axis of a brick (0, 1, 2: ξ, η, ζ) through the thickness, and whether the thickness direction is
/// opposite to it.
struct ThicknessAxis {
  unsigned int axis = 2;
  bool is_reversed = false;

  /// Returns the axis as one number, for checkpoints.
  unsigned int code() const { return axis + (is_reversed ? 3 : 0); }
  static ThicknessAxis from_code(const unsigned int code) { return {code % 3, code >= 3}; }
  bool operator==(const ThicknessAxis &other) const { return code() == other.code(); }
};

/// Returns the axis nearest to a direction; none if another axis is as near within 10 degrees, or
/// if the direction is zero.
std::optional<ThicknessAxis> find_thickness_axis(const ElementVectors &positions,
                                                 const dealii::Tensor<1, 3> &direction);

/// Returns the nodes (or corner points) of the brick in the order of rotated directions, of which
/// the third is the thickness direction. Node a of the rotated brick is node turn_corners(axis)[a]
/// of the brick.
std::array<unsigned int, n_element_nodes> turn_corners(const ThicknessAxis &axis);

/// State of a material point, independent of its kinematics and, without its memory, of its law;
/// sufficient to continue with others.
struct PointStress {
  dealii::SymmetricTensor<2, 3> deviator; ///< deviator of the Kirchhoff stress [stress]
  double equivalent_plastic_strain = 0.;
  std::vector<double> memory; ///< PointLaw::memory(); empty for other laws

  /// Adds a part of another state to this one.
  void add(double part, const PointStress &other);
};

/// States of the points of a brick. With two points through each direction they are in the order of
/// the corners. With more they are in layers of four from inside to outside; within a layer they
/// are in the order of turn_corners().
class ElementStress {
public:
  explicit ElementStress(unsigned int n_through = 2, const ThicknessAxis &axis = {})
      : n_through_(n_through), axis_(axis), points_(std::size_t{4} * n_through) {}

  PointStress &operator[](const std::size_t q) { return points_[q]; }
  const PointStress &operator[](const std::size_t q) const { return points_[q]; }
  std::size_t size() const { return points_.size(); }
  std::vector<PointStress>::iterator begin() { return points_.begin(); }
  std::vector<PointStress>::iterator end() { return points_.end(); }
  std::vector<PointStress>::const_iterator begin() const { return points_.begin(); }
  std::vector<PointStress>::const_iterator end() const { return points_.end(); }

  /// Returns the states on another number of layers, (B11) of doc/theory.md: means over the part of
  /// the thickness that belongs to each point. The transfer preserves the mean of each column and
  /// never exceeds the yield stress.
  ElementStress transfer(unsigned int n_through, const ThicknessAxis &axis = {}) const;

private:
  unsigned int n_through_;
  ThicknessAxis axis_;
  std::vector<PointStress> points_;
};

/// Average over a layer of points, for output.
struct LayerSummary {
  dealii::SymmetricTensor<2, 3> cauchy_stress; ///< [stress]
  double equivalent_plastic_strain = 0.;
};
/// Layers in the output: the first, the middle and the last one along the thickness direction.
constexpr std::array<const char *, 3> layer_names = {"inner", "membrane", "outer"};
using LayerSummaries = std::array<LayerSummary, layer_names.size()>;

} // namespace billet

#endif
