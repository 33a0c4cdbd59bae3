// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/local_state.h"

#include "billet/mechanics/modal_geometry.h"
#include "billet/output/element_fields.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::SymmetricTensor;
using dealii::Tensor;

namespace {

/// Means of the states of the points at equal positions along a direction of the brick.
class PointColumn {
public:
  PointColumn(const ElementPoints &points, const unsigned int direction) {
    const auto n_through = static_cast<unsigned int>(points.stress.size() / 4);
    const GaussRule &through = gauss_rule(n_through), &across = gauss_rule(2);
    const bool is_layered = n_through > 2;
    const auto corners = turn_corners(points.axis);
    const bool is_along = is_layered && direction == points.axis.axis;
    const GaussRule &own = is_along ? through : across;
    positions_ = own.points;
    weights_ = own.weights;
    states_.resize(positions_.size());
    for (unsigned int q = 0; q < points.stress.size(); ++q) {
      const unsigned int layer = q / 4, node = is_layered ? corners[q % 4] : q;
      const unsigned int place = !is_along                 ? (node >> direction) & 1U
                                 : points.axis.is_reversed ? n_through - 1 - layer
                                                           : layer;
      const double weight = is_along ? 0.25 : 0.5 * through.weights[layer];
      states_[place].deviator += weight * points.stress[q].deviator;
      states_[place].equivalent_plastic_strain += weight * points.stress[q].equivalent_plastic_strain;
    }
  }

  /// Returns the state at a coordinate from −1 to 1, less the mean: on lines between the positions,
  /// which continue beyond the outermost ones.
  PointStress variation(const double at) const {
    std::size_t upper = 1;
    while (upper + 1 < positions_.size() && at > positions_[upper])
      ++upper;
    const double part = (at - positions_[upper - 1]) / (positions_[upper] - positions_[upper - 1]);
    PointStress result;
    const auto add = [&](const double factor, const PointStress &state) {
      result.deviator += factor * state.deviator;
      result.equivalent_plastic_strain += factor * state.equivalent_plastic_strain;
    };
    add(1. - part, states_[upper - 1]);
    add(part, states_[upper]);
    for (std::size_t l = 0; l < states_.size(); ++l)
      add(-weights_[l], states_[l]);
    return result;
  }

private:
  std::vector<double> positions_, weights_;
  std::vector<PointStress> states_;
};

/// Returns the unit normals of the planes across the directions of a brick.
std::array<Tensor<1, 3>, 3> find_normals(const ElementVectors &positions) {
  const auto modes = compute_modes(positions);
  std::array<Tensor<1, 3>, 3> normals;
  for (unsigned int k = 0; k < 3; ++k) {
    const Tensor<1, 3> area = dealii::cross_product_3d(modes[(k + 1) % 3], modes[(k + 2) % 3]);
    normals[k] = area / area.norm();
  }
  return normals;
}

/// Returns what a tensor is in the plane across n.
SymmetricTensor<2, 3> plane_part(const SymmetricTensor<2, 3> &tensor, const Tensor<1, 3> &n) {
  const Tensor<1, 3> along = tensor * n;
  const double normal = along * n;
  SymmetricTensor<2, 3> result = tensor;
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = i; j < 3; ++j)
      result[i][j] += normal * n[i] * n[j] - along[i] * n[j] - n[i] * along[j];
  return result;
}

/// Returns the unit tensor of the plane across n.
SymmetricTensor<2, 3> unit_of_plane(const Tensor<1, 3> &n) {
  return dealii::unit_symmetric_tensor<3>() - dealii::symmetrize(dealii::outer_product(n, n));
}

/// Returns the strain per coordinate from -1 to 1 along a direction, by the difference between its
/// Gauss points. At a face that is an edge, as on the axis of a wedge, there is no gradient.
SymmetricTensor<2, 3> bending_strain(const ElementVectors &positions, const ElementVectors &deformed,
                                     const unsigned int direction, const Tensor<2, 3> &mean_inverse) {
  const auto gradient_at = [&](const dealii::Point<3> &place) {
    return jacobian_at(place, deformed) * dealii::invert(jacobian_at(place, positions));
  };
  const double half = 0.5 / std::sqrt(3.);
  dealii::Point<3> low(0.5, 0.5, 0.5), high = low;
  low[direction] -= half;
  high[direction] += half;
  return 0.25 / half * dealii::symmetrize((gradient_at(high) - gradient_at(low)) * mean_inverse);
}

