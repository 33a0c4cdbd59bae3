// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/hardening_curves.h"
#include "billet/material/thermal_factor.h"

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace billet {

ThermalFactorType thermal_curves_type();

namespace {

/// Measured curves of hardening at several temperatures, (H19) of doc/theory.md with temperatures
/// in place of logarithms of rates.
class ThermalCurves final : public ThermalFactor {
public:
  explicit ThermalCurves(HardeningCurves curves) : curves_(std::move(curves)) {}

  std::string description() const override {
    return "times curves at " + std::to_string(curves_.size()) + " temperatures";
  }
  double value(const double temperature) const override { return value_at(0., temperature); }
  double slope(const double temperature) const override { return slopes_at(0., temperature).first; }
  double value_at(const double alpha, const double temperature) const override {
    return curves_.factor(alpha, temperature);
  }
  std::pair<double, double> slopes_at(const double alpha, const double temperature) const override {
    return curves_.slopes(alpha, temperature);
  }

private:
  HardeningCurves curves_;
};

CurvesInput thermal_curves_input() {
  return {"Curve temperatures", "Thermal curves file", "Thermal curves columns", "temperature",
          "temperature"};
}

std::shared_ptr<const ThermalFactor> make_thermal_curves(const TypeInput &input) {
  const CurvesInput curves = thermal_curves_input();
  std::vector<double> temperatures = input.numbers(curves.values_key);
  if (temperatures.size() < 2 || std::adjacent_find(temperatures.begin(), temperatures.end(),
                                                    std::greater_equal<>()) != temperatures.end())
    input.reject(curves.values_key, "at least two temperatures that increase strictly");
  return std::make_shared<const ThermalCurves>(curves.read(input, std::move(temperatures)));
}

} // namespace

ThermalFactorType thermal_curves_type() {
  return {"curves", "curves of hardening at several temperatures, over the first one",
          thermal_curves_input().parameters(
              "At least two temperatures that increase strictly, one for each curve. "
              "The factor is 1 up to the first one, and constant beyond the last one."),
          &make_thermal_curves};
}

} // namespace billet
