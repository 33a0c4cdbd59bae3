// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_FRICTION_COULOMB_H
#define BILLET_FRICTION_COULOMB_H

#include "billet/friction/friction_law.h"

namespace billet {

/// Coulomb's law, μ p: Bittencourt & Creus (1998), eq. (21).
class Coulomb final : public FrictionLaw {
public:
  /// μ > 0
  explicit Coulomb(const double coefficient) : coefficient_(coefficient) {}

  std::string description() const override;
  double coefficient() const override { return coefficient_; }
  FrictionLimit limit(const double pressure, double) const override {
    return {coefficient_ * pressure, coefficient_, 0.};
  }

private:
  double coefficient_;
};

/// Returns Coulomb's law; null for μ = 0.
FrictionPointer make_coulomb(double coefficient);

} // namespace billet

#endif
