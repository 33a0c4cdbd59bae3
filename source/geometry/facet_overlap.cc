// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/facet_overlap.h"

#include "billet/geometry/derivative.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {

template <class Number> using PlanePoint = std::array<Number, 2>;

template <class Number> Number cross(const PlanePoint<Number> &a, const PlanePoint<Number> &b) {
  return a[0] * b[1] - a[1] * b[0];
}
template <class Number>
PlanePoint<Number> operator-(const PlanePoint<Number> &a, const PlanePoint<Number> &b) {
  return {a[0] - b[0], a[1] - b[1]};
}

/// Convex polygon in the target's plane.
template <class Number> struct Polygon {
  std::array<PlanePoint<Number>, 9> corners;
  unsigned int n = 0;

  void add(const PlanePoint<Number> &corner) { corners[n++] = corner; }

  /// Clips the polygon where the linear function `value` is < 0. A corner nearer to that line than
  /// `rounding` counts as on it, since edges of matching facets coincide.
  template <class Function> void clip(const Function &value, const double rounding) {
    if (n == 0)
      return;
    std::array<Number, 9> values;
    bool is_whole = true;
    for (unsigned int i = 0; i < n; ++i) {
      values[i] = value(corners[i]);
      is_whole = is_whole && values[i] >= -rounding;
    }
    if (is_whole)
      return;
    Polygon rest;
    for (unsigned int i = 0; i < n; ++i) {
      const unsigned int next = i + 1 == n ? 0 : i + 1;
      const bool is_in = values[i] >= -rounding, is_next_in = values[next] >= -rounding;
      if (is_in)
        rest.add(corners[i]);
      if (is_in != is_next_in && (is_in ? values[i] : values[next]) > rounding) {
        const Number part = values[i] / (values[i] - values[next]);
        const PlanePoint<Number> edge = corners[next] - corners[i];
        rest.add({corners[i][0] + part * edge[0], corners[i][1] + part * edge[1]});
      }
    }
    *this = rest;
    if (n < 3)
      n = 0;
  }
};

/// Facet as four triangles in the target's plane, around the middle, counter-clockwise seen from
/// its own side, with heights above that plane.
template <class Number> struct Fan {
  std::array<PlanePoint<Number>, 4> corners; ///< corners in the order of FacetCorners
  std::array<Number, 4> heights;
  PlanePoint<Number> middle;
  Number middle_height;

  Fan(const FacetCornersOf<Number> &x, const Tensor<1, 3, Number> &origin,
      const std::array<Tensor<1, 3, Number>, 3> &axes, const std::array<double, 4> &gap_offsets) {
    middle = {Number(0.), Number(0.)};
    middle_height = 0.;
    for (unsigned int a = 0; a < 4; ++a) {
      const Tensor<1, 3, Number> arm = x[a] - origin;
      corners[a] = {arm * axes[0], arm * axes[1]};
      heights[a] = arm * axes[2] - gap_offsets[a];
      middle[0] += 0.25 * corners[a][0];
      middle[1] += 0.25 * corners[a][1];
      middle_height += 0.25 * heights[a];
    }
  }
};

/// Linear function on the plane.
template <class Number> struct Linear {
  Number constant, along_q, along_r;
  Number operator()(const PlanePoint<Number> &x) const { return constant + along_q * x[0] + along_r * x[1]; }
};

