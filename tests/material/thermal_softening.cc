// SPDX-License-Identifier: LGPL-2.1-or-later
// Thermal factors and adiabatic heating: with Johnson and Cook's factor of exponent 1 the softening of a
// material at a constant rate is exp(−a W(α)), a = β/(ρ c (T_m − T_r)); a step has the factor
// θ_n/(1 + a ΔW). Known numbers of 4340 steel. Tables. A factor of 1 is Hencky's law; the tangent is
// symmetric without directions. Moduli against differences, with heat, rates, backstress and anisotropy. The
// slope of the flow stress with heat sums up to the flow stress, and changes its sign at the maximum.

#include "point_driver.h"
#include "texts.h"

#include "billet/material/flow_rule_plastic.h"

#include <fstream>
#include <map>

namespace thermal_softening_test {

using namespace billet;
using namespace billet::testing;

namespace {

using Isotropic = FlowRulePlasticity<false, true>;
using Directed = FlowRulePlasticity<true, true>;

constexpr double room = 293., melting = 1793.;

std::shared_ptr<const ThermalFactor> johnson_cook(const std::string &exponent) {
  return thermal_factor_types()
      .find("Johnson-Cook")
      ->make(Texts({{"Reference temperature", "293"},
                    {"Melting temperature", "1793"},
                    {"Thermal exponent", exponent}}));
}

/// β/(ρ c) of 4340 steel in N, mm, K.
constexpr double heating = 0.9 / (7.83e-9 * 477e6);

template <class Law>
Law make_law(const SharedFlow &flow, const std::string &exponent, const double heat = heating,
             FlowRule rule = {}) {
  rule.thermal = johnson_cook(exponent);
  rule.heating = heat;
  return Law(steel, flow, rule);
}

/// Curves at three temperatures, of which `linear` is the first.
std::shared_ptr<const ThermalFactor> thermal_curves() {
  std::ofstream("thermal_curves.csv") << "0,700,500,200\n0.2,760,530,210\n2,1300,800,300\n";
  return thermal_factor_types().find("curves")->make(
      Texts(std::map<std::string, std::string>{{"Curve temperatures", "293, 600, 1200"},
                                               {"Thermal curves file", "thermal_curves.csv"},
                                               {"Thermal curves columns", "1, 2, 3, 4"}}));
}

Isotropic law_of_curves(const double heat) {
  FlowRule rule;
  rule.thermal = thermal_curves();
  rule.heating = heat;
  return Isotropic(steel, make_hardening(linear), rule);
}

/// Pure shear to a strain whose equivalent plastic strain the law finds.
template <class Law, class Visit>
void shear(const Law &law, const double measure, const unsigned int n_steps, const double dt,
           const Visit &visit, const double temperature = room) {
  typename Law::History history_n, history;
  PointStep step;
  step.dt = dt;
  step.temperature = temperature;
  for (unsigned int i = 1; i <= n_steps; ++i) {
    const double e = 0.5 * std::sqrt(3.) * measure * i / n_steps;
    Tensor<2, 3> F;
    F[0][0] = std::exp(e);
    F[1][1] = std::exp(-e);
    F[2][2] = 1.;
    SymmetricTensor<2, 3> tau;
    if (!law.update(F, history_n, history, tau, nullptr, step))
      return check("shear fails", false);
    visit(std::sqrt(1.5) * dealii::deviator(tau).norm(), history_n, history);
    history_n = history;
  }
}

template <class Hardening> void test_closed_form(const std::string &name, const Hardening &hardening) {
  const Isotropic law = make_law<Isotropic>(make_hardening(hardening), "1");
  const double a = heating / (melting - room);
  WorstError error, heat, work;
  double theta = 1., last_error = 0., order = 0.;
  shear(law, 1., 20, 1., [&](const double q, const auto &before, const auto &after) {
    const double alpha = after.equivalent_plastic_strain,
                 step_work = hardening.work(alpha) - hardening.work(before.equivalent_plastic_strain);
    theta /= 1. + a * step_work;
    error.add(std::abs(q / (theta * hardening.stress(alpha)) - 1.));
    heat.add(std::abs(after.temperature_rise - (melting - room) * (1. - theta)) / 100.);
    work.add(std::abs(law.plastic_work(after) - law.plastic_work(before) - theta * step_work) / 100.);
  });
  check(name + ", flow stress of each step", error.value(), 1e-10);
  check(name + ", temperature of each step", heat.value(), 1e-10);
  check(name + ", dissipation of each step", work.value(), 1e-10);
  for (const unsigned int n : {100U, 200U}) {
    double end = 0.;
    shear(law, 1., n, 1., [&](const double, const auto &, const auto &after) {
      end = after.temperature_rise -
            (melting - room) * -std::expm1(-a * hardening.work(after.equivalent_plastic_strain));
    });
    order = std::log2(std::abs(last_error / end));
    last_error = end;
  }
  check(name + ", steps tend to the closed form", std::abs(order - 1.), 0.05);
}

/// A + B e^n of 4340 steel; the prestrain keeps the slope finite.
struct Steel4340 {
  static std::string description() { return "hardening of 4340 steel"; }
  static constexpr double A = 792., B = 510., n = 0.26, start = 1e-9;
  double stress(const double a) const { return A + B * std::pow(a + start, n); }
  double slope(const double a) const { return B * n * std::pow(a + start, n - 1.); }
  double work(const double a) const {
    return A * a + B * (std::pow(a + start, n + 1.) - std::pow(start, n + 1.)) / (n + 1.);
  }
  bool is_bounded() const { return false; }
};

void test_known_numbers() {
  const auto rate = rate_factor_types()
                        .find("Johnson-Cook")
                        ->make(GivenValues({{"Rate coefficient", 0.014}, {"Lowest rate", 1.}}));
  check("Johnson and Cook's factor of the rate",
        std::abs(rate->value(1e3) - 1. - 0.014 * std::log(1e3)) + std::abs(rate->value(0.5) - 1.) +
            std::abs(rate->value(1.) - 1.) + std::abs(rate->slope(10.) - 0.0014),
        1e-14);
  for (const auto &[exponent, strain, stress, rise, allowed] :
       {std::tuple("1", 0.3, 1206.19, 83.82, 2e-3), std::tuple("1", 1., 1156.46, 285.15, 2e-3),
        std::tuple("1.03", 0.3, 1211.9, 84.1, 3e-3), std::tuple("1.03", 1., 1168.0, 286.9, 3e-3)}) {
    const Isotropic law = make_law<Isotropic>(at_rate(Steel4340(), rate), exponent);
    // The elastic strain, σ/3G, does not count.
    const double measure = strain + stress / (3. * steel.shear);
    double q = 0., heat = 0.;
    shear(law, measure, 800, measure / 800. / 1e3, [&](const double now, const auto &, const auto &after) {
      q = now;
      heat = after.temperature_rise;
    });
    const std::string name =
        std::string("4340 steel, exponent ") + exponent + ", strain " + std::to_string(strain);
    check(name + ", stress", std::abs(q / stress - 1.), allowed);
    check(name + ", temperature", std::abs(heat / rise - 1.), 5e-3);
  }
}

/// Without heat, the stress is that between the curves.
void test_curves() {
  WorstError error;
  for (const auto &[temperature, low, high, part] :
       {std::tuple(200., 0, 0, 0.), std::tuple(446.5, 0, 1, 0.5), std::tuple(1050., 1, 2, 0.75),
        std::tuple(2000., 2, 2, 0.)}) {
    const auto curve = [](const int k, const double alpha) {
      constexpr double stresses[3][3] = {{700., 760., 1300.}, {500., 530., 800.}, {200., 210., 300.}};
      const auto &at = stresses[k];
      return alpha < 0.2 ? at[0] + (at[1] - at[0]) * alpha / 0.2
                         : at[1] + (at[2] - at[1]) * (alpha - 0.2) / 1.8;
    };
    const auto visit = [&, low = low, high = high, part = part](const double q, const auto &,
                                                                const auto &after) {
      const double alpha = after.equivalent_plastic_strain;
      error.add(std::abs(q / ((1. - part) * curve(low, alpha) + part * curve(high, alpha)) - 1.));
    };
    shear(law_of_curves(0.), 1., 50, 1., visit, temperature);
  }
  check("curves at temperatures, stress between them", error.value(), 1e-10);
  const auto refuses = [](const char *temperatures) {
    try {
      thermal_factor_types().find("curves")->make(
          Texts(std::map<std::string, std::string>{{"Curve temperatures", temperatures},
                                                   {"Thermal curves file", "thermal_curves.csv"},
                                                   {"Thermal curves columns", "1, 2, 3"}}));
    } catch (const std::invalid_argument &) {
      return true;
    }
    return false;
  };
  check("curves refuse temperatures",
        refuses("293") && refuses("300, 300") && refuses("1, 2, 3") && !refuses("-20, 400"));
}

void test_tables() {
  const auto thermal =
      thermal_factor_types().find("table")->make(Texts("Thermal table", "300 : 1, 500 : 0.8, 1000 : 0.2"));
  check("thermal table, values",
        std::abs(thermal->value(100.) - 1.) + std::abs(thermal->value(400.) - 0.9) +
            std::abs(thermal->value(750.) - 0.5) + std::abs(thermal->value(2000.) - 0.2),
        1e-14);
  check("thermal table, slopes",
        std::abs(thermal->slope(400.) + 1e-3) + std::abs(thermal->slope(750.) + 1.2e-3) +
            std::abs(thermal->slope(100.)) + std::abs(thermal->slope(2000.)),
        1e-16);
  const auto rate = rate_factor_types().find("table")->make(Texts("Rate table", "10 : 1.5, 1000 : 2"));
  check("rate table, values",
        std::abs(rate->value(0.) - 1.) + std::abs(rate->value(5.) - 1.25) +
            std::abs(rate->value(505.) - 1.75) + std::abs(rate->value(1e6) - 2.),
        1e-14);
  const auto refuses = [](const auto &types, const char *key, const std::string &text) {
    try {
      types.find("table")->make(Texts(key, text));
    } catch (const std::invalid_argument &) {
      return true;
    }
    return false;
  };
  for (const std::string text : {"", "300", "300 : 0", "300 : 1, 300 : 0.9", "300 : x"})
    check("thermal table refuses '" + text + "'", refuses(thermal_factor_types(), "Thermal table", text));
  for (const std::string text : {"", "10", "0 : 1", "10 : 0.9", "10 : 2, 20 : 1.5", "10 : 2, 10 : 3"})
    check("rate table refuses '" + text + "'", refuses(rate_factor_types(), "Rate table", text));
}

/// Integrates the slope along a path, after a steep start, and compares it with the flow stress.
template <class Law> void test_slope(const std::string &name, const Law &law) {
  constexpr unsigned int n_steps = 4000;
  constexpr double start = 0.05;
  double sum = 0., first = 0., last = 0., maximum = 0., strain_of_maximum = 0., strain_of_change = 0.,
         slope_before = 0., strain_before = 0.;
  shear(law, 1., n_steps, 1. / n_steps, [&](const double q, const auto &, const auto &after) {
    const double alpha = after.equivalent_plastic_strain, slope = *law.flow_slope(after, room);
    if (alpha < start)
      first = sum = q;
    else
      sum += 0.5 * (slope + slope_before) * (alpha - strain_before);
    if (slope < 0. && strain_of_change == 0.)
      strain_of_change = alpha;
    slope_before = slope;
    strain_before = alpha;
    last = q;
    if (q > maximum) {
      maximum = q;
      strain_of_maximum = alpha;
    }
  });
  check(name + ", flow stress from its slope", std::abs(sum - last) / maximum, 1e-3);
  check(name + ", strain of its maximum", std::abs(strain_of_change / strain_of_maximum - 1.), 0.01);
  check(name + ", it rises and falls", maximum > 1.003 * std::max(first, last));
}

template <class Law> void test_moduli(const std::string &name, const Law &law, const bool is_symmetric) {
  Random random;
  PointStep step;
  step.dt = 0.1;
  step.temperature = 400.;
  WorstError error, skew;
  typename Law::History history_n, history;
  Tensor<2, 3> F = unit;
  unsigned int n_yields = 0;
  for (unsigned int i = 0; i < 60; ++i) {
    F = (unit + random.tensor(i < 30 ? 0.02 : 0.1)) * F;
    F /= std::cbrt(dealii::determinant(F));
    SymmetricTensor<2, 3> tau;
    SpatialModuli c;
    if (!law.update(F, history_n, history, tau, &c, step))
      return check(name + " fails", false);
    skew.add(asymmetry(c));
    if (history.equivalent_plastic_strain > history_n.equivalent_plastic_strain + 1e-4) {
      ++n_yields;
      for (unsigned int j = 0; j < 9; ++j) {
        Tensor<2, 3> L;
        L[j / 3][j % 3] = 1.;
        const SymmetricTensor<2, 3> difference = central_difference(
            [&](const double e) {
              typename Law::History ignored;
              SymmetricTensor<2, 3> at;
              law.update((unit + e * L) * F, history_n, ignored, at, nullptr, step);
              return at;
            },
            1e-5);
        error.add((predict(c, tau, L) - static_cast<Tensor<2, 3>>(difference)).norm() / norm(c));
      }
    }
    // At rest the stress of the end is that of the state.
    typename Law::History same;
    SymmetricTensor<2, 3> again;
    PointStep rest;
    rest.temperature = step.temperature;
    law.update(F, history, same, again, nullptr, rest);
    error.add((again - tau).norm() / tau.norm() * 1e2);
    history_n = history;
  }
  check(name + ", it yields", n_yields > 40);
  check(name + ", moduli, and the same stress at rest", error.value(), 1e-7);
  check(name + ", temperature rises", history.temperature_rise > 30.);
  if (is_symmetric)
    check(name + ", symmetry", skew.value(), 1e-9);
}

} // namespace

BILLET_TEST(thermal_softening) {
  test_closed_form("linear", linear);
  test_closed_form("Voce", voce);
  test_closed_form("power law", power_law);
  test_known_numbers();
  test_tables();
  test_moduli("linear", make_law<Isotropic>(make_hardening(linear), "1"), true);
  test_moduli("at a rate", make_law<Isotropic>(at_rate(voce, cowper_symonds(40., 5.)), "1.03"), true);
  test_curves();
  test_moduli("curves at temperatures", law_of_curves(heating), true);
  test_slope("slope, linear", make_law<Isotropic>(make_hardening(linear), "1", 30. * heating));
  test_slope("slope, 4340 steel at a rate",
             make_law<Isotropic>(at_rate(Steel4340(), cowper_symonds(40., 5.)), "1.03"));
  test_slope("slope, curves at temperatures", law_of_curves(30. * heating));
  FlowRule kinematic;
  kinematic.backstress = {{2000., 10.}};
  test_slope("slope, backstress", make_law<Directed>(make_hardening(linear), "1", 10. * heating, kinematic));
  FlowRule rule;
  rule.backstress = {{20000., 100.}, {1500., 0.}};
  rule.anisotropy = std::make_shared<const Anisotropy>(Anisotropy{
      HillCoefficients::from_r_values(1.79, 1.51, 2.27),
      Axes({Tensor<1, 3>({0.6, 0.8, 0.}), Tensor<1, 3>({-0.8, 0.6, 0.}), Tensor<1, 3>({0., 0., 1.})})});
  test_moduli("with directions at a rate",
              make_law<Directed>(at_rate(voce, cowper_symonds(40., 5.)), "1.03", heating, rule), false);
}

} // namespace thermal_softening_test
