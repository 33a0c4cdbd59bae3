// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/bilinear_facet.h"

#include "billet/geometry/derivative.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {

constexpr double last_step = 1e-9; // of parameters: smaller steps are round-off

double into_range(const double value, const double range) { return std::min(std::max(value, -range), range); }

} // namespace

std::array<double, 2> BilinearFacet::compute_step(const Tensor<1, 3> &arm, const double range,
                                                  const std::array<double, 2> &at) const {
  // Derivatives of ½|X − x|². A parameter stays at the end of its range if its step points
  // outwards.
  const Tensor<1, 3> away = difference(at, arm);
  const std::array<Tensor<1, 3>, 2> tangents{surface_.e_1 + at[1] * surface_.e_3,
                                             surface_.e_2 + at[0] * surface_.e_3};
  const std::array<double, 2> gradient{away * tangents[0], away * tangents[1]};
  std::array<bool, 2> is_free{};
  for (unsigned int i = 0; i < 2; ++i)
    is_free[i] = !(at[i] >= range && gradient[i] <= 0.) && !(at[i] <= -range && gradient[i] >= 0.);
  const std::array<double, 2> diagonal{tangents[0].norm_square(), tangents[1].norm_square()};
  std::array<double, 2> step{};
  if (is_free[0] && is_free[1]) {
    // If the curvature leaves no minimum nearby, neglect it.
    for (const double mixed : {tangents[0] * tangents[1] + away * surface_.e_3, tangents[0] * tangents[1]}) {
      const double determinant = diagonal[0] * diagonal[1] - mixed * mixed;
      if (determinant > 1e-8 * diagonal[0] * diagonal[1]) {
        step[0] = (mixed * gradient[1] - diagonal[1] * gradient[0]) / determinant;
        step[1] = (mixed * gradient[0] - diagonal[0] * gradient[1]) / determinant;
        return step;
      }
    }
  }
  for (unsigned int i = 0; i < 2; ++i)
    if (is_free[i] && diagonal[i] > 0.)
      step[i] = -gradient[i] / diagonal[i];
  return step;
}

std::array<double, 2> BilinearFacet::minimise(const Tensor<1, 3> &arm, const double range,
                                              std::array<double, 2> at) const {
  const double rounding = 1e-14 * (arm.norm() + surface_.e_1.norm() + surface_.e_2.norm());
  double distance = difference(at, arm).norm();
  for (unsigned int iteration = 0; iteration < 100; ++iteration) {
    const std::array<double, 2> step = compute_step(arm, range, at);
    const double size = std::max(std::abs(step[0]), std::abs(step[1]));
    bool is_lower = false;
    // A full step may increase the distance if it neglects the curvature or is clipped to the
    // range.
    for (double length = 1.; !is_lower && length > 1e-10; length *= 0.5) {
      const std::array<double, 2> next{into_range(at[0] + length * step[0], range),
                                       into_range(at[1] + length * step[1], range)};
      const double next_distance = difference(next, arm).norm();
      is_lower = next_distance <= distance + rounding;
      if (is_lower) {
        at = next;
        distance = next_distance;
      }
    }
    if (!is_lower || size < last_step)
      break;
  }
  return at;
}

std::array<double, 2> BilinearFacet::nearest_on_edge(const Tensor<1, 3> &arm) const {
  std::array<double, 2> nearest{};
  double minimum = std::numeric_limits<double>::infinity();
  for (unsigned int fixed = 0; fixed < 2; ++fixed)
    for (const double end : {-1., 1.}) { // a straight line
      std::array<double, 2> at{};
      at[fixed] = end;
      const Tensor<1, 3> along =
          fixed == 0 ? surface_.e_2 + end * surface_.e_3 : surface_.e_1 + end * surface_.e_3;
      const double square = along.norm_square();
      if (square > 0.)
        at[1 - fixed] = into_range(-(difference(at, arm) * along) / square, 1.);
      const double distance_square = difference(at, arm).norm_square();
      if (distance_square < minimum) {
        minimum = distance_square;
        nearest = at;
      }
    }
  return nearest;
}

