// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_FRICTION_SHEAR_LIMITED_H
#define BILLET_FRICTION_SHEAR_LIMITED_H

#include "billet/friction/friction_law.h"

namespace billet {

/// Coulomb's law up to the shear strength of the material below the surface (Orowan 1943): min(μ p,
/// τ_max).
class ShearLimited final : public FrictionLaw {
public:
  /// μ > 0, τ_max > 0 [stress]
  ShearLimited(const double coefficient, const double max_stress)
      : coefficient_(coefficient), max_stress_(max_stress) {}

  std::string description() const override;
  double coefficient() const override { return coefficient_; }
  FrictionLimit limit(const double pressure, double) const override {
    if (coefficient_ * pressure < max_stress_)
      return {coefficient_ * pressure, coefficient_, 0.};
    return {max_stress_, 0., 0.};
  }

private:
  double coefficient_, max_stress_;
};

} // namespace billet

#endif
