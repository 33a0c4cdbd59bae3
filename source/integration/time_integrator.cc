// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/integration/time_integrator.h"

#include <algorithm>
#include <cmath>

namespace billet {

TimeIntegrator::Rate TimeIntegrator::acceleration(const double step) const {
  const double increment = 1. / (beta_ * step * step);
  return {increment, -increment * step, 1. - 0.5 / beta_};
}

TimeIntegrator::Rate TimeIntegrator::velocity(const double step) const {
  const Rate a = acceleration(step);
  return {step * gamma_ * a.increment, 1. + step * gamma_ * a.velocity,
          step * (1. - gamma_ + gamma_ * a.acceleration)};
}

double TimeIntegrator::error_factor() const { return std::max(1. / 12., std::abs(beta_ - 1. / 6.)); }

} // namespace billet
