// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/parametric_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace billet {

using dealii::Tensor;

SampledCurve::SampledCurve(Curve curve, std::vector<double> parameters)
    : curve_(std::move(curve)), parameters_(std::move(parameters)) {
  for (const double t : parameters_)
    points_.push_back(curve_(t).p);
}

double SampledCurve::nearest(const Tensor<1, 3> &x) const {
  const std::size_t n = points_.size() - 1;
  std::vector<double> squares(n + 2, std::numeric_limits<double>::infinity()), starts(n + 2);
  for (std::size_t i = 0; i < n; ++i) {
    const Tensor<1, 3> chord = points_[i + 1] - points_[i];
    const double length = chord.norm_square();
    const double part = length > 0. ? std::clamp((x - points_[i]) * chord / length, 0., 1.) : 0.;
    squares[i + 1] = (x - points_[i] - part * chord).norm_square();
    starts[i + 1] = parameters_[i] + part * (parameters_[i + 1] - parameters_[i]);
  }
  double minimum = std::numeric_limits<double>::infinity(), result = parameters_.front();
  for (std::size_t i = 1; i <= n; ++i) {
    if (squares[i] > squares[i - 1] || squares[i] > squares[i + 1])
      continue;
    const double t = descend(x, starts[i]), square = (x - curve_(t).p).norm_square();
    if (square < minimum) {
      minimum = square;
      result = t;
    }
  }
  return result;
}

double SampledCurve::descend(const Tensor<1, 3> &x, double t) const {
  const double first = parameters_.front(), last = parameters_.back();
  for (unsigned int n = 0; n < 50; ++n) {
    const CurvePoint here = curve_(t);
    const Tensor<1, 3> arm = x - here.p;
    const double metric = here.p_t.norm_square(), convex = metric - arm * here.p_tt;
    if (metric == 0.)
      break;
    double step = (arm * here.p_t) / (convex > 1e-10 * metric ? convex : metric);
    for (unsigned int cut = 0; cut < 30; ++cut, step *= 0.5)
      if ((x - curve_(std::clamp(t + step, first, last)).p).norm_square() <= arm.norm_square())
        break;
    const double before = t;
    t = std::clamp(t + step, first, last);
    if (std::abs(t - before) <= 1e-14 * (last - first))
      break;
  }
  return t;
}

} // namespace billet