double von_mises(const SymmetricTensor<2, 3> &deviator) { return std::sqrt(1.5) * deviator.norm(); }

} // namespace

double LocalStates::find_share(const ElementData &element, const double volume_ratio,
                               const double equivalent_plastic_strain,
                               const SymmetricTensor<2, 3> &bending) const {
  const FlowStress *flow = law_->flow_stress();
  if (flow == nullptr)
    return 1.;
  // Flow at a rate, or by another function than von Mises', may exceed the yield stress at the
  // points, too.
  double excess = 1.;
  for (const PointStress &point : element.points->stress)
    excess = std::max(excess, von_mises(point.deviator) / flow->stress(point.equivalent_plastic_strain));
  const double limit = excess * flow->stress(equivalent_plastic_strain) / volume_ratio;
  const SymmetricTensor<2, 3> mean = dealii::deviator(element.summary.cauchy_stress),
                              more = dealii::deviator(bending);
  if (!(von_mises(mean + more) > limit))
    return 1.;
  // 3/2 |mean + share more|² = limit²
  const double a = 1.5 * (more * more), b = 1.5 * (mean * more), c = 1.5 * (mean * mean) - limit * limit;
  return c < 0. ? (-b + std::sqrt(b * b - a * c)) / a : 0.;
}

LocalState LocalStates::evaluate(const ElementData &element, const dealii::Point<3> &coordinates) const {
  const Tensor<2, 3> F = mean_deformation_gradient(element.positions, element.displacements);
  const ElementSummary &summary = element.summary;
  LocalState state{summary.cauchy_stress, logarithmic_strain(F), summary.equivalent_plastic_strain};
  const double volume_ratio = dealii::determinant(F);
  if (element.points == nullptr || !(volume_ratio > 0.))
    return state;
  ElementVectors deformed = element.positions;
  for (unsigned int i = 0; i < n_element_dofs; ++i)
    deformed[i] += element.displacements[i];
  const auto normals = find_normals(deformed);
  std::array<SymmetricTensor<2, 3>, 3> stresses;
  SymmetricTensor<2, 3> bending;
  for (unsigned int k = 0; k < 3; ++k) {
    const PointStress variation = PointColumn(*element.points, k).variation(2. * coordinates[k] - 1.);
    const SymmetricTensor<2, 3> plane = plane_part(variation.deviator, normals[k]) / volume_ratio,
                                mean = 0.5 * dealii::trace(plane) * unit_of_plane(normals[k]);
    const PlaneFactors factors =
        formulation_.element.plane_factors(law_->elastic(), formulation_, element.positions, k);
    stresses[k] = factors.mean * mean + factors.rest * (plane - mean);
    bending += stresses[k];
    state.equivalent_plastic_strain += variation.equivalent_plastic_strain;
  }
  state.equivalent_plastic_strain = std::max(0., state.equivalent_plastic_strain);
  const double share = find_share(element, volume_ratio, state.equivalent_plastic_strain, bending);
  state.cauchy_stress += share * bending;
  const ElasticModuli elastic = law_->elastic();
  const Tensor<2, 3> inverse = dealii::invert(F);
  SymmetricTensor<2, 3> Y = dealii::unit_symmetric_tensor<3>();
  for (unsigned int k = 0; k < 3; ++k) {
    const SymmetricTensor<2, 3> plane =
        (2. * coordinates[k] - 1.) *
        plane_part(bending_strain(element.positions, deformed, k, inverse), normals[k]);
    // One point has no bending stress: its strain is that of an elastic plate, (1 − 2ν)/(1 − ν) of
    // the plane's.
    const double volumetric =
        formulation_.element.is_stabilised()
            ? 6. * elastic.shear / (3. * elastic.bulk + 4. * elastic.shear) * dealii::trace(plane)
            : share * dealii::trace(stresses[k]) / (3. * elastic.bulk);
    Y += plane + (volumetric - dealii::trace(plane)) *
                     dealii::symmetrize(dealii::outer_product(normals[k], normals[k]));
  }
  state.strain = logarithmic_strain(Tensor<2, 3>(Y) * F);
  return state;
}

} // namespace billet
