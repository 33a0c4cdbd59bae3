// SPDX-License-Identifier: LGPL-2.1-or-later
// Kinematic hardening against closed forms: cyclic tension with terms of Prager, of Armstrong and Frederick
// and of Chaboche, in steps of any size; the saturated and the stabilised loop; ratcheting; simple shear to
// 1000 %. Without backstress the law is HenckyPlasticity. Moduli against differences along random paths;
// energies; objectivity.

#include "point_driver.h"

#include "billet/material/flow_rule_plastic.h"

namespace kinematic_hardening_test {

using namespace billet;
using namespace billet::testing;

namespace {

using Law = FlowRulePlasticity<true, false>;

template <class Hardening> Law make_law(const Hardening &hardening, std::vector<BackstressTerm> terms) {
  FlowRule rule;
  rule.backstress = std::move(terms);
  return Law(steel, make_hardening(hardening), rule);
}

const std::vector<BackstressTerm> prager = {{20000., 0.}}, armstrong = {{20000., 100.}},
                                  chaboche = {{60000., 600.}, {12000., 100.}, {1500., 0.}};

/// Uniaxial stress by closed forms: τ = E (e − e_p), and on a piece of monotone flow of size a
/// X_j = s C/g + (X_j − s C/g) exp(−g a).
struct Cycle {
  std::vector<BackstressTerm> terms;
  std::function<double(double)> yield_stress;
  double alpha = 0., plastic_strain = 0., stress = 0.;
  std::vector<double> parts = std::vector<double>(terms.size(), 0.);

