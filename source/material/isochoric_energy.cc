// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/isochoric_energy.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace billet {

double expm1_minus(const double x) {
  if (std::abs(x) > 0.5)
    return std::expm1(x) - x;
  double sum = 0., term = 0.5 * x * x;
  for (unsigned int n = 3; n < 18; ++n) {
    sum += term;
    term *= x / n;
  }
  return sum;
}

namespace {

class HenckyEnergy final : public IsochoricEnergy {
public:
  explicit HenckyEnergy(const double shear) : shear_(shear) {}

  double shear_modulus() const override { return shear_; }
  double energy(const IsochoricStrains &e) const override {
    return shear_ * (e[0] * e[0] + e[1] * e[1] + e[2] * e[2]);
  }
  IsochoricResponse respond(const IsochoricStrains &e) const override {
    IsochoricResponse response{};
    for (unsigned int a = 0; a < 3; ++a) {
      response.stress[a] = 2. * shear_ * e[a];
      response.slope[a][a] = 2. * shear_;
    }
    for (unsigned int k = 0; k < 3; ++k) {
      const double twice = 2. * (e[principal_pairs[k][0]] - e[principal_pairs[k][1]]);
      response.shear[k] = shear_ * (twice == 0. ? 1. : twice / std::expm1(twice));
    }
    return response;
  }
  double growth() const override { return 0.; }

private:
  double shear_;
};

class OgdenEnergy final : public IsochoricEnergy {
public:
  OgdenEnergy(std::vector<double> moduli, std::vector<double> exponents)
      : moduli_(std::move(moduli)), exponents_(std::move(exponents)) {}

  double shear_modulus() const override {
    double sum = 0.;
    for (std::size_t p = 0; p < moduli_.size(); ++p)
      sum += 0.5 * moduli_[p] * exponents_[p];
    return sum;
  }
  double energy(const IsochoricStrains &e) const override {
    double sum = 0.;
    for (std::size_t p = 0; p < moduli_.size(); ++p)
      for (const double strain : e) // Σ e = 0
        sum += moduli_[p] / exponents_[p] * expm1_minus(exponents_[p] * strain);
    return sum;
  }
  IsochoricResponse respond(const IsochoricStrains &e) const override {
    IsochoricResponse response{};
    for (std::size_t p = 0; p < moduli_.size(); ++p) {
      const double mu = moduli_[p], alpha = exponents_[p];
      for (unsigned int a = 0; a < 3; ++a) {
        const double change = std::expm1(alpha * e[a]); // λ̄^α − 1
        response.stress[a] += mu * change;
        response.slope[a][a] += mu * alpha * (1. + change);
      }
      for (unsigned int k = 0; k < 3; ++k) {
        const auto [a, b] = principal_pairs[k];
        const double d = e[a] - e[b];
        response.shear[k] += mu * std::exp(alpha * e[b]) *
                             (d == 0. ? 0.5 * alpha : std::expm1(alpha * d) / std::expm1(2. * d));
      }
    }
    return response;
  }
  double growth() const override {
    double maximum = 0.;
    for (const double exponent : exponents_)
      maximum = std::max(maximum, std::abs(exponent));
    return maximum;
  }

private:
  std::vector<double> moduli_, exponents_;
};

class InvariantEnergy final : public IsochoricEnergy {
public:
  explicit InvariantEnergy(std::vector<double> coefficients) : coefficients_(std::move(coefficients)) {}

  double shear_modulus() const override { return 2. * coefficients_.front(); }
  double energy(const IsochoricStrains &e) const override { return derivatives(e)[0]; }
  IsochoricResponse respond(const IsochoricStrains &e) const override {
    const auto [energy, first, second] = derivatives(e);
    IsochoricResponse response{};
    std::array<double, 3> b{};
    for (unsigned int a = 0; a < 3; ++a)
      b[a] = std::exp(2. * e[a]);
    for (unsigned int a = 0; a < 3; ++a) {
      response.stress[a] = 2. * first * std::expm1(2. * e[a]);
      for (unsigned int c = 0; c < 3; ++c)
        response.slope[a][c] = 4. * second * b[a] * b[c] + (a == c ? 4. * first * b[a] : 0.);
    }
    for (unsigned int k = 0; k < 3; ++k)
      response.shear[k] = 2. * first * b[principal_pairs[k][1]];
    return response;
  }
  double growth() const override { return 2. * static_cast<double>(coefficients_.size()); }

private:
  std::vector<double> coefficients_;

  /// Returns W and its derivatives by I_1.
  std::array<double, 3> derivatives(const IsochoricStrains &e) const {
    double x = 0.; // I_1 − 3
    for (const double strain : e)
      x += expm1_minus(2. * strain);
    std::array<double, 3> result{};
    for (std::size_t i = coefficients_.size(); i-- > 0;) { // Horner's scheme
      result[2] = result[2] * x + 2. * result[1];
      result[1] = result[1] * x + result[0];
      result[0] = result[0] * x + coefficients_[i];
    }
    // Σ c_i x^i begins with i = 1: W = x P(x)
    return {x * result[0], result[0] + x * result[1], 2. * result[1] + x * result[2]};
  }
};

} // namespace

SharedEnergy make_hencky_energy(const double shear) { return std::make_shared<const HenckyEnergy>(shear); }

SharedEnergy make_ogden_energy(std::vector<double> moduli, std::vector<double> exponents) {
  return std::make_shared<const OgdenEnergy>(std::move(moduli), std::move(exponents));
}

SharedEnergy make_invariant_energy(std::vector<double> coefficients) {
  return std::make_shared<const InvariantEnergy>(std::move(coefficients));
}

} // namespace billet
