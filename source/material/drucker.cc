// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/drucker.h"

#include <cmath>
#include <sstream>

namespace billet {

double min_drucker_stiffness(const IsochoricEnergy &energy, const IsochoricStrains &e) {
  const auto H = energy.respond(e).slope;
  const double p = 1. / std::sqrt(2.), q = 1. / std::sqrt(6.);
  const std::array<double, 3> u = {p, -p, 0.}, v = {q, q, -2. * q};
  double uu = 0., uv = 0., vv = 0.;
  for (unsigned int a = 0; a < 3; ++a)
    for (unsigned int b = 0; b < 3; ++b) {
      uu += u[a] * H[a][b] * u[b];
      uv += u[a] * H[a][b] * v[b];
      vv += v[a] * H[a][b] * v[b];
    }
  return (0.5 * (uu + vv) - std::hypot(0.5 * (uu - vv), uv)) / (2. * energy.shear_modulus());
}

namespace {

/// Returns the stretch nearest to 1 towards `end` beyond which the condition fails; `end` if there
/// is none.
double find_limit(const IsochoricEnergy &energy, const std::array<double, 3> &direction, const double end) {
  constexpr unsigned int n_steps = 2000;
  for (unsigned int i = 1; i <= n_steps; ++i) {
    const double strain = std::log(end) * i / n_steps;
    if (!(min_drucker_stiffness(energy,
                                {strain * direction[0], strain * direction[1], strain * direction[2]}) > 0.))
      return std::exp(std::log(end) * (i - 1) / n_steps);
  }
  return end;
}

} // namespace

std::array<StableRange, 3> find_stable_ranges(const IsochoricEnergy &energy) {
  const auto range = [&](const char *mode, const std::array<double, 3> &direction) {
    return StableRange{mode, find_limit(energy, direction, min_searched_stretch),
                       find_limit(energy, direction, greatest_searched_stretch)};
  };
  return {range("uniaxial", {1., -0.5, -0.5}), range("equibiaxial", {1., 1., -2.}),
          range("planar", {1., 0., -1.})};
}

std::string describe_stability(const IsochoricEnergy &energy) {
  std::ostringstream text;
  text.precision(3);
  for (const StableRange &range : find_stable_ranges(energy))
    if (range.lowest > min_searched_stretch || range.highest < greatest_searched_stretch)
      text << (text.str().empty() ? "stable (Drucker) at stretches of " : ", ") << range.lowest << " to "
           << range.highest << " (" << range.mode << ")";
  return text.str();
}

} // namespace billet
