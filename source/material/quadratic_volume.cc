// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/volumetric_law.h"

#include <algorithm>

namespace billet {

VolumetricLawType quadratic_volume_type();

namespace {

/// u = ½ (J − 1)².
class QuadraticVolume final : public VolumetricLaw {
public:
  double energy(const double J) const override { return 0.5 * (J - 1.) * (J - 1.); }
  double mean_stress(const double J) const override { return J * (J - 1.); }
  double slope(const double J) const override { return J * (2. * J - 1.); }
  // J (2 J − 1) = J + 2 p. Tension: J ≤ 1 + p. Compression: p ≤ 0 and J ≤ 1.
  double bound_slope(const double p) const override { return 1. + 3. * std::max(p, 0.); }
};

} // namespace

VolumetricLawType quadratic_volume_type() {
  return {"quadratic", "K/2 (J - 1)^2", {}, [](const TypeInput &) -> SharedVolumetricLaw {
            return std::make_shared<const QuadraticVolume>();
          }};
}

} // namespace billet
