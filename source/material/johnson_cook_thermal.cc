// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/thermal_factor.h"

#include <algorithm>
#include <cmath>

namespace billet {

ThermalFactorType johnson_cook_thermal_type();

namespace {

/// Factor 1 − T*^m, T* = (T − T_r)/(T_m − T_r), (H15) of doc/theory.md (Johnson & Cook 1983). It is
/// 1 below T_r. From T* = 1 − 1e-6 on it is constant, so that molten points keep a small flow
/// stress.
class JohnsonCookThermal final : public ThermalFactor {
public:
  JohnsonCookThermal(const double reference, const double melting, const double exponent)
      : reference_(reference), range_(melting - reference), exponent_(exponent) {}

  std::string description() const override { return "times Johnson and Cook's factor of the temperature"; }
  double value(const double temperature) const override {
    const double part = (temperature - reference_) / range_;
    return part <= 0. ? 1. : 1. - std::pow(std::min(part, max_part), exponent_);
  }
  double slope(const double temperature) const override {
    const double part = (temperature - reference_) / range_;
    return part <= 0. || part >= max_part ? 0. : -exponent_ * std::pow(part, exponent_ - 1.) / range_;
  }

private:
  static constexpr double max_part = 1. - 1e-6;

  double reference_, range_, exponent_;
};

} // namespace

ThermalFactorType johnson_cook_thermal_type() {
  using Kind = TypeParameter::Kind;
  return {
      "Johnson-Cook",
      "1 - ((T - T_r)/(T_m - T_r))^m, 1 below T_r",
      {{"Reference temperature", "293", Kind::number, "T_r. The factor is 1 at and below it. [temperature]"},
       {"Melting temperature", "0", Kind::number, "T_m > T_r. The factor ends close to 0. [temperature]"},
       {"Thermal exponent", "1", Kind::number, "m > 0. Exponent of the temperature."}},
      [](const TypeInput &input) -> std::shared_ptr<const ThermalFactor> {
        const double reference = input.number("Reference temperature"),
                     melting = input.number("Melting temperature");
        if (!(melting > reference))
          input.reject("Melting temperature", "a number above 'Reference temperature'");
        return std::make_shared<const JohnsonCookThermal>(reference, melting,
                                                          input.positive("Thermal exponent"));
      }};
}

} // namespace billet
