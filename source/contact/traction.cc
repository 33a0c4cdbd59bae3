// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/traction.h"

#include <algorithm>
#include <cmath>

namespace billet {

FrameTraction compute_frictionless_traction(const double normal_stiffness, const double gap) {
  FrameTraction traction{};
  traction.status = ContactStatus::slip;
  traction.pressure = std::max(0., -normal_stiffness * gap);
  traction.tangent[2][2] = normal_stiffness;
  return traction;
}

namespace {

/// Returns the slip γ >= 0 with |t*| − k_t γ = L(p, γ/Δt), by Newton's method inside a bracket. It
/// exists and is unique if L does not increase with the slip rate and its decrease does not get
/// steeper.
double solve_slip(const FrictionLaw &law, const double pressure, const double trial, const double k_t,
                  const double per_time) {
  const auto excess = [&](const double slip) {
    return trial - k_t * slip - law.limit(pressure, slip * per_time).value;
  };
  // The excess is positive at γ = 0, and not positive where the slip has consumed the trial
  // traction.
  double low = 0., high = trial / k_t;
  double slip = std::max(0., (trial - law.limit(pressure, 0.).value) / k_t);
  constexpr unsigned int max_iterations = 100; // bisection alone takes 50
  constexpr double round_off = 1e-15;
  for (unsigned int i = 0; i < max_iterations; ++i) {
    const double value = excess(slip);
    (value > 0. ? low : high) = slip;
    const double slope = -k_t - per_time * law.limit(pressure, slip * per_time).rate_slope;
    double next = slope < 0. ? slip - value / slope : low;
    if (!(next > low && next < high))
      next = 0.5 * (low + high);
    if (std::abs(next - slip) <= round_off * trial / k_t)
      return next;
    slip = next;
  }
  return slip;
}

} // namespace

TangentForm form_of(const ContactTangent kind) {
  switch (kind) {
  case ContactTangent::numerical:
    return TangentForm::numerical;
  case ContactTangent::exact:
    return TangentForm::exact;
  case ContactTangent::automatic: // resolved by the scene
  case ContactTangent::consistent:
  case ContactTangent::continuum:
  case ContactTangent::symmetrised_upper:
  case ContactTangent::symmetrised_lower:
  case ContactTangent::symmetrised_mean:
    break;
  }
  return TangentForm::closed;
}

FrictionTangent FrictionTangent::of(const ContactTangent kind) {
  switch (kind) {
  case ContactTangent::automatic: // resolved by the scene
  case ContactTangent::exact:
  case ContactTangent::numerical:
  case ContactTangent::consistent:
    return {};
  case ContactTangent::continuum:
    return {1., 1., 0.};
  case ContactTangent::symmetrised_upper:
    return {0., 1., 1.};
  case ContactTangent::symmetrised_lower:
    return {0., 0., 0.};
  case ContactTangent::symmetrised_mean:
    break;
  }
  return {0., 0.5, 0.5};
}

FrameTraction compute_traction(const FrictionLaw &law, const ContactStiffness &stiffness,
                               const FrictionTangent &tangent, const double gap,
                               const std::array<double, 2> &tangential_n,
                               const TangentialIncrement &increment) {
  FrameTraction traction = compute_frictionless_traction(stiffness.normal, gap);
  const double k_t = stiffness.tangential;
  const std::array<double, 2> trial{tangential_n[0] - k_t * increment.value[0],
                                    tangential_n[1] - k_t * increment.value[1]};
  const double trial_norm = std::hypot(trial[0], trial[1]);
  const bool has_duration = increment.per_time > 0.;
  FrictionLimit limit = law.limit(traction.pressure, has_duration ? 0. : increment.rate);
  auto &K = traction.tangent;

  // −∂t*/∂u on (q, r, n)
  std::array<std::array<double, 3>, 2> trial_tangent;
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int j = 0; j < 3; ++j)
      trial_tangent[i][j] = k_t * increment.gradient[i][j];

  const bool rests = !(gap < 0.);
  if (trial_norm <= limit.value || rests) {
    traction.status = ContactStatus::stick;
    if (!rests)
      traction.tangential = trial;
    for (unsigned int i = 0; i < 2; ++i)
      K[i] = trial_tangent[i];
    return traction;
  }

  double rate_ratio = 0.; // ρ
  if (has_duration && limit.rate_slope != 0.) {
    const double slip = solve_slip(law, traction.pressure, trial_norm, k_t, increment.per_time);
    limit = law.limit(traction.pressure, slip * increment.per_time);
    limit.value = trial_norm - k_t * slip;
    const double slope = limit.rate_slope * increment.per_time;
    rate_ratio = slope / (k_t + slope);
  }
  const std::array<double, 2> direction{trial[0] / trial_norm, trial[1] / trial_norm};
  const double beta = std::max(limit.value / trial_norm, tangent.min_beta);
  for (unsigned int i = 0; i < 2; ++i) {
    traction.tangential[i] = limit.value * direction[i];
    traction.slip[i] = -(trial[i] - traction.tangential[i]) / k_t;
    for (unsigned int j = 0; j < 3; ++j)
      for (unsigned int m = 0; m < 2; ++m)
        K[i][j] += (beta * ((i == m ? 1. : 0.) - direction[i] * direction[m]) +
                    rate_ratio * direction[i] * direction[m]) *
                   trial_tangent[m][j];
    traction.pressure_slope[i] = limit.pressure_slope * (1. - rate_ratio) * direction[i];
    const double coupling = traction.pressure_slope[i] * stiffness.normal;
    K[i][2] += tangent.upper * coupling;
    K[2][i] += tangent.lower * coupling;
  }
  return traction;
}

} // namespace billet
