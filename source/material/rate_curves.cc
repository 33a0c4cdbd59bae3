// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/hardening_curves.h"
#include "billet/material/rate_factor.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace billet {

RateFactorType rate_curves_type();

namespace {

/// Measured curves of hardening at several rates, (H19) of doc/theory.md. The stress is linear in
/// the logarithm of the rate.
class RateCurves final : public RateFactor {
public:
  /// `curves`: over logarithms of rates.
  explicit RateCurves(HardeningCurves curves) : curves_(std::move(curves)) {}

  std::string description() const override {
    return "times curves at " + std::to_string(curves_.size()) + " rates";
  }
  double value(const double rate) const override { return value_at(0., rate); }
  double slope(const double rate) const override { return slopes_at(0., rate).first; }

  double value_at(const double alpha, const double rate) const override {
    return curves_.factor(alpha, std::log(rate));
  }
  std::pair<double, double> slopes_at(const double alpha, const double rate) const override {
    const auto [by_logarithm, by_strain] = curves_.slopes(alpha, std::log(rate));
    return {by_logarithm == 0. ? 0. : by_logarithm / rate, by_strain}; // at rest it is 0, not 0/0
  }

private:
  HardeningCurves curves_;
};

/// Not a constant of the file: other files may ask for the type before it is made.
CurvesInput rate_curves_input() { return {"Curve rates", "Curves file", "Curves columns", "rate", "1/time"}; }

std::shared_ptr<const RateFactor> make_rate_curves(const TypeInput &input) {
  const CurvesInput curves = rate_curves_input();
  std::vector<double> rates = input.numbers(curves.values_key);
  if (rates.size() < 2 || !(rates.front() > 0.) ||
      std::adjacent_find(rates.begin(), rates.end(), std::greater_equal<>()) != rates.end())
    input.reject(curves.values_key, "at least two rates > 0 that increase strictly");
  for (double &rate : rates)
    rate = std::log(rate);
  return std::make_shared<const RateCurves>(
      curves.read(input, std::move(rates), [&](const std::vector<double> &stresses, const std::string &at) {
        if (!std::is_sorted(stresses.begin(), stresses.end()))
          input.reject(curves.file_key, "curves that do not fall with the rate, as one does " + at);
      }));
}

} // namespace

RateFactorType rate_curves_type() {
  return {
      "curves", "curves of hardening at several rates, over the first one",
      rate_curves_input().parameters("At least two rates > 0 that increase strictly, one for each curve. The "
                                     "factor is 1 up to the first one, and constant beyond the last one."),
      &make_rate_curves};
}

} // namespace billet
