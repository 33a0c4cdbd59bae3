// SPDX-License-Identifier: LGPL-2.1-or-later
// Hockett and Sherby's flow stress, J. Mech. Phys. Solids 23 (1975): σ = σ_s − (σ_s − σ_y) exp(−N a^p).

#include <billet/material/elasticity.h>
#include <billet/material/hardening.h>
#include <billet/plugin.h>

#include <cmath>

using namespace billet;

namespace {

struct HockettSherby {
  double yield_stress, saturation_stress, rate, exponent;

  static std::string description() { return "Hockett and Sherby's hardening"; }
  double part(const double a) const {
    return (saturation_stress - yield_stress) * std::exp(-rate * std::pow(a, exponent));
  }
  double stress(const double a) const { return saturation_stress - part(a); }
  double slope(const double a) const {
    return a > 0. ? part(a) * rate * exponent * std::pow(a, exponent - 1.) : part(0.) * rate;
  }
  /// Integral of the stress from 0 to a, by Simpson's rule.
  double work(const double a) const {
    constexpr unsigned int n = 64;
    double sum = stress(0.) + stress(a);
    for (unsigned int i = 1; i < n; ++i)
      sum += (i % 2 ? 4. : 2.) * stress(a * i / n);
    return sum * a / (3. * n);
  }
  static bool is_bounded() { return true; }
};

HardeningType hockett_sherby_type() {
  using Kind = TypeParameter::Kind;
  return {"Hockett-Sherby",
          "S - (S - Y) exp(-N e^p)",
          {yield_stress_parameter,
           {"Largest stress", "0", Kind::number, "S > yield stress. [stress]"},
           {"Rate", "0", Kind::number, "N > 0."},
           {"Power", "1", Kind::number, "p >= 1. Power of the strain."}},
          [](const TypeInput &input) {
            HockettSherby law{input.positive("Yield stress"), input.positive("Largest stress"),
                              input.positive("Rate"), input.positive("Power")};
            if (law.saturation_stress <= law.yield_stress)
              input.reject("Largest stress", "a number above 'Yield stress'");
            if (law.exponent < 1.)
              input.reject("Power", "a number of at least 1");
            return make_hardening(law);
          }};
}

} // namespace

ElasticityType quadratic_volume_type(); // own_elasticity.cc

BILLET_PLUGIN {
  elasticity_types().add(quadratic_volume_type());
  hardening_types().add(hockett_sherby_type());
}
