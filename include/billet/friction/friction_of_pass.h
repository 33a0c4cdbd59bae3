// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_FRICTION_FRICTION_OF_PASS_H
#define BILLET_FRICTION_FRICTION_OF_PASS_H

#include "billet/friction/friction_law.h"

#include <string>
#include <utility>

namespace billet {

/// Law of one of two passes, which bears half of the pressure and half of the friction, (C14) of
/// doc/theory. For Coulomb's law it is the law itself.
class FrictionOfPass final : public FrictionLaw {
public:
  explicit FrictionOfPass(FrictionPointer law) : law_(std::move(law)) {}

  std::string description() const override { return law_->description(); }
  double coefficient() const override { return law_->coefficient(); }
  FrictionLimit limit(const double pressure, const double slip_rate) const override {
    const FrictionLimit whole = law_->limit(2. * pressure, slip_rate);
    return {0.5 * whole.value, whole.pressure_slope, 0.5 * whole.rate_slope};
  }

private:
  FrictionPointer law_; ///< of both passes
};

} // namespace billet

#endif