  static double move_part(const BackstressTerm &term, const double part, const double sign, const double a) {
    if (term.rate == 0.)
      return part + sign * term.modulus * a;
    const double limit = sign * term.modulus / term.rate;
    return limit + (part - limit) * std::exp(-term.rate * a);
  }
  double backstress(const double sign, const double a) const {
    double sum = 0.;
    for (std::size_t j = 0; j < terms.size(); ++j)
      sum += move_part(terms[j], parts[j], sign, a);
    return sum;
  }
  void move_to(const double e) {
    const double trial = young * (e - plastic_strain) - backstress(0., 0.), sign = trial > 0. ? 1. : -1.;
    double a = 0.;
    if (std::abs(trial) > yield_stress(alpha)) {
      double low = 0., high = std::abs(trial) / young;
      for (unsigned int i = 0; i < 200; ++i) {
        a = 0.5 * (low + high);
        const double excess =
            sign * (young * (e - plastic_strain - sign * a) - backstress(sign, a)) - yield_stress(alpha + a);
        (excess > 0. ? low : high) = a;
      }
    }
    for (std::size_t j = 0; j < terms.size(); ++j)
      parts[j] = move_part(terms[j], parts[j], sign, a);
    alpha += a;
    plastic_strain += sign * a;
    stress = young * (e - plastic_strain);
  }
};

constexpr std::array<bool, 6> axial = {true, false, false, true, true, true},
                              no_shear = {false, false, false, true, true, true};

template <class Hardening>
void test_cycles(const std::string &name, const Hardening &hardening,
                 const std::vector<BackstressTerm> &terms) {
  WorstError error;
  for (const unsigned int n_steps : {1U, 7U}) {
    const Law law = make_law(hardening, terms);
    DrivenPoint<Law> point(law);
    Cycle exact{terms, [&](const double a) { return hardening.stress(a); }};
    double at = 0.;
    for (const double target : {0.03, -0.02, 0.4, 0.39, -0.5, 0.}) {
      for (unsigned int i = 1; i <= n_steps; ++i) {
        const double e = at + (target - at) * i / n_steps;
        point.move(axial, {e});
        exact.move_to(e);
        error.add(std::abs(point.stress[0] - exact.stress) / 500.);
        error.add(std::abs(point.history.equivalent_plastic_strain - exact.alpha));
        error.add(std::abs(point.history.backstress[0][0] * 1.5 - exact.backstress(0., 0.)) / 500.);
      }
      at = target;
    }
  }
  check(name + ", cycles", error.value(), 1e-10);
}

/// Numbers of benchmark data: C = 20000, g = 100, σ_y = 200.
void test_known_numbers() {
  const LinearHardening flat{200., 0.};
  const Law law = make_law(flat, armstrong);
  DrivenPoint<Law> saturated(law);
  saturated.move(axial, {1.});
  check("saturation at C/g", std::abs(saturated.stress[0] - 400.) / 400., 1e-10);

  const Law three = make_law(flat, chaboche);
  WorstError chaboche_error;
  for (const auto &[strain, stress] : {std::pair(0.001, 258.04), std::pair(0.005, 349.74),
                                       std::pair(0.02, 433.76), std::pair(0.1, 569.99)}) {
    DrivenPoint<Law> point(three);
    const double plastic = strain, exact = 200. + 100. * -std::expm1(-600. * plastic) +
                                           120. * -std::expm1(-100. * plastic) + 1500. * plastic;
    point.move(axial, {plastic + exact / young});
    chaboche_error.add(std::abs(exact / stress - 1.));
    check("three terms, plastic strain " + std::to_string(strain), std::abs(point.stress[0] - exact) / exact,
          1e-9);
  }
  check("three terms, known numbers", chaboche_error.value(), 2e-5);

  // Strain cycles of a given plastic range: amplitude σ_y + (C/g) tanh(g Δε_p/2).
  for (const double range : {0.01, 0.02}) {
    const double amplitude = 200. + 200. * std::tanh(0.5 * 100. * range),
                 strain = 0.5 * range + amplitude / young;
    DrivenPoint<Law> point(law);
    for (unsigned int i = 0; i < 40; ++i) {
      point.move(axial, {strain});
      point.move(axial, {-strain});
    }
    check("stabilised loop of range " + std::to_string(range),
          std::abs(point.stress[0] + amplitude) / amplitude, 1e-10);
  }

  // Stress cycles 350/-250: the drift is that of every cycle.
  DrivenPoint<Law> point(law);
  const double C = 20000., g = 100., high = 150., low = -50.;
  const auto plastic_strain = [&] { return point.strain[0] - point.stress[0] / young; };
  point.move(no_shear, {350.});
  check("ratcheting, first loading", std::abs(plastic_strain() + std::log(1. - g * high / C) / g), 1e-10);
  const double drift = std::log((C * C - g * g * low * low) / (C * C - g * g * high * high)) / g;
  WorstError error;
  for (unsigned int i = 0; i < 10; ++i) {
    const double before = plastic_strain();
    point.move(no_shear, {-250.});
    point.move(no_shear, {350.});
    error.add(std::abs(plastic_strain() - before - drift));
  }
  check("ratcheting, each cycle", error.value(), 1e-10);

  // Bauschinger: after tension the elastic range is 2 σ_y still.
  const Law linear_law = make_law(flat, prager);
  DrivenPoint<Law> bar(linear_law);
  bar.move(axial, {0.02});
  const double top = bar.stress[0], alpha = bar.history.equivalent_plastic_strain;
  bar.move(no_shear, {top - 399.999});
  check("Bauschinger, elastic until 2 sigma_y", std::abs(bar.history.equivalent_plastic_strain - alpha),
        1e-14);
  bar.move(no_shear, {top - 401.});
  check("Bauschinger, yields from there on",
        std::abs(bar.history.equivalent_plastic_strain - alpha - 1. / 20000.), 1e-9);
}

Tensor<2, 3> simple_shear(const double gamma) {
  Tensor<2, 3> F = unit;
  F[0][1] = gamma;
  return F;
}

/// Simple shear to 1000 %: no component oscillates. A stiff elasticity is close to a rigid one, whose Prager
/// backstress is τ12 = (2/3 C) 2 asinh(γ/2)/√(4 + γ²), with one maximum, 0.883659 C at γ = 3.01776.
void test_shear() {
  const LinearHardening flat{200., 0.};
  const auto run = [&](const std::vector<BackstressTerm> &terms, const unsigned int n_steps,
                       const auto &visit) {
    const Law law = make_law(flat, terms);
    Law::History history_n, history;
    SymmetricTensor<2, 3> tau;
    for (unsigned int i = 1; i <= n_steps; ++i) {
      const double gamma = 10. * i / n_steps;
      if (!law.update(simple_shear(gamma), history_n, history, tau, nullptr))
        return false;
      history_n = history;
      visit(gamma, tau, history);
    }
    return true;
  };
  for (const auto &[name, terms] : {std::pair("Prager", std::vector<BackstressTerm>{{300., 0.}}),
                                    std::pair("Armstrong-Frederick", armstrong)}) {
    double last = 0., smallest = 1e300, drop_until_5 = 0.;
    unsigned int n_turns = 0;
    bool was_rising = true;
    const bool runs = run(terms, 1000, [&](const double gamma, const auto &tau, const auto &) {
      const bool rises = tau[0][1] > last - 1e-9 * std::abs(last);
      n_turns += rises != was_rising ? 1 : 0;
      was_rising = rises;
      if (gamma <= 3.)
        drop_until_5 = std::max(drop_until_5, last - tau[0][1]);
      last = tau[0][1];
      smallest = std::min(smallest, tau[0][1]);
    });
    check(std::string(name) + ", shear stress keeps its sign", runs && smallest > 0.);
    check(std::string(name) + ", it turns at most once", n_turns <= 1);
    check(std::string(name) + ", it rises until 300 %", drop_until_5, 1e-9 * last);
  }
  WorstError back, flow;
  run({{300., 0.}}, 4000, [&](const double gamma, const auto &tau, const auto &history) {
    const double exact = 200. * 2. * std::asinh(0.5 * gamma) / std::sqrt(4. + gamma * gamma);
    if (gamma > 0.1) {
      back.add(std::abs(history.backstress[0][1] - exact) / 200.);
      flow.add(std::abs(tau[0][1] - history.backstress[0][1] - 200. / std::sqrt(3.)) / 115.);
    }
  });
  check("Prager in shear, backstress of rigid plasticity", back.value(), 5e-3);
  check("Prager in shear, flow stress stays that of pure shear", flow.value(), 5e-3);
}

template <class Hardening> void test_plain(const std::string &name, const Hardening &hardening) {
  const Law law = make_law(hardening, {});
  const HenckyPlasticity hencky(steel, make_hardening(hardening));
  WorstError stress, moduli, work, yield;
  for (const double size : {1e-3, 1e-2, 0.3}) {
    Law::History history_n, history;
    HenckyPlasticity::History known_n, known;
    follow_path(size, 30, [&](const Tensor<2, 3> &F) {
      SymmetricTensor<2, 3> tau, expected;
      SpatialModuli c, d;
      for (const double energy : {0.4, 0.}) {
        SharedYield shared, other;
        shared.energy = other.energy = energy;
        PointStep step, known_step;
        step.shared = &shared;
        known_step.shared = &other;
        if (!law.update(F, history_n, history, tau, &c, step) ||
            !hencky.update(F, known_n, known, expected, &d, known_step))
          return check(name + " fails", false);
        yield.add(std::abs(shared.share - other.share));
        yield.add(std::abs(shared.slope - other.slope) * 100.);
        yield.add((shared.rate - other.rate).norm() / 1e3);
        stress.add((tau - expected).norm() / expected.norm());
        moduli.add(distance(c, d) / norm(d));
      }
      work.add(std::abs(law.plastic_work(history) - hencky.plastic_work(known)) / 100.);
      work.add(std::abs(law.elastic_energy(F, history) - hencky.elastic_energy(F, known)));
      history_n = history;
      known_n = known;
    });
  }
  check(name + ", stress of the isotropic law", stress.value(), 1e-9);
  check(name + ", moduli of the isotropic law", moduli.value(), 1e-9);
  check(name + ", energies of the isotropic law", work.value(), 1e-9);
  check(name + ", shared yield of the isotropic law", yield.value(), 1e-9);
}

/// On a straight path the work of the stress is what is stored and dissipated, whatever the step.
void test_energy() {
  const Law law = make_law(voce, chaboche);
  const double span = 0.3;
  const auto stress_at = [&](const double e) {
    Law::History history;
    SymmetricTensor<2, 3> tau;
    Tensor<2, 3> F;
    F[0][0] = std::exp(e);
    F[1][1] = std::exp(-e);
    F[2][2] = 1.;
    law.update(F, {}, history, tau, nullptr);
    return std::tuple(tau[0][0] - tau[1][1], law.elastic_energy(F, history) + law.plastic_work(history));
  };
  double work = 0.;
  const auto add_work = [&](const double from, const double to, const unsigned int n) { // Simpson
    for (unsigned int i = 0; i < n; ++i) {
      const double a = from + (to - from) * i / n, b = from + (to - from) * (i + 1) / n;
      work += (b - a) / 6. *
              (std::get<0>(stress_at(a)) + 4. * std::get<0>(stress_at(0.5 * (a + b))) +
               std::get<0>(stress_at(b)));
    }
  };
  const double yields = voce.stress(0.) / (2. * std::sqrt(3.) * steel.shear); // a kink
  add_work(0., yields, 1);
  add_work(yields, span, 2000);
  check("energies in one step", std::abs(std::get<1>(stress_at(span)) / work - 1.), 1e-8);
}

void test_objectivity() {
  const Law law = make_law(voce, chaboche);
  Law::History start, history;
  SymmetricTensor<2, 3> tau_0, tau;
  Random random;
  const Tensor<2, 3> F = unit + random.tensor(0.3);
  law.update(F, {}, start, tau_0, nullptr);
  WorstError error;
  Law::History history_n = start;
  for (unsigned int i = 0; i < 50; ++i) {
    const Tensor<2, 3> R = random.rotation();
    law.update(R * F, history_n, history, tau, nullptr);
    error.add((static_cast<Tensor<2, 3>>(tau) - R * tau_0 * transpose(R)).norm() / tau_0.norm());
    error.add((static_cast<Tensor<2, 3>>(history.backstress) - R * start.backstress * transpose(R)).norm() /
              start.backstress.norm());
    history_n = history;
  }
  check("a rotation turns stress and backstress", error.value(), 1e-9);
}

} // namespace

BILLET_TEST(kinematic_hardening) {
  test_plain("linear", linear);
  test_plain("Voce", voce);
  test_plain("table", table);
  for_each_hardening([](const std::string &name, const auto &hardening) {
    test_cycles(name + ", Prager", hardening, prager);
    test_cycles(name + ", Armstrong-Frederick", hardening, armstrong);
    test_cycles(name + ", Chaboche", hardening, chaboche);
  });
  test_known_numbers();
  test_shear();
  PointStep step;
  step.dt = 0.1;
  test_moduli("Prager", make_law(linear, prager), step, 40, 60);
  test_moduli("Armstrong-Frederick", make_law(voce, armstrong), step, 40, 60);
  test_moduli("Chaboche", make_law(perfect, chaboche), step, 40, 60);
  FlowRule rule;
  rule.backstress = chaboche;
  test_moduli("Chaboche at a rate", Law(steel, at_rate(power_law, cowper_symonds(40., 5.)), rule), step, 40,
              60);
  test_energy();
  test_objectivity();
}

} // namespace kinematic_hardening_test
