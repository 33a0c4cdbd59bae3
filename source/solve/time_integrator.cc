// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/time_integrator.h"

#include <algorithm>
#include <cmath>

namespace billet {

TimeIntegrator TimeIntegrator::newmark(const double beta, const double gamma) {
  return {0., 0., beta, gamma};
}

TimeIntegrator TimeIntegrator::hilber_hughes_taylor(const double alpha) {
  return {0., -alpha, 0.25 * (1. - alpha) * (1. - alpha), 0.5 - alpha};
}

TimeIntegrator TimeIntegrator::generalised_alpha(const double spectral_radius) {
  const double alpha_m = (2. * spectral_radius - 1.) / (spectral_radius + 1.);
  const double alpha_f = spectral_radius / (spectral_radius + 1.);
  const double shift = 1. - alpha_m + alpha_f;
  return {alpha_m, alpha_f, 0.25 * shift * shift, 0.5 - alpha_m + alpha_f};
}

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
