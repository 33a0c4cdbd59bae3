// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_HARDENING_H
#define BILLET_MATERIAL_HARDENING_H

#include "billet/material/flow_stress.h"
#include "billet/registered_type.h"

#include <memory>
#include <utility>
#include <vector>

namespace billet {

/// Isotropic hardening: the flow stress depends on the equivalent plastic strain alone.
class HardeningLaw : public FlowStress {
public:
  /// Returns the integral of the stress from 0 to α [stress].
  virtual double work(double alpha) const = 0;
  double plastic_work(const double alpha, const State &) const final { return work(alpha); }
  double plastic_work_at_rest(const double alpha) const final { return work(alpha); }
};

/// Hardening law made from a value type with
///   stress(a), slope(a), work(a)   as above, a ≥ 0
///   is_bounded(), description()    as in FlowStress
/// and, where it has one, lane_form().
template <class Law> class Hardening final : public HardeningLaw {
public:
  explicit Hardening(Law law) : law_(std::move(law)) {}

  std::string description() const override { return law_.description(); }
  double stress(const double alpha) const override { return law_.stress(alpha); }
  double slope(const double alpha) const override { return law_.slope(alpha); }
  double work(const double alpha) const override { return law_.work(alpha); }
  PlasticIncrement solve(const double q, const double m, const double alpha_n, double) const override {
    const double delta = q > law_.stress(alpha_n) ? solve_consistency(law_, q, m, alpha_n) : 0.;
    return {delta, law_.slope(alpha_n + delta)};
  }
  bool is_bounded() const override { return law_.is_bounded(); }
  LaneHardening lane_form() const override { return find_lane_form(law_, 0); }

private:
  template <class L> static auto find_lane_form(const L &law, int) -> decltype(law.lane_form()) {
    return law.lane_form();
  }
  template <class L> static LaneHardening find_lane_form(const L &, long) { return {}; }

  Law law_;
};

template <class Law> std::shared_ptr<const HardeningLaw> make_hardening(Law law) {
  return std::make_shared<const Hardening<Law>>(std::move(law));
}

/// σ_y + H a. H = 0 is perfect plasticity.
struct LinearHardening {
  double yield_stress;
  double modulus;

  static std::string description() { return "linear hardening"; }
  double stress(const double a) const { return yield_stress + modulus * a; }
  double slope(const double) const { return modulus; }
  double work(const double a) const { return (yield_stress + 0.5 * modulus * a) * a; }
  bool is_bounded() const { return modulus == 0.; }
  LaneHardening lane_form() const;
};

/// Voce's saturation with a linear part: σ_y + (σ_∞ − σ_y)(1 − exp(−δ a)) + H a.
struct VoceHardening {
  double yield_stress;
  double saturation_stress;
  double saturation_rate;
  double modulus;

  static std::string description() { return "Voce's hardening"; }
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
  bool is_bounded() const { return modulus == 0.; }
  LaneHardening lane_form() const;
};

/// Swift's power law K (ε0 + a)^n. ε0 > 0 keeps the initial slope finite.
struct PowerLawHardening {
  double strength;
  double prestrain;
  double exponent;

  static std::string description() { return "power-law hardening"; }
  double stress(const double a) const { return strength * std::pow(prestrain + a, exponent); }
  double slope(const double a) const { return strength * exponent * std::pow(prestrain + a, exponent - 1.); }
  double work(const double a) const {
    return strength / (exponent + 1.) *
           (std::pow(prestrain + a, exponent + 1.) - std::pow(prestrain, exponent + 1.));
  }
  bool is_bounded() const { return exponent == 0.; }
  LaneHardening lane_form() const;
};

/// Ludwik's σ_y + B a^n, that of Johnson and Cook. Its slope is infinite at a = 0, so that up to
/// a_0 it is the secant. The stress differs from the curve by at most B a_0^n there.
struct LudwikHardening {
  static constexpr double a_0 = 1e-6;

  double yield_stress;
  double coefficient;
  double exponent;

  static std::string description() { return "Ludwik's hardening"; }
  double stress(const double a) const {
    return yield_stress + (a < a_0 ? initial_slope() * a : coefficient * std::pow(a, exponent));
  }
  double slope(const double a) const {
    return a < a_0 ? initial_slope() : coefficient * exponent * std::pow(a, exponent - 1.);
  }
  double work(const double a) const {
    if (a < a_0)
      return (yield_stress + 0.5 * initial_slope() * a) * a;
    const auto integral = [this](const double x) {
      return coefficient / (exponent + 1.) * std::pow(x, exponent + 1.);
    };
    return yield_stress * a + 0.5 * initial_slope() * a_0 * a_0 + integral(a) - integral(a_0);
  }
  bool is_bounded() const { return coefficient == 0. || exponent == 0.; }

private:
  double initial_slope() const { return coefficient * std::pow(a_0, exponent - 1.); }
};

/// Piecewise linear curve through (strain, stress) points, constant beyond the last one. The
/// strains start at 0 and increase strictly.
class TabulatedHardening {
public:
  TabulatedHardening(std::vector<double> strains, std::vector<double> stresses);

  static std::string description() { return "tabulated hardening"; }
  double stress(double a) const;
  double slope(double a) const;
  double work(double a) const;
  static bool is_bounded() { return true; }

private:
  std::size_t segment(double a) const;
  double slope_of(std::size_t segment) const;

  std::vector<double> strains_, stresses_, works_;
};

/// Hardening laws that a scene file can name. A new one is a file in source/material/ with a
/// function that returns its type, and its name in the table of hardening.cc.
using HardeningType = RegisteredType<std::shared_ptr<const HardeningLaw>>;
TypeTable<std::shared_ptr<const HardeningLaw>> &hardening_types();

/// Returns the text that describes the allowed values where others would cause softening.
std::string no_softening(const std::string &allowed);
/// Reads a number that must not be negative, since negative values cause softening.
double read_hardening(const TypeInput &input, const std::string &key);
/// Parameters of several hardening laws.
extern const TypeParameter yield_stress_parameter, hardening_modulus_parameter;

} // namespace billet

#endif
