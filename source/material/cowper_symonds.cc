// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/rate_factor.h"

#include <cmath>
#include <limits>

namespace billet {

RateFactorType cowper_symonds_type();

namespace {

/// Factor 1 + (ε̇/D)^{1/p}, (M16) of doc/theory.md (Cowper & Symonds 1957).
class CowperSymonds final : public RateFactor {
public:
  CowperSymonds(const double reference, const double p) : reference_(reference), p_(p), exponent_(1. / p) {}

  std::string description() const override { return "times Cowper and Symonds' factor of the rate"; }
  double value(const double rate) const override { return 1. + std::pow(rate / reference_, exponent_); }
  double slope(const double rate) const override {
    if (rate > 0.)
      return exponent_ * std::pow(rate / reference_, exponent_ - 1.) / reference_;
    return exponent_ < 1. ? std::numeric_limits<double>::infinity() : 1. / reference_;
  }
  LaneRate lane_form() const override { return {RateKind::power_law, reference_, p_}; }

private:
  double reference_, p_, exponent_;
};

} // namespace

RateFactorType cowper_symonds_type() {
  using Kind = TypeParameter::Kind;
  return {"Cowper-Symonds",
          "1 + (rate/D)^(1/p), of the rate of e",
          {{"Reference rate", "0", Kind::number, "D > 0. Rate at which the flow stress doubles. [1/time]"},
           {"Rate exponent", "1", Kind::number, "p >= 1. Exponent of the rate."}},
          [](const TypeInput &input) -> std::shared_ptr<const RateFactor> {
            const double reference = input.positive("Reference rate"), p = input.positive("Rate exponent");
            if (p < 1.)
              input.reject("Rate exponent", "a number >= 1");
            return std::make_shared<const CowperSymonds>(reference, p);
          }};
}

} // namespace billet
