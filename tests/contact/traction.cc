// SPDX-License-Identifier: LGPL-2.1-or-later
// The traction law alone: Coulomb's cone, the return map, and its tangents against finite differences and the
// formulas (50), (55)-(58) of Bittencourt & Creus (1998).
#include "billet/contact/traction.h"
#include "billet/friction/coulomb.h"

#include "../testing.h"

#include <array>
#include <vector>

namespace traction_test {

using namespace billet;
using billet::testing::check;
using billet::testing::WorstError;

namespace {

constexpr ContactStiffness stiffness{3.5e5, 1.2e5};
const Coulomb coulomb{0.3};

struct Sample {
  double gap;
  std::array<double, 2> tangential_n, increment;
};

/// Samples well inside sticking (few increments) or well inside slipping.
std::vector<Sample> make_samples(const bool slipping) {
  billet::testing::Random random;
  std::vector<Sample> samples;
  while (samples.size() < 200) {
    const Sample sample{random(-0.01, -0.001),
                        {random(-100., 100.), random(-100., 100.)},
                        {random(-0.01, 0.01), random(-0.01, 0.01)}};
    const double trial = std::hypot(sample.tangential_n[0] - stiffness.tangential * sample.increment[0],
                                    sample.tangential_n[1] - stiffness.tangential * sample.increment[1]);
    const double ratio = trial / (-coulomb.coefficient() * stiffness.normal * sample.gap);
    if (slipping ? ratio > 1.05 : ratio < 0.95)
      samples.push_back(sample);
  }
  return samples;
}

FrameTraction evaluate(const Sample &s, const ContactTangent tangent) {
  return compute_traction(coulomb, stiffness, FrictionTangent::of(tangent), s.gap, s.tangential_n,
                          {s.increment});
}

/// Largest relative difference between the tangent and −∂t/∂u by central differences; u_n moves the gap.
double tangent_error(const Sample &s, const ContactTangent tangent) {
  const FrameTraction at = evaluate(s, tangent);
  WorstError error;
  for (unsigned int j = 0; j < 3; ++j)
    for (unsigned int i = 0; i < 3; ++i) {
      const double derivative = billet::testing::central_difference(
          [&](const double h) {
            Sample moved = s;
            (j == 2 ? moved.gap : moved.increment[j]) += h;
            const FrameTraction t = evaluate(moved, tangent);
            return i == 2 ? t.pressure : t.tangential[i];
          },
          1e-6);
      error.add(std::abs(at.tangent[i][j] + derivative) / stiffness.normal);
    }
  return error.value();
}

void check_cone_and_return() {
  WorstError stick_error, cone_error, direction_error, split_error;
  bool statuses = true;
  for (const auto &s : make_samples(false)) {
    const FrameTraction t = evaluate(s, ContactTangent::consistent);
    statuses = statuses && t.status == ContactStatus::stick && t.slip[0] == 0. && t.slip[1] == 0.;
    for (unsigned int i = 0; i < 2; ++i)
      stick_error.add(
          std::abs(t.tangential[i] - (s.tangential_n[i] - stiffness.tangential * s.increment[i])));
  }
  double min_dissipation = 1.;
  for (const auto &s : make_samples(true)) {
    const FrameTraction t = evaluate(s, ContactTangent::consistent);
    statuses = statuses && t.status == ContactStatus::slip;
    const double size = std::hypot(t.tangential[0], t.tangential[1]);
    cone_error.add(std::abs(size / (coulomb.coefficient() * t.pressure) - 1.));
    const std::array<double, 2> trial{s.tangential_n[0] - stiffness.tangential * s.increment[0],
                                      s.tangential_n[1] - stiffness.tangential * s.increment[1]};
    direction_error.add(std::abs(trial[0] * t.tangential[1] - trial[1] * t.tangential[0]) / (size * size));
    for (unsigned int i = 0; i < 2; ++i) // t = t_n − k_t (Δg − Δg_slip), eqs. (25)-(32)
      split_error.add(std::abs(t.tangential[i] - s.tangential_n[i] +
                               stiffness.tangential * (s.increment[i] - t.slip[i])) /
                      size);
    min_dissipation = std::min(min_dissipation, -(t.tangential[0] * t.slip[0] + t.tangential[1] * t.slip[1]));
  }
  check("status follows the cone", statuses);
  check("sticking traction is the trial traction", stick_error.value(), 0.);
  check("slipping traction lies on the cone", cone_error.value(), 1e-14);
  check("slip returns along the trial traction", direction_error.value(), 1e-12);
  check("increment splits into elastic part and slip", split_error.value(), 1e-12);
  check("friction dissipates", min_dissipation > 0.);
}

void check_tangents() {
  WorstError stick, slip;
  for (const auto &s : make_samples(false))
    stick.add(tangent_error(s, ContactTangent::consistent));
  for (const auto &s : make_samples(true))
    slip.add(tangent_error(s, ContactTangent::consistent));
  check("stick, eq. (58): tangent is the derivative", stick.value(), 1e-9);
  check("slip, eqs. (55)-(57): consistent tangent is the derivative", slip.value(), 1e-7);

  // A node that enters within the step: Δg and k_t scale with φ(g); handed over as increment, scaled k_t and
  // slope.
  WorstError entering;
  const double gap_n = 0.004;
  for (const bool slipping : {false, true})
    for (Sample s : make_samples(slipping)) {
      s.tangential_n = {0., 0.};
      const auto enter = [&](const Sample &at) {
        const double fraction = at.gap / (at.gap - gap_n);
        const double slope = gap_n / (at.gap * (gap_n - at.gap));
        TangentialIncrement increment{at.increment};
        for (unsigned int i = 0; i < 2; ++i)
          increment.gradient[i][2] = slope * at.increment[i];
        return compute_traction(coulomb, {stiffness.normal, fraction * stiffness.tangential}, {}, at.gap,
                                at.tangential_n, increment);
      };
      const FrameTraction here = enter(s);
      for (unsigned int i = 0; i < 2; ++i) {
        const auto tangential = [&](const double h) {
          Sample moved = s;
          moved.gap += h;
          return enter(moved).tangential[i];
        };
        if (enter({s.gap - 2e-6, s.tangential_n, s.increment}).status ==
            enter({s.gap + 2e-6, s.tangential_n, s.increment}).status)
          entering.add(std::abs(here.tangent[i][2] + billet::testing::central_difference(tangential, 1e-6)) /
                       stiffness.normal);
      }
    }
  check("entering node: exact tangent is the derivative over the gap", entering.value(), 1e-7);
}

void check_variants() {
  WorstError continuum_error, mean_error, symmetry_error;
  bool lower_is_uncoupled = true, upper_is_full = true;
  for (const auto &s : make_samples(true)) {
    const auto consistent = evaluate(s, ContactTangent::consistent).tangent;
    const auto continuum = evaluate(s, ContactTangent::continuum).tangent;
    const auto upper = evaluate(s, ContactTangent::symmetrised_upper).tangent;
    const auto lower = evaluate(s, ContactTangent::symmetrised_lower).tangent;
    const auto mean = evaluate(s, ContactTangent::symmetrised_mean).tangent;
    const FrameTraction t = evaluate(s, ContactTangent::consistent);
    const double size = std::hypot(t.tangential[0], t.tangential[1]);
    const std::array<double, 2> d{t.tangential[0] / size, t.tangential[1] / size};
    for (unsigned int i = 0; i < 2; ++i) {
      for (unsigned int j = 0; j < 2; ++j) // (50): k_t (P − t̂⊗t̂)
        continuum_error.add(
            std::abs(continuum[i][j] - stiffness.tangential * ((i == j ? 1. : 0.) - d[i] * d[j])) /
            stiffness.tangential);
      lower_is_uncoupled = lower_is_uncoupled && lower[i][2] == 0. && lower[2][i] == 0.;
      upper_is_full = upper_is_full && upper[i][2] == consistent[i][2] && upper[2][i] == consistent[i][2];
    }
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j) {
        mean_error.add(std::abs(mean[i][j] - 0.5 * (upper[i][j] + lower[i][j])) / stiffness.normal);
        for (const auto &K : {upper, lower, mean})
          symmetry_error.add(std::abs(K[i][j] - K[j][i]) / stiffness.normal);
      }
  }
  check("continuum, eq. (50): β = 1", continuum_error.value(), 1e-14);
  check("symmetrised tangents are symmetric", symmetry_error.value(), 1e-15);
  check("mean is the mean of upper and lower", mean_error.value(), 1e-15);
  check("lower drops the coupling, upper mirrors it", lower_is_uncoupled && upper_is_full);
}

} // namespace

BILLET_TEST(traction) {
  check_cone_and_return();
  check_tangents();
  check_variants();
}

} // namespace traction_test
