// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_PARAMETRIC_CURVE_H
#define BILLET_GEOMETRY_PARAMETRIC_CURVE_H

#include <deal.II/base/tensor.h>

#include <functional>
#include <vector>

namespace billet {

/// Point p(t) of a curve, with derivatives.
struct CurvePoint {
  dealii::Tensor<1, 3> p, p_t, p_tt;
};

/// Curve given by its values, and a polyline on it.
class SampledCurve {
public:
  using Curve = std::function<CurvePoint(double)>;

  /// Makes the curve from the first to the last of the ascending parameters, between which its
  /// direction changes little.
  SampledCurve(Curve curve, std::vector<double> parameters);

  /// Returns the parameter of the point nearest to x, by Newton's method from each part of the
  /// polyline that is nearer than its neighbours.
  double nearest(const dealii::Tensor<1, 3> &x) const;

private:
  double descend(const dealii::Tensor<1, 3> &x, double t) const;

  Curve curve_;
  std::vector<double> parameters_;
  std::vector<dealii::Tensor<1, 3>> points_;
};

} // namespace billet

#endif
