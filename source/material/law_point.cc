// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/law_point.h"

#include "billet/material/user_subroutine.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::SymmetricTensor;
using dealii::Tensor;

namespace {

constexpr unsigned int voigt_rows[6] = {0, 1, 2, 0, 0, 1}, voigt_columns[6] = {0, 1, 2, 1, 2, 2};

/// Adds L τ + τ Lᵀ to the rates for each L = e_j ⊗ e_k.
void add_convection(const SymmetricTensor<2, 3> &tau, StressRates &rates) {
  for (unsigned int r = 0; r < 6; ++r)
    for (unsigned int k = 0; k < 3; ++k) {
      const unsigned int p = voigt_rows[r], q = voigt_columns[r];
      rates[r][3 * p + k] += tau[k][q];
      rates[r][3 * q + k] += tau[p][k];
    }
}

StressRates rates_of(const SpatialModuli &c, const SymmetricTensor<2, 3> &tau) {
  constexpr unsigned int entry[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  StressRates rates{};
  for (unsigned int r = 0; r < 6; ++r)
    for (unsigned int j = 0; j < 3; ++j)
      for (unsigned int k = 0; k < 3; ++k)
        rates[r][3 * j + k] = c[r][entry[j][k]];
  add_convection(tau, rates);
  return rates;
}

StressRates rates_of(const GradientModuli &A) {
  StressRates rates = A;
  for (unsigned int r = 0; r < 3; ++r)
    for (unsigned int j = 0; j < 3; ++j)
      rates[r][4 * j] += A.volumetric;
  return rates;
}

/// Returns the deviators of the rates for isochoric velocity gradients.
StressRates isochoric(StressRates rates) {
  for (auto &row : rates) {
    const double mean = (row[0] + row[4] + row[8]) / 3.;
    for (const unsigned int c : {0, 4, 8})
      row[c] -= mean;
  }
  for (unsigned int c = 0; c < 9; ++c) {
    const double mean = (rates[0][c] + rates[1][c] + rates[2][c]) / 3.;
    for (unsigned int r = 0; r < 3; ++r)
      rates[r][c] -= mean;
  }
  return rates;
}

double norm(const StressRates &rates) {
  double sum = 0.;
  for (unsigned int r = 0; r < 6; ++r)
    for (const double entry : rates[r])
      sum += (r < 3 ? 1. : 2.) * entry * entry;
  return std::sqrt(sum);
}

} // namespace

LawPoint::LawPoint(const PointLaw &law, const double temperature, const Tensor<1, 3> &centre)
    : law_(law), temperature_(temperature), state_n_(law.n_state()), state_(law.n_state()) {
  law.initialize_at(centre, state_n_.data());
  state_ = state_n_;
}

std::optional<SymmetricTensor<2, 3>> LawPoint::evaluate(const Tensor<2, 3> &F, const double dt,
                                                        StressRates *rates) {
  PointStep step;
  step.dt = dt;
  step.temperature = temperature_;
  SymmetricTensor<2, 3> tau;
  const auto update = [&](const auto &law) {
    typename std::decay_t<decltype(law)>::Moduli moduli;
    if (!law.update(F, dealii::determinant(F), step, state_n_.data(), state_.data(), tau,
                    rates != nullptr ? &moduli : nullptr))
      return false;
    if (rates != nullptr) {
      if constexpr (std::is_same_v<std::decay_t<decltype(moduli)>, SpatialModuli>)
        *rates = rates_of(moduli, tau);
      else
        *rates = rates_of(moduli);
    }
    return true;
  };
  const bool is_admissible = law_.is_rate_form() ? update(dynamic_cast<const RateLaw &>(law_))
                                                 : update(dynamic_cast<const SpatialLaw &>(law_));
  return is_admissible ? std::optional(tau) : std::nullopt;
}

std::optional<StressRates> LawPoint::differentiate(const Tensor<2, 3> &F, const double dt, const double h,
                                                   const double kink) {
  const std::vector<double> kept = state_;
  const auto middle = evaluate(F, dt);
  StressRates rates{};
  double jump = 0.;
  bool is_sound = middle.has_value();
  for (unsigned int c = 0; c < 9 && is_sound; ++c) {
    Tensor<2, 3> change;
    for (unsigned int k = 0; k < 3; ++k)
      change[c / 3][k] = h * F[c % 3][k]; // h L F
    const auto ahead = evaluate(F + change, dt), behind = evaluate(F - change, dt);
    is_sound = ahead && behind;
    if (!is_sound)
      break;
    for (unsigned int r = 0; r < 6; ++r)
      rates[r][c] = (ahead->access_raw_entry(r) - behind->access_raw_entry(r)) / (2. * h);
    jump = std::max(jump, (*ahead + *behind - 2. * *middle).norm() / h);
  }
  state_ = kept;
  if (!is_sound || !(jump <= kink * norm(rates)))
    return {};
  return rates;
}

double relative_difference(const StressRates &a, const StressRates &b, const bool is_symmetric) {
  StressRates difference{};
  for (unsigned int r = 0; r < 6; ++r)
    for (unsigned int j = 0; j < 3; ++j)
      for (unsigned int k = 0; k < 3; ++k) {
        const unsigned int c = 3 * j + k, transposed = 3 * k + j;
        difference[r][c] = a[r][c] - b[r][c];
        if (is_symmetric)
          difference[r][c] = 0.5 * (difference[r][c] + a[r][transposed] - b[r][transposed]);
      }
  const double whole = norm(difference) / norm(b), part = norm(isochoric(difference)) / norm(isochoric(b));
  return part <= whole ? whole : part; // not a number: part
}

TangentError find_tangent_error(const PointLaw &law, const double dt, const double temperature) {
  // Isochoric directions, one with a change of volume, in general position.
  constexpr std::array<std::array<double, 6>, 3> directions = {{{0.6, -0.3, -0.3, 0.3, 0.2, -0.1},
                                                                {-0.5, 0.1, 0.4, -0.2, 0.4, 0.3},
                                                                {0.4, 0.3, -0.1, 0.1, -0.3, 0.4}}};
  constexpr std::array<double, 4> strains = {1e-5, 1e-4, 1e-3, 1e-2};
  constexpr double kink = 0.02, part = 1e-3; // of the strain, for differences
  const auto *const user_law = find_user_subroutine(law);
  TangentError maximum;
  for (const auto &direction : directions) {
    LawPoint point(law, temperature);
    SymmetricTensor<2, 3> D;
    for (unsigned int i = 0; i < 6; ++i)
      D.access_raw_entry(i) = direction[i];
    for (const double strain : strains) {
      const Tensor<2, 3> F = dealii::unit_symmetric_tensor<3>() + strain * D;
      StressRates promised;
      if (!point.evaluate(F, dt, &promised))
        break;
      if (user_law != nullptr)
        maximum.asymmetry = std::max(maximum.asymmetry, user_law->lost_asymmetry());
      if (const auto measured = point.differentiate(F, dt, part * strain, kink)) {
        const double error = relative_difference(promised, *measured, true);
        if (!(error <= maximum.error)) {
          maximum.error = error;
          maximum.strain = strain;
        }
      }
      point.commit();
    }
  }
  return maximum;
}

} // namespace billet
