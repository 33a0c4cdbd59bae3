// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/hencky.h"
#include "billet/material/law_trials.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace billet {

using dealii::SymmetricTensor;
using dealii::Tensor;

double min_acoustic_eigenvalue(const StressRates &rates, const SymmetricTensor<2, 3> &tau) {
  constexpr unsigned int entry[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  constexpr unsigned int n_angles = 6; // intervals per right angle
  const double step = std::acos(0.) / n_angles;
  double minimum = std::numeric_limits<double>::infinity();
  for (unsigned int a = 0; a <= n_angles; ++a)
    for (unsigned int b = 0; b < 4 * n_angles; ++b) {
      const Tensor<1, 3> n({std::sin(a * step) * std::cos(b * step), std::sin(a * step) * std::sin(b * step),
                            std::cos(a * step)});
      const Tensor<1, 3> traction = tau * n;
      Tensor<2, 3> Q;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int k = 0; k < 3; ++k) {
          Q[i][k] = -traction[i] * n[k];
          for (unsigned int p = 0; p < 3; ++p)
            for (unsigned int q = 0; q < 3; ++q)
              Q[i][k] += rates[entry[i][p]][3 * k + q] * n[q] * n[p];
        }
      minimum = std::min(minimum, dealii::eigenvalues(dealii::symmetrize(Q))[2]);
    }
  return minimum;
}

namespace {

/// Path of the deformation gradient over the logarithm x of its stretch.
struct Mode {
  const char *name;
  Tensor<2, 3> (*gradient)(double x);
};

Tensor<2, 3> diagonal(const double a, const double b, const double c) {
  Tensor<2, 3> F;
  F[0][0] = std::exp(a);
  F[1][1] = std::exp(b);
  F[2][2] = std::exp(c);
  return F;
}

constexpr std::array<Mode, 5> modes = {
    {{"uniaxial, isochoric", [](const double x) { return diagonal(x, -0.5 * x, -0.5 * x); }},
     {"equibiaxial, isochoric", [](const double x) { return diagonal(x, x, -2. * x); }},
     {"pure shear", [](const double x) { return diagonal(x, -x, 0.); }},
     {"uniaxial strain", [](const double x) { return diagonal(x, 0., 0.); }},
     {"volume, by its edge", [](const double x) { return diagonal(x, x, x); }}}};

} // namespace

std::vector<SafeRange> find_safe_ranges(const PointLaw &law, const CertificationSettings &settings) {
  constexpr double step = 0.02, farthest = 1.6; // logarithms: stretches of 0.2 to 5
  // Perfect plasticity is at the limit: round-off must not decide.
  const double slack = 1e-9 * law.elastic().shear;
  const auto n_steps = static_cast<unsigned int>(std::lround(farthest / step));
  std::vector<SafeRange> ranges;
  for (const Mode &mode : modes) {
    SafeRange range;
    range.mode = mode.name;
    for (const double sign : {-1., 1.}) {
      LawPoint point(law, settings.temperature);
      unsigned int i = 1;
      for (; i <= n_steps; ++i) {
        StressRates rates;
        const auto tau = point.evaluate(mode.gradient(sign * i * step), settings.dt, &rates);
        if (!tau || !(min_acoustic_eigenvalue(rates, *tau) > -slack))
          break;
        point.commit();
      }
      (sign < 0. ? range.minimum : range.maximum) = std::exp(sign * (i - 1) * step);
      (sign < 0. ? range.is_open_below : range.is_open_above) = i > n_steps;
    }
    ranges.push_back(range);
  }
  return ranges;
}

} // namespace billet
