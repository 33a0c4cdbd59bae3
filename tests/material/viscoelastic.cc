// SPDX-License-Identifier: LGPL-2.1-or-later
// Prony's series at a point: relaxation, a ramp and creep against closed forms, moduli against differences,
// objectivity, dissipation that is never negative, energy against work, and states from given stresses.

#include "rubber_laws.h"

namespace viscoelastic_test {

using namespace billet;
using namespace billet::testing;

namespace {

const PronySeries series{{0.3, 0.25, 0.1}, {0.02, 1., 30.}};
Tensor<2, 3> uniaxial(const double l) {
  Tensor<2, 3> F;
  F[0][0] = l;
  F[1][1] = F[2][2] = 1. / std::sqrt(l);
  return F;
}

/// Share of the stress left at a time after a sudden stretch.
double left(const double t) {
  double sum = 1.;
  for (std::size_t i = 0; i < series.times.size(); ++i)
    sum += series.moduli[i] * std::expm1(-t / series.times[i]);
  return sum;
}

/// A sudden general deformation, then steps of any length.
void test_relaxation() {
  for (const auto &[name, energy] : rubber_energies()) {
    const HyperelasticLaw elastic("test", energy, volume(logarithmic));
    const ViscoelasticLaw law(elastic, series);
    Random random;
    const Tensor<2, 3> F = strained(random, Tensor<1, 3>({0.8, -0.1, -0.5}));
    Point point(law), at_once(elastic);
    const SymmetricTensor<2, 3> instantaneous = at_once.evaluate(F, 0.);
    WorstError error;
    const auto compare = [&](const SymmetricTensor<2, 3> &tau, const double t) {
      error.add((dealii::deviator(tau) - left(t) * dealii::deviator(instantaneous)).norm() /
                instantaneous.norm());
      error.add(std::abs(trace(tau) - trace(instantaneous)) / instantaneous.norm());
    };
    compare(point.step(F, 0.), 0.);
    double t = 0.;
    for (const double dt : {1e-9, 0.003, 0.1, 2., 1e-5, 50., 1e4}) {
      t += dt;
      compare(point.step(F, dt), t);
    }
    check(name + ", relaxation at a constant deformation", error.value(), 1e-10);
    const double U = volume(logarithmic).energy(determinant(F));
    check(name + ", at rest the energy is the share that lasts",
          std::abs((point.stored(F) - U) / (at_once.stored(F) - U) - series.lasting_share()), 1e-12);
  }
}

/// Small strain at a constant rate: exact in steps of any length. Hencky's law is linear in ln λ.
void test_ramp() {
  constexpr double G = 0.4, rate = 0.3;
  const ViscoelasticLaw law(HyperelasticLaw("test", make_hencky_energy(G), volume(logarithmic)), series);
  WorstError error;
  for (const unsigned int n : {1U, 7U, 300U}) {
    Point point(law);
    constexpr double end = 2.5;
    SymmetricTensor<2, 3> tau;
    for (unsigned int i = 1; i <= n; ++i)
      tau = point.step(uniaxial(std::exp(rate * end * i / n)), end / n);
    double exact = series.lasting_share() * end;
    for (std::size_t i = 0; i < series.times.size(); ++i)
      exact -= series.moduli[i] * series.times[i] * std::expm1(-end / series.times[i]);
    error.add(std::abs((tau[0][0] - tau[1][1]) / (3. * G * rate * exact) - 1.));
  }
  check("a ramp of logarithmic strain, in 1, 7 and 300 steps", error.value(), 1e-10);
}

/// Constant deviator with one term: strain s/2G (1 + g/(1 − g) (1 − exp(−(1 − g) t/τ))).
double creep_error(const unsigned int n) {
  constexpr double G = 0.4, g = 0.6, tau_1 = 2., s = 0.2, end = 10.;
  const ViscoelasticLaw law(HyperelasticLaw("test", make_hencky_energy(G), volume(logarithmic)),
                            {{g}, {tau_1}});
  Point point(law);
  double low = 0., strain = 0.;
  for (unsigned int i = 0; i <= n; ++i) {
    const double dt = i == 0 ? 0. : end / n;
    double high = 3.;
    low = 0.;
    for (unsigned int k = 0; k < 60; ++k) {
      strain = 0.5 * (low + high);
      (point.evaluate(uniaxial(std::exp(strain)), dt)[0][0] > s ? high : low) = strain;
    }
    point.step(uniaxial(std::exp(strain)), dt);
  }
  const double exact = s / (2. * G) * (1. - g / (1. - g) * std::expm1(-(1. - g) * end / tau_1));
  return strain / exact - 1.;
}

void test_creep() {
  const double coarse = std::abs(creep_error(20)), fine = std::abs(creep_error(40));
  check("creep at a constant stress", fine, 1e-3);
  check("its error is of second order in the step", coarse / fine > 3.5 && coarse / fine < 4.5);
}

/// Moduli in states of a random history.
void test_moduli() {
  for (const auto &[name, energy] : rubber_energies()) {
    const ViscoelasticLaw law(HyperelasticLaw("test", energy, volume("quadratic")), series);
    WorstError error, turned;
    Random random;
    for (const Tensor<2, 3> &F : sampled_gradients()) {
      Point point(law), other(law);
      const Tensor<2, 3> first = strained(random, Tensor<1, 3>({0.4, 0.1, -0.3})), R = random.rotation();
      for (Point *each : {&point, &other}) {
        each->step(first, 0.1);
        each->step(unit, 0.7);
      }
      error.add(moduli_error(point, F, 0.3));
      const auto tau = point.evaluate(F, 0.3);
      turned.add((static_cast<Tensor<2, 3>>(other.evaluate(R * F, 0.3)) - R * tau * transpose(R)).norm() /
                 (tau.norm() + 1.));
    }
    check(name + ", moduli", error.value(), 1e-7);
    check(name + ", stress turns", turned.value(), 1e-12);
  }
}

struct Balance {
  double least_dissipation = 0., min_stored = 0., defect = 0.;
};

/// Random large motion in n steps; work by Simpson's rule of the stress in the steps' ends and middles.
Balance go(const SpatialLaw &law, const unsigned int n, const double end, const double size) {
  Random random;
  const Tensor<2, 3> A = random.tensor(size), B = random.tensor(size), C = random.tensor(size);
  const auto at = [&](const double s) {
    Tensor<2, 3> F =
        static_cast<Tensor<2, 3>>(unit + std::sin(7. * s) * A + std::sin(12. * s) * B + s * s * C);
    return static_cast<Tensor<2, 3>>(F / std::cbrt(determinant(F)));
  };
  Point point(law);
  Balance balance;
  double work = 0., scale = 0.;
  SymmetricTensor<2, 3> tau, tau_n;
  for (unsigned int i = 1; i <= n; ++i) {
    const double s = static_cast<double>(i) / n;
    const double before = point.dissipated();
    tau_n = tau;
    const Tensor<2, 3> F = at(s), F_n = at(s - 1. / n);
    tau = point.step(F, end / n);
    const Tensor<2, 3> L = 2. * (F - F_n) * invert(F + F_n);
    work += scalar_product(static_cast<Tensor<2, 3>>(0.5 * (tau + tau_n)), L);
    scale = std::max(scale, point.stored(F) + point.dissipated());
    balance.least_dissipation = std::min(balance.least_dissipation, point.dissipated() - before);
    balance.min_stored = std::min(balance.min_stored, point.stored(F) / scale);
    balance.defect = std::abs(work - point.stored(F) - point.dissipated()) / scale;
  }
  return balance;
}

void test_dissipation() {
  for (const auto &[name, energy] : rubber_energies()) {
    const ViscoelasticLaw law(HyperelasticLaw("test", energy, volume(logarithmic)), series);
    WorstError created, negative;
    for (const double end : {1e-4, 0.05, 2., 1e3})
      for (const unsigned int n : {3U, 30U, 300U}) {
        const Balance balance = go(law, n, end, 0.35);
        created.add(-balance.least_dissipation);
        negative.add(-balance.min_stored);
      }
    check(name + ", no step dissipates less than nothing", created.value(), 0.);
    check(name + ", and none stores less", negative.value(), 1e-12);
    const double coarse = go(law, 1000, 2., 0.35).defect, fine = go(law, 2000, 2., 0.35).defect;
    check(name + ", work is stored or dissipated", fine, 1e-4);
    check(name + ", to second order in the step", coarse / fine > 3.4 && coarse / fine < 4.6);
    // fast: all is stored
    check(name + ", a fast motion dissipates nothing", go(law, 500, 1e-9, 0.35).defect, 1e-4);
  }
}

void test_given_stress() {
  const HyperelasticLaw elastic("test", mooney_energy(), volume(logarithmic));
  const ViscoelasticLaw law(elastic, series);
  Random random;
  const Tensor<2, 3> F = strained(random, Tensor<1, 3>({0.4, 0.1, -0.3}));
  const SymmetricTensor<2, 3> given = dealii::deviator(dealii::symmetrize(random.tensor(0.3)));
  Point point(law);
  law.set_stress(F, given, 0., point.state().data());
  check("a state with a given deviator", (dealii::deviator(point.evaluate(F, 0.)) - given).norm(), 1e-12);
  double n = 0.;
  for (const StateField &field : law.fields())
    n += static_cast<double>(field.n_components);
  check("fields name all numbers", n == static_cast<double>(law.n_state()));
  check("without a series the law is the elastic one", make_hyperelastic_law(elastic, {})->n_state() == 0);
}

} // namespace

BILLET_TEST(viscoelastic) {
  test_relaxation();
  test_ramp();
  test_creep();
  test_moduli();
  test_dissipation();
  test_given_stress();
}

} // namespace viscoelastic_test