FacetProjection BilinearFacet::project(const Tensor<1, 3> &x, const FacetLimits &limits,
                                       const std::array<double, 2> &start) const {
  FacetProjection projection;
  if (!has_area_)
    return projection;
  const auto excess_of = [](const std::array<double, 2> &at) {
    return 0.5 * std::max({std::abs(at[0]) - 1., std::abs(at[1]) - 1., 0.});
  };
  const Tensor<1, 3> arm = surface_.e_0 - x;
  // This keeps the end of the range outside the tolerance.
  const double range = 1.1 + 2. * limits.tolerance;
  std::array<double, 2> at = minimise(arm, range, {into_range(start[0], range), into_range(start[1], range)});
  const std::array<bool, 2> is_undefined = surface_.undefined_at(at);
  for (unsigned int i = 0; i < 2; ++i)
    if (is_undefined[i])
      at[i] = 0.;
  projection.excess = excess_of(at);
  bool is_straight = projection.excess <= limits.tolerance;
  if (!is_straight) {
    at = minimise(arm, 1., {into_range(at[0], 1.), into_range(at[1], 1.)});
    const std::array<double, 2> other = nearest_on_edge(arm);
    if (difference(other, arm).norm_square() < difference(at, arm).norm_square())
      at = minimise(arm, 1., other);
    // A strongly curved surface may have another closest point.
    is_straight = std::max(std::abs(at[0]), std::abs(at[1])) < 1.;
    if (is_straight)
      projection.excess = 0.;
  }
  const Tensor<1, 3> area_vector = surface_.area_vector(at);
  projection.normal = area_vector / area_vector.norm();
  projection.gap = -(difference(at, arm) * projection.normal);
  projection.parameters = at;
  projection.weights = facet::weights(at);
  projection.share = facet::share_at(0.5 * (1. - std::abs(at[0])), limits.zone) *
                     facet::share_at(0.5 * (1. - std::abs(at[1])), limits.zone);
  projection.exists = is_straight;
  return projection;
}

template <class Number>
FacetProjectionOf<Number> BilinearFacet::follow(const facet::ExpansionOf<Number> &surface,
                                                const Tensor<1, 3, Number> &x, const FacetLimits &limits,
                                                const FacetProjection &found) {
  const auto &e_0 = surface.e_0, &e_1 = surface.e_1, &e_2 = surface.e_2, &e_3 = surface.e_3;
  const auto difference = [&](const std::array<Number, 2> &at) {
    return (e_0 - x) + at[0] * e_1 + at[1] * e_2 + Number(at[0] * at[1]) * e_3;
  };
  std::array<Number, 2> at{found.parameters[0], found.parameters[1]};
  const Tensor<1, 3, Number> away = difference(at), along_xi = e_1 + at[1] * e_3,
                             along_eta = e_2 + at[0] * e_3;
  const Number r_xi = away * along_xi, r_eta = away * along_eta;
  const double xi_xi = value_of(along_xi.norm_square()), eta_eta = value_of(along_eta.norm_square()),
               mixed = value_of(along_xi * along_eta + away * e_3),
               determinant = xi_xi * eta_eta - mixed * mixed;
  const std::array<bool, 2> is_undefined = surface.undefined_at(found.parameters);
  if (is_undefined[0])
    at[1] -= r_eta / eta_eta;
  else if (is_undefined[1])
    at[0] -= r_xi / xi_xi;
  else {
    at[0] -= (eta_eta * r_xi - mixed * r_eta) / determinant;
    at[1] -= (xi_xi * r_eta - mixed * r_xi) / determinant;
  }

  FacetProjectionOf<Number> projection;
  const Tensor<1, 3, Number> area_vector = surface.area_vector(at);
  projection.normal = area_vector / area_vector.norm();
  projection.gap = -(difference(at) * projection.normal);
  projection.parameters = at;
  projection.weights = facet::weights(at);
  projection.excess = found.excess;
  using std::abs;
  projection.share = facet::share_at(Number(0.5 * (1. - abs(at[0]))), limits.zone) *
                     facet::share_at(Number(0.5 * (1. - abs(at[1]))), limits.zone);
  projection.exists = true;
  return projection;
}

template FacetProjection BilinearFacet::follow(const facet::Expansion &, const Tensor<1, 3> &,
                                               const FacetLimits &, const FacetProjection &);
template FacetProjectionOf<Derivative> BilinearFacet::follow(const facet::ExpansionOf<Derivative> &,
                                                             const Tensor<1, 3, Derivative> &,
                                                             const FacetLimits &, const FacetProjection &);

} // namespace billet
