// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/volumetric_law.h"

#include <cmath>

namespace billet {

VolumetricLawType logarithmic_volume_type();

namespace {

class LogarithmicVolume final : public VolumetricLaw {
public:
  double energy(const double J) const override { return 0.5 * std::log(J) * std::log(J); }
  double mean_stress(const double J) const override { return std::log(J); }
  double slope(double) const override { return 1.; }
  double bound_slope(double) const override { return 1.; }
};

} // namespace

SharedVolumetricLaw make_logarithmic_volume() { return std::make_shared<const LogarithmicVolume>(); }

VolumetricLawType logarithmic_volume_type() {
  return {"logarithmic", "K/2 (ln J)^2", {}, [](const TypeInput &) { return make_logarithmic_volume(); }};
}

} // namespace billet
