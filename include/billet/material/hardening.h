// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_HARDENING_H
#define BILLET_MATERIAL_HARDENING_H

#include <algorithm>
#include <cmath>
#include <vector>

namespace billet {

// Isotropic hardening laws: yield stress over equivalent plastic strain, both in the sense of von Mises.
// Each law is a small value type with
//   stress(a)   yield stress at equivalent plastic strain a >= 0        [stress]
//   slope(a)    its derivative, from the right where it has a kink      [stress]
//   work(a)     plastic work per reference volume up to a, ∫ stress     [stress]
// A new law is one more such type and an alternative of MaterialLaw.

/// σ_y + H a. H = 0 is perfect plasticity.
struct LinearHardening {
  double yield_stress;
  double modulus;

  double stress(const double a) const { return yield_stress + modulus * a; }
  double slope(const double) const { return modulus; }
  double work(const double a) const { return (yield_stress + 0.5 * modulus * a) * a; }
};

/// Voce's saturation with a linear part: σ_y + (σ_∞ − σ_y)(1 − exp(−δ a)) + H a.
struct VoceHardening {
  double yield_stress;
  double saturation_stress;
  double saturation_rate;
  double modulus;

  double stress(const double a) const {
    return yield_stress - (saturation_stress - yield_stress) * std::expm1(-saturation_rate * a) + modulus * a;
  }
  double slope(const double a) const {
    return (saturation_stress - yield_stress) * saturation_rate * std::exp(-saturation_rate * a) + modulus;
  }
  double work(const double a) const {
    return (saturation_stress + 0.5 * modulus * a) * a +
           (saturation_stress - yield_stress) / saturation_rate * std::expm1(-saturation_rate * a);
  }
};

/// Swift's power law K (ε0 + a)^n. ε0 > 0 keeps the initial slope finite.
struct PowerLawHardening {
  double strength;
  double prestrain;
  double exponent;

  double stress(const double a) const { return strength * std::pow(prestrain + a, exponent); }
  double slope(const double a) const { return strength * exponent * std::pow(prestrain + a, exponent - 1.); }
  double work(const double a) const {
    return strength / (exponent + 1.) *
           (std::pow(prestrain + a, exponent + 1.) - std::pow(prestrain, exponent + 1.));
  }
};

/// Straight lines through (strain, stress) points; constant beyond the last one. The strains start at 0 and
/// increase strictly.
class TabulatedHardening {
public:
  TabulatedHardening(std::vector<double> strains, std::vector<double> stresses)
      : strains_(std::move(strains)), stresses_(std::move(stresses)), works_(strains_.size(), 0.) {
    for (std::size_t i = 1; i < strains_.size(); ++i)
      works_[i] = works_[i - 1] + 0.5 * (stresses_[i] + stresses_[i - 1]) * (strains_[i] - strains_[i - 1]);
  }

  double stress(const double a) const {
    const std::size_t i = segment(a);
    return stresses_[i] + slope_of(i) * (a - strains_[i]);
  }
  double slope(const double a) const { return slope_of(segment(a)); }
  double work(const double a) const {
    const std::size_t i = segment(a);
    const double da = a - strains_[i];
    return works_[i] + (stresses_[i] + 0.5 * slope_of(i) * da) * da;
  }

private:
  std::size_t segment(const double a) const {
    const auto second = strains_.begin() + 1;
    return static_cast<std::size_t>(std::upper_bound(second, strains_.end(), a) - second);
  }
  double slope_of(const std::size_t i) const {
    return i + 1 < strains_.size() ? (stresses_[i + 1] - stresses_[i]) / (strains_[i + 1] - strains_[i]) : 0.;
  }

  std::vector<double> strains_, stresses_, works_;
};

} // namespace billet

#endif
