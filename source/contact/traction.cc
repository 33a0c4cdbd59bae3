// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/traction.h"

#include <cmath>

namespace billet {

FrameTraction compute_frictionless_traction(const double normal_stiffness, const double gap) {
  FrameTraction traction{};
  traction.status = ContactStatus::slip;
  traction.pressure = -normal_stiffness * gap;
  traction.tangent[2][2] = normal_stiffness;
  return traction;
}

FrameTraction compute_traction(const ContactStiffness &stiffness, const ContactTangent tangent,
                               const double gap, const std::array<double, 2> &tangential_n,
                               const std::array<double, 2> &increment,
                               const std::array<double, 2> &increment_slope) {
  FrameTraction traction = compute_frictionless_traction(stiffness.normal, gap);
  const double k_t = stiffness.tangential;
  const std::array<double, 2> trial{tangential_n[0] - k_t * increment[0],
                                    tangential_n[1] - k_t * increment[1]};
  const double trial_norm = std::hypot(trial[0], trial[1]);
  const double limit = stiffness.friction_coefficient * traction.pressure;
  auto &K = traction.tangent;

  // −∂t*/∂u on (q, r, n)
  std::array<std::array<double, 3>, 2> trial_tangent{{{k_t, 0., 0.}, {0., k_t, 0.}}};
  if (tangent == ContactTangent::exact)
    for (unsigned int i = 0; i < 2; ++i)
      trial_tangent[i][2] = k_t * increment_slope[i];

  if (trial_norm <= limit) {
    traction.status = ContactStatus::stick;
    traction.tangential = trial;
    for (unsigned int i = 0; i < 2; ++i)
      K[i] = trial_tangent[i];
    return traction;
  }

  const std::array<double, 2> direction{trial[0] / trial_norm, trial[1] / trial_norm};
  const double ratio = limit / trial_norm; // β
  const double beta = tangent == ContactTangent::continuum ? 1. : ratio;
  for (unsigned int i = 0; i < 2; ++i) {
    traction.tangential[i] = limit * direction[i];
    traction.slip[i] = -(trial[i] - traction.tangential[i]) / k_t;
    for (unsigned int j = 0; j < 3; ++j)
      for (unsigned int m = 0; m < 2; ++m)
        K[i][j] += beta * ((i == m ? 1. : 0.) - direction[i] * direction[m]) * trial_tangent[m][j];
    const double coupling = stiffness.friction_coefficient * stiffness.normal * direction[i];
    switch (tangent) {
    case ContactTangent::automatic: // resolved by the scene
    case ContactTangent::exact:
    case ContactTangent::consistent:
    case ContactTangent::continuum:
      K[i][2] += coupling;
      break;
    case ContactTangent::symmetrised_upper:
      K[i][2] += coupling;
      K[2][i] += coupling;
      break;
    case ContactTangent::symmetrised_lower:
      break;
    case ContactTangent::symmetrised_mean:
      K[i][2] += 0.5 * coupling;
      K[2][i] += 0.5 * coupling;
      break;
    }
  }
  return traction;
}

} // namespace billet
