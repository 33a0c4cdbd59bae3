// SPDX-License-Identifier: LGPL-2.1-or-later
// Hardening laws: slope and work against their definition, and the consistency condition to round-off.

#include "../sample_laws.h"
#include "../testing.h"

#include <deal.II/base/quadrature_lib.h>

namespace hardening_test {

using namespace billet;
using namespace billet::testing;

/// ∫_0^a stress by Gauss's rule on panels that double from 1e-5 and end at each of `kinks`.
template <class Hardening>
double integrate_stress(const Hardening &hardening, const double a, const std::vector<double> &kinks) {
  const dealii::QGauss<1> gauss(12);
  double sum = 0., left = 0., width = 1e-5;
  while (left < a) {
    double right = std::min(a, left + width);
    for (const double kink : kinks)
      if (left < kink && kink < right)
        right = kink;
    for (unsigned int q = 0; q < gauss.size(); ++q)
      sum += gauss.weight(q) * (right - left) * hardening.stress(left + gauss.point(q)[0] * (right - left));
    left = right;
    width *= 2.;
  }
  return sum;
}

/// `scale(a)` is the strain over which the law varies near a.
template <class Hardening, class Scale>
void test_derivative_and_integral(const std::string &name, const Hardening &hardening, const Scale &scale,
                                  const std::vector<double> &kinks = {}) {
  WorstError slope_error, work_error;
  for (const double a : {0., 1e-5, 1e-3, 0.02, 0.05, 0.3, 0.7, 2.}) {
    const double difference =
        central_difference([&](const double da) { return hardening.stress(a + da); }, 1e-3 * scale(a));
    slope_error.add(std::abs(hardening.slope(a) - difference) /
                    (std::abs(difference) + 1e-3 * hardening.stress(a)));
    const double integral = integrate_stress(hardening, a, kinks);
    work_error.add(std::abs(hardening.work(a) - integral) / (integral + 1e-300));
  }
  check(name + ", slope", slope_error.value(), 1e-9);
  check(name + ", work", work_error.value(), 1e-12);
}

/// Chooses Δα, makes the trial stress q = 3G Δα + σ_y(α_n + Δα) that belongs to it, and asks for Δα.
/// Round-off of q moves the root by ε q / (3G + slope); the bound allows eight of them, and the residual the
/// same.
template <class Hardening>
void test_consistency(const std::string &name, const Hardening &hardening,
                      const double three_g = 3. * 76923.) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  WorstError root_error, residual_error;
  bool inside = true;
  for (const double alpha_n : {0., 1e-6, 0.0099, 0.05, 0.3, 3.})
    for (const double delta : {1e-12, 1e-8, 1e-5, 1e-4, 1e-3, 1.5e-3, 0.02, 0.095, 0.5, 3., 1e3, 1e8}) {
      const double q = three_g * delta + hardening.stress(alpha_n + delta);
      const double found = solve_consistency(hardening, q, three_g, alpha_n);
      root_error.add(three_g * std::abs(found - delta) / (epsilon * q));
      residual_error.add(std::abs(q - three_g * found - hardening.stress(alpha_n + found)) / (epsilon * q));
      inside &= found >= 0. && found <= q / three_g;
    }
  check(name + ", consistency, root in round-off", root_error.value(), 8.);
  check(name + ", consistency, residual in round-off", residual_error.value(), 8.);
  check(name + ", consistency, 0 <= root <= q/3G", inside);
}

BILLET_TEST(hardening) {
  const auto unit_scale = [](const double) { return 1.; };
  test_derivative_and_integral("perfect plasticity", perfect, unit_scale);
  test_derivative_and_integral("linear hardening", linear, unit_scale);
  test_derivative_and_integral("Voce hardening", voce,
                               [](const double) { return 1. / voce.saturation_rate; });
  test_derivative_and_integral("power law", power_law,
                               [](const double a) { return power_law.prestrain + a; });
  test_derivative_and_integral("steep power law", steep_power_law,
                               [](const double a) { return steep_power_law.prestrain + a; });
  std::vector<double> doubled; // panels for a curve whose slope goes to infinity
  for (double a = LudwikHardening::a_0; a < 2.; a *= 2.)
    doubled.push_back(a);
  test_derivative_and_integral(
      "Ludwik", ludwik, [](const double a) { return std::max(a, 0.5 * LudwikHardening::a_0); }, doubled);
  test_derivative_and_integral("table", table, [](const double) { return 1e-3; }, {0.01, 0.1, 0.5});

  // Values that can be read off.
  check("linear hardening, value", std::abs(linear.stress(0.5) - 850.), 1e-12);
  check("Voce hardening, start and end",
        std::abs(voce.stress(0.) - 450.) + std::abs(voce.stress(10.) - (715. + 1292.4)), 1e-12);
  check("power law, value", std::abs(power_law.stress(1. - 0.0071) - 565.3), 1e-12);
  check("Ludwik, values",
        std::abs(ludwik.stress(0.) - 90.) + std::abs(ludwik.stress(1.) - 382.) +
            std::abs(ludwik.stress(LudwikHardening::a_0 / 2.) - 90. -
                     146. * std::pow(LudwikHardening::a_0, 0.31)),
        1e-10);
  check("table, at its points",
        std::abs(table.stress(0.) - 400.) + std::abs(table.stress(0.01) - 450.) +
            std::abs(table.stress(0.1) - 520.) + std::abs(table.stress(0.5) - 600.),
        1e-12);
  check("table, between its points", std::abs(table.stress(0.055) - 485.), 1e-12);
  check("table, slope from the right at its points",
        std::abs(table.slope(0.) - 5000.) + std::abs(table.slope(0.01) - 70. / 0.09) +
            std::abs(table.slope(0.1) - 200.),
        1e-9);
  check("table, slope from the left of a kink", std::abs(table.slope(0.01 - 1e-12) - 5000.), 1e-9);
  check("table, beyond its end",
        std::abs(table.stress(7.) - 600.) + std::abs(table.slope(0.5)) + table.slope(7.), 1e-12);
  check("table, work beyond its end", std::abs(table.work(1.5) - table.work(0.5) - 600.), 1e-10);
  const TabulatedHardening single({0.}, {250.});
  check("table of one point is perfect plasticity",
        std::abs(single.stress(0.4) - 250.) + std::abs(single.slope(0.4)) + std::abs(single.work(0.4) - 100.),
        1e-12);

  for_each_hardening(
      [](const std::string &name, const auto &hardening) { test_consistency(name, hardening); });
  test_consistency("Ludwik", ludwik);
  test_consistency("almost no hardening", LinearHardening{700., 1e-9});
  test_consistency("hardening far above 3G", LinearHardening{700., 1e9});
  test_consistency("softening", LinearHardening{1e8, -1e-2});
  test_consistency("prestrain 1e-12", PowerLawHardening{589., 1e-12, 0.216});
  test_consistency("quick saturation", VoceHardening{100., 900., 1e5, 0.});
  test_consistency(
      "stiffening and softening kinks",
      TabulatedHardening({0., 0.001, 0.002, 0.1, 0.11, 3.}, {100., 100., 900., 950., 700., 5000.}));
  test_consistency("in other units", LinearHardening{7e-4, 3e-4}, 0.23);
}

} // namespace hardening_test