/// One triangle of a fan, with the functions of its facet's corners.
template <class Number> class Triangle {
public:
  Triangle(const Fan<Number> &fan, const unsigned int edge)
      : first_(facet::around[edge]), second_(facet::around[(edge + 1) % 4]), fan_(fan) {
    const PlanePoint<Number> &a = fan.corners[first_], &b = fan.corners[second_], &c = fan.middle;
    double_area = cross<Number>(a - c, b - c);
    if (double_area == 0.)
      return;
    barycentric_ = {line(b, c), line(c, a), line(a, b)};
  }

  Number double_area; ///< signed: > 0 if counter-clockwise
  /// Returns the linear functions that are 0 on an edge and 1 at the opposite corner.
  const std::array<Linear<Number>, 3> &barycentric() const { return barycentric_; }
  std::array<PlanePoint<Number>, 3> corners() const {
    return {fan_.corners[first_], fan_.corners[second_], fan_.middle};
  }
  Linear<Number> height() const {
    Linear<Number> result{Number(0.), Number(0.), Number(0.)};
    const std::array<Number, 3> values{fan_.heights[first_], fan_.heights[second_], fan_.middle_height};
    for (unsigned int i = 0; i < 3; ++i) {
      result.constant += values[i] * barycentric_[i].constant;
      result.along_q += values[i] * barycentric_[i].along_q;
      result.along_r += values[i] * barycentric_[i].along_r;
    }
    return result;
  }
  /// Returns the functions of the facet's four corners at x.
  std::array<Number, 4> functions(const PlanePoint<Number> &x) const {
    const Number of_middle = 0.25 * barycentric_[2](x);
    std::array<Number, 4> values{of_middle, of_middle, of_middle, of_middle};
    values[first_] += barycentric_[0](x);
    values[second_] += barycentric_[1](x);
    return values;
  }

  /// Returns ξ (i = 0) or η (i = 1) of the facet as a linear function.
  Linear<Number> parameter(const unsigned int i) const {
    const double of_first = facet::signs[first_][i], of_second = facet::signs[second_][i];
    const Linear<Number> &a = barycentric_[0], &b = barycentric_[1];
    return {of_first * a.constant + of_second * b.constant, of_first * a.along_q + of_second * b.along_q,
            of_first * a.along_r + of_second * b.along_r};
  }

private:
  /// Returns the linear function that is 0 on the line from p to q, scaled by the triangle's area.
  Linear<Number> line(const PlanePoint<Number> &p, const PlanePoint<Number> &q) const {
    const Number along_q = -(q[1] - p[1]) / double_area, along_r = (q[0] - p[0]) / double_area;
    return {Number(-(along_q * p[0] + along_r * p[1])), along_q, along_r};
  }

  unsigned int first_, second_;
  const Fan<Number> &fan_;
  std::array<Linear<Number>, 3> barycentric_;
};

/// Heights of the smooth surfaces, which reduce the gap between a slave's and a target's triangle.
template <class Number> class Heights {
public:
  Heights(const Triangle<Number> &slave, const FacetBulge &slave_bulge, const Triangle<Number> &target,
          const FacetBulge &target_bulge)
      : sides_{{{slave_bulge, {slave.parameter(0), slave.parameter(1)}},
                {target_bulge, {target.parameter(0), target.parameter(1)}}}} {}

  Number operator()(const PlanePoint<Number> &x) const {
    Number sum = 0.;
    for (const Side &side : sides_)
      sum += facet::height<Number>(side.bulge, {side.parameters[0](x), side.parameters[1](x)});
    return sum;
  }
  /// Returns the linear function with the same value and slope at x.
  Linear<Number> about(const PlanePoint<Number> &x) const {
    Linear<Number> result{(*this)(x), Number(0.), Number(0.)};
    for (const Side &side : sides_) {
      const std::array<Number, 2> slope =
          facet::height_gradient<Number>(side.bulge, {side.parameters[0](x), side.parameters[1](x)});
      for (unsigned int i = 0; i < 2; ++i) {
        result.along_q += slope[i] * side.parameters[i].along_q;
        result.along_r += slope[i] * side.parameters[i].along_r;
      }
    }
    result.constant -= result.along_q * x[0] + result.along_r * x[1];
    return result;
  }

private:
  struct Side {
    FacetBulge bulge;
    std::array<Linear<Number>, 2> parameters;
  };
  std::array<Side, 2> sides_;
};

template <class Number, class Gap>
void integrate(const Polygon<Number> &polygon, const Triangle<Number> &slave, const Triangle<Number> &target,
               const Gap &gap, FacetOverlapOf<Number> &overlap) {
  for (unsigned int i = 1; i + 1 < polygon.n; ++i) {
    const std::array<PlanePoint<Number>, 3> x{polygon.corners[0], polygon.corners[i], polygon.corners[i + 1]};
    using std::abs;
    const Number third = abs(cross<Number>(x[1] - x[0], x[2] - x[0])) / 6.;
    for (unsigned int j = 0; j < 3; ++j) { // edge midpoints: exact for quadratic functions
      const PlanePoint<Number> &a = x[j], &b = x[(j + 1) % 3];
      const PlanePoint<Number> middle{0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])};
      const std::array<Number, 4> phi = slave.functions(middle), psi = target.functions(middle);
      const Number g = gap(middle);
      for (unsigned int k = 0; k < 4; ++k) {
        const Number part = third * phi[k];
        overlap.areas[k] += part;
        overlap.gaps[k] += part * g;
        for (unsigned int l = 0; l < 4; ++l) {
          overlap.slave_parts[k][l] += part * phi[l];
          overlap.target_parts[k][l] += part * psi[l];
        }
      }
    }
  }
}

} // namespace

