// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/volumetric_law.h"

#include <cmath>

namespace billet {

VolumetricLawType ogden_volume_type();

namespace {

/// u = (β ln J + J^{−β} − 1)/β² (Ogden 1972b).
class OgdenVolume final : public VolumetricLaw {
public:
  explicit OgdenVolume(const double exponent) : exponent_(exponent) {}

  double energy(const double J) const override {
    const double log_J = std::log(J);
    return (exponent_ * log_J + std::expm1(-exponent_ * log_J)) / (exponent_ * exponent_);
  }
  double mean_stress(const double J) const override {
    return -std::expm1(-exponent_ * std::log(J)) / exponent_;
  }
  double slope(const double J) const override { return std::pow(J, -exponent_); }
  // J^{−β} = 1 − β p.
  double bound_slope(const double p) const override { return 1. + std::abs(exponent_ * p); }

private:
  double exponent_; ///< β
};

constexpr const char *exponent_key = "Volumetric exponent";

} // namespace

VolumetricLawType ogden_volume_type() {
  return {
      "Ogden",
      "K/B^2 (B ln J + J^-B - 1)",
      {{exponent_key, "9", TypeParameter::Kind::number, "B, not 0. Exponent of 'Volumetric law = Ogden'."}},
      [](const TypeInput &input) -> SharedVolumetricLaw {
        const double exponent = input.number(exponent_key);
        if (exponent == 0.)
          input.reject(exponent_key, "a number other than 0");
        return std::make_shared<const OgdenVolume>(exponent);
      }};
}

} // namespace billet
