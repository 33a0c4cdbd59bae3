// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/rate_factor.h"

#include <cmath>

namespace billet {

RateFactorType johnson_cook_rate_type();

namespace {

/// Factor 1 + C ln(ε̇/ε̇_0), 1 below ε̇_0, (H18) of doc/theory.md (Johnson & Cook 1983).
class JohnsonCookRate final : public RateFactor {
public:
  JohnsonCookRate(const double coefficient, const double lowest)
      : coefficient_(coefficient), lowest_(lowest) {}

  std::string description() const override { return "times Johnson and Cook's factor of the rate"; }
  double value(const double rate) const override {
    return rate > lowest_ ? 1. + coefficient_ * std::log(rate / lowest_) : 1.;
  }
  double slope(const double rate) const override { return rate > lowest_ ? coefficient_ / rate : 0.; }

private:
  double coefficient_, lowest_;
};

} // namespace

RateFactorType johnson_cook_rate_type() {
  using Kind = TypeParameter::Kind;
  return {"Johnson-Cook",
          "1 + C ln(rate/rate_0), 1 below rate_0, of the rate of e",
          {{"Rate coefficient", "0", Kind::number, "C > 0."},
           {"Lowest rate", "1", Kind::number, "rate_0 > 0. The factor is 1 at and below it. [1/time]"}},
          [](const TypeInput &input) -> std::shared_ptr<const RateFactor> {
            const double coefficient = input.positive("Rate coefficient"),
                         lowest = input.positive("Lowest rate");
            return std::make_shared<const JohnsonCookRate>(coefficient, lowest);
          }};
}

} // namespace billet