template <class Number>
FacetOverlapOf<Number> compute_overlap(const FacetCornersOf<Number> &slave,
                                       const FacetCornersOf<Number> &target, const double penetration,
                                       const std::array<double, 4> &gap_offsets,
                                       const std::array<double, 4> &augmentation,
                                       const FacetBulge &slave_bulge, const FacetBulge &target_bulge) {
  FacetOverlapOf<Number> overlap;
  const bool is_curved = facet::has_height(slave_bulge) || facet::has_height(target_bulge);
  std::array<double, 4> lowered = gap_offsets;
  for (unsigned int a = 0; a < 4; ++a)
    lowered[a] += augmentation[a];
  const facet::ExpansionOf<Number> surface(target), slave_surface(slave);
  if (!surface.has_area() || !slave_surface.has_area())
    return overlap;
  const Tensor<1, 3, Number> area_vector = surface.mean_area_vector();
  overlap.normal = area_vector / area_vector.norm();
  if (!(slave_surface.mean_area_vector() * overlap.normal < 0.))
    return overlap;
  const Tensor<1, 3, Number> q = surface.e_1 / surface.e_1.norm();
  const std::array<Tensor<1, 3, Number>, 3> axes{q, dealii::cross_product_3d(overlap.normal, q),
                                                 overlap.normal};
  const Fan<Number> of_slave(slave, surface.e_0, axes, lowered), of_target(target, surface.e_0, axes, {});
  // Maximum mismatch of matching corners, relative to a facet's size.
  constexpr double rounding = 1e-10;
  const double height_rounding = rounding * penetration;
  for (unsigned int t = 0; t < 4; ++t) {
    const Triangle<Number> below(of_target, t);
    if (!(below.double_area > 0.)) // degenerate at the tip of a triangular facet
      continue;
    const Linear<Number> low = below.height();
    for (unsigned int s = 0; s < 4; ++s) {
      const Triangle<Number> above(of_slave, s);
      if (!(above.double_area < 0.)) // it does not face the target
        continue;
      Polygon<Number> polygon;
      for (const auto &corner : above.corners())
        polygon.add(corner);
      for (const auto &side : below.barycentric())
        polygon.clip(side, rounding);
      if (polygon.n == 0)
        continue;
      const Linear<Number> high = above.height();
      const Linear<Number> gap{high.constant - low.constant, high.along_q - low.along_q,
                               high.along_r - low.along_r};
      const auto clip = [&](const Linear<Number> &g) {
        polygon.clip([&](const PlanePoint<Number> &x) { return Number(-g(x)); }, height_rounding);
        polygon.clip([&](const PlanePoint<Number> &x) { return Number(penetration + g(x)); },
                     height_rounding);
      };
      if (!is_curved) {
        clip(gap);
        integrate(polygon, above, below, gap, overlap);
        continue;
      }
      const Heights<Number> heights(above, slave_bulge, below, target_bulge);
      PlanePoint<Number> middle{Number(0.), Number(0.)};
      for (unsigned int i = 0; i < polygon.n; ++i)
        for (unsigned int j = 0; j < 2; ++j)
          middle[j] += polygon.corners[i][j] / static_cast<double>(polygon.n);
      const Linear<Number> raised = heights.about(middle);
      clip({gap.constant - raised.constant, gap.along_q - raised.along_q, gap.along_r - raised.along_r});
      integrate(
          polygon, above, below, [&](const PlanePoint<Number> &x) { return Number(gap(x) - heights(x)); },
          overlap);
    }
  }
  for (unsigned int a = 0; a < 4; ++a) {
    overlap.exists = overlap.exists || overlap.areas[a] > 0.;
    overlap.penetrations[a] = -overlap.gaps[a];
    for (unsigned int b = 0; b < 4; ++b) // Σ φ_b a_b is the distance by which it was lowered
      overlap.gaps[a] += augmentation[b] * overlap.slave_parts[a][b];
  }
  return overlap;
}

template FacetOverlapOf<double> compute_overlap(const FacetCorners &, const FacetCorners &, double,
                                                const std::array<double, 4> &, const std::array<double, 4> &,
                                                const FacetBulge &, const FacetBulge &);
template FacetOverlapOf<Derivative> compute_overlap(const FacetCornersOf<Derivative> &,
                                                    const FacetCornersOf<Derivative> &, double,
                                                    const std::array<double, 4> &,
                                                    const std::array<double, 4> &, const FacetBulge &,
                                                    const FacetBulge &);

} // namespace billet
