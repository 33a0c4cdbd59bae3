// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/integration/time_integrator_type.h"

namespace billet {

TimeIntegrator generalised_alpha(const double spectral_radius) {
  const double alpha_m = (2. * spectral_radius - 1.) / (spectral_radius + 1.);
  const double alpha_f = spectral_radius / (spectral_radius + 1.);
  const double shift = 1. - alpha_m + alpha_f;
  return {alpha_m, alpha_f, 0.25 * shift * shift, 0.5 - alpha_m + alpha_f};
}

TimeIntegratorType generalised_alpha_type() {
  return {"generalised-alpha",
          "Chung & Hulbert (1993), of second order, damps high frequencies",
          {{"Spectral radius", "0.8", TypeParameter::Kind::number,
            ">= 0 and <= 1. Part of the amplitude of the highest frequencies that remains after a step. 1: "
            "no dissipation."}},
          [](const TypeInput &input) {
            const double spectral_radius = input.number("Spectral radius");
            if (!(spectral_radius >= 0. && spectral_radius <= 1.))
              input.reject("Spectral radius", "a number from 0 to 1");
            return generalised_alpha(spectral_radius);
          }};
}

} // namespace billet
