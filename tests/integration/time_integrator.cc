// SPDX-License-Identifier: LGPL-2.1-or-later
// Newmark's family on a single degree of freedom, against closed forms.
#include "billet/integration/time_integrator_type.h"
#include <sstream>

#include "../testing.h"

#include <array>
#include <vector>

namespace time_integrator_test {

using namespace billet;
using billet::testing::check;
using billet::testing::WorstError;

namespace {

/// m ü + c u̇ + k u = 0 with m = 1.
struct Oscillator {
  double k, c;
};
struct State {
  double u, v, a;
};

double force(const Oscillator &o, const State &s) { return o.k * s.u + o.c * s.v; }

/// The equation as the program solves it: for the displacement at the end of the step.
State advance(const TimeIntegrator &integrator, const Oscillator &o, const double dt, const State &s) {
  const auto v = integrator.velocity(dt), a = integrator.acceleration(dt);
  const auto at = [&](const double increment) {
    return State{s.u + increment, v.increment * increment + v.velocity * s.v + v.acceleration * s.a,
                 a.increment * increment + a.velocity * s.v + a.acceleration * s.a};
  };
  const State still = at(0.);
  const double residual = force(o, still) + integrator.forces_before() * force(o, s) +
                          integrator.inertia_now() * still.a + integrator.inertia_before() * s.a;
  const double tangent = o.k + o.c * integrator.damping_factor(dt) + integrator.mass_factor(dt);
  return at(-residual / tangent);
}

/// Largest size of the eigenvalues of a step, by squaring its matrix.
double spectral_radius(const TimeIntegrator &integrator, const double omega_dt) {
  using Matrix = std::array<std::array<double, 3>, 3>;
  const Oscillator o{omega_dt * omega_dt, 0.};
  Matrix A{};
  for (unsigned int j = 0; j < 3; ++j) {
    const State s = advance(integrator, o, 1., {j == 0 ? 1. : 0., j == 1 ? 1. : 0., j == 2 ? 1. : 0.});
    A[0][j] = s.u;
    A[1][j] = s.v;
    A[2][j] = s.a;
  }
  // In units in which its entries are alike.
  const double scale = std::max(1., omega_dt);
  const std::array<double, 3> units{1., scale, scale * scale};
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j)
      A[i][j] *= units[j] / units[i];
  double log_size = 0.;
  constexpr unsigned int n_squares = 24;
  double power = 1.;
  for (unsigned int n = 0; n < n_squares; ++n) {
    double size = 0.;
    for (const auto &row : A)
      for (const double entry : row)
        size = std::max(size, std::abs(entry));
    if (size == 0.)
      return 0.;
    log_size += std::log(size) / power;
    Matrix square{};
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        for (unsigned int k = 0; k < 3; ++k)
          square[i][j] += A[i][k] / size * A[k][j] / size;
    A = square;
    power *= 2.;
  }
  return std::exp(log_size);
}

/// Error after a unit of time from u = 1 at rest.
double final_error(const TimeIntegrator &integrator, const unsigned int n) {
  const Oscillator o{30., 0.8};
  State s{1., 0., -o.k};
  for (unsigned int i = 0; i < n; ++i)
    s = advance(integrator, o, 1. / n, s);
  const double damping = 0.5 * o.c, omega = std::sqrt(o.k - damping * damping);
  return std::abs(s.u - std::exp(-damping) * (std::cos(omega) + damping / omega * std::sin(omega)));
}

} // namespace

BILLET_TEST(time_integrator) {
  const TimeIntegrator trapezoidal = newmark(0.25, 0.5);
  std::vector<std::pair<std::string, TimeIntegrator>> methods = {{"Newmark", trapezoidal}};
  for (const double alpha : {-1. / 3., -0.1, -0.05, 0.})
    methods.emplace_back("HHT " + std::to_string(alpha), hilber_hughes_taylor(alpha));
  for (const double rho : {0., 0.5, 0.8, 1.})
    methods.emplace_back("generalised " + std::to_string(rho), generalised_alpha(rho));

  WorstError hht_radius, generalised_radius;
  for (const double alpha : {-1. / 3., -0.1, -0.05, 0.})
    hht_radius.add(std::abs(spectral_radius(hilber_hughes_taylor(alpha), 1e6) - (1. + alpha) / (1. - alpha)));
  for (const double rho : {0., 0.25, 0.5, 0.8, 1.})
    generalised_radius.add(std::abs(spectral_radius(generalised_alpha(rho), 1e6) - rho));
  check("spectral radius at infinity of HHT is (1 + alpha)/(1 - alpha)", hht_radius.value(), 1e-4);
  check("spectral radius at infinity of generalised-alpha is what is asked for", generalised_radius.value(),
        1e-3); // of rho = 0, a triple root, its round-off
  check("spectral radius at infinity of Newmark with gamma is that of its closed form",
        std::abs(spectral_radius(newmark(0.4225, 0.8), 1e6) - 0.7 / 1.3), 1e-4);

  for (const auto &[name, integrator] : methods) {
    double maximum = 0.;
    for (double omega_dt = 1e-3; omega_dt < 1e7; omega_dt *= 1.7)
      maximum = std::max(maximum, spectral_radius(integrator, omega_dt));
    check(name + ": stable for any step", maximum - 1., 1e-5);
    check(name + ": second order",
          std::abs(std::log2(final_error(integrator, 200) / final_error(integrator, 400)) - 2.), 0.03);

    // What it takes: D of (I9) in closed form, with damping and over some steps.
    {
      const Oscillator o{3., 0.4};
      const double dt = 0.8;
      State s{1., 0.3, -o.k};
      WorstError dissipation;
      for (unsigned int n = 0; n < 20; ++n) {
        const State next = advance(integrator, o, dt, s);
        const double du = next.u - s.u, dv = next.v - s.v, da = next.a - s.a,
                     dF = force(o, next) - force(o, s), mean_F = 0.5 * (force(o, next) + force(o, s)),
                     mean_v = 0.5 * (next.v + s.v), mean_a = 0.5 * (next.a + s.a);
        const double taken = (0.5 - integrator.alpha_f()) * du * dF +
                             (1. - integrator.alpha_m() - integrator.gamma()) * du * da +
                             dt * dt * (integrator.beta() - 0.5 * integrator.gamma()) * da *
                                 (mean_a + (integrator.gamma() - 0.5) * da);
        dissipation.add(std::abs(taken + mean_v * dv + mean_F * du));
        s = next;
      }
      check(name + ": dissipation", dissipation.value(), 1e-13);
    }

    // What rates from increments mean: Newmark's relations.
    const double dt = 0.3, u = 0.2, v = -1.1, a = 0.7, increment = 0.05;
    const auto v_rate = integrator.velocity(dt), a_rate = integrator.acceleration(dt);
    const double v_1 = v_rate.increment * increment + v_rate.velocity * v + v_rate.acceleration * a,
                 a_1 = a_rate.increment * increment + a_rate.velocity * v + a_rate.acceleration * a;
    const double u_1 = u + dt * v + dt * dt * ((0.5 - integrator.beta()) * a + integrator.beta() * a_1);
    check(name + ": displacement", std::abs(u_1 - u - increment), 1e-15);
    check(name + ": velocity",
          std::abs(v_1 - v - dt * ((1. - integrator.gamma()) * a + integrator.gamma() * a_1)), 1e-14);
  }

  // u_n = cos(n φ) with tan(φ/2) = ω Δt/2, and the energy stays.
  {
    const Oscillator o{4., 0.};
    const double dt = 0.7, phase = 2. * std::atan(0.5 * std::sqrt(o.k) * dt);
    State s{1., 0., -o.k};
    WorstError displacement, energy;
    for (unsigned int n = 1; n <= 1000; ++n) {
      s = advance(trapezoidal, o, dt, s);
      displacement.add(std::abs(s.u - std::cos(n * phase)));
      energy.add(std::abs(0.5 * s.v * s.v + 0.5 * o.k * s.u * s.u - 0.5 * o.k));
    }
    check("average acceleration: period", displacement.value(), 1e-11);
    check("average acceleration: energy", energy.value(), 1e-12);
  }

  // (I4): a mass hits a spring that only presses, is thrown back, and never has more energy than before; what
  // it loses is ½ k (Δg)², less what it leaves over, and (β/γ − ½) Δt² F_c²/m.
  for (const auto &integrator :
       {trapezoidal, hilber_hughes_taylor(-0.2), generalised_alpha(0.8), generalised_alpha(0.)})
    for (const double k : {1., 1e3, 1e6}) {
      const double dt = 0.1;
      double u = 0.25, v = -1., a = 0., c_n = 0.;
      WorstError balance, gain;
      for (unsigned int n = 0; n < 200; ++n) {
        const auto weights = integrator.acceleration(dt), rates = integrator.velocity(dt);
        // inertia_now a* + inertia_before a − contact F_c = 0, where nothing but the spring acts; a stays 0.
        const double m = integrator.mass_factor(dt),
                     rest = integrator.inertia_now() * (weights.velocity * v + weights.acceleration * a) +
                            integrator.inertia_before() * a;
        double du = -rest / m; // without the spring
        if (u + du < 0.)
          du = (-rest - integrator.contact() * k * u) / (m + integrator.contact() * k);
        const double next = u + du, c = std::max(0., -k * next);
        const double v_next = rates.increment * du + rates.velocity * v + rates.acceleration * a;
        const double star = weights.increment * du + weights.velocity * v + weights.acceleration * a;
        a = star - c / integrator.gamma();
        balance.add(std::abs(a));
        const auto stored = [k](const double g) { return g < 0. ? 0.5 * k * g * g : 0.; };
        const double lost = 0.5 * (v * v - v_next * v_next) + stored(u) - stored(next);
        const double taken = -c * du - stored(next) + stored(u) +
                             (integrator.beta() / integrator.gamma() - 0.5) * dt * dt * c * c;
        balance.add(std::abs(lost - taken));
        gain.add(std::max(0., -lost));
        u = next;
        v = v_next;
        c_n = c;
      }
      std::ostringstream name;
      name << "(I4), gamma " << integrator.gamma() << ", k " << k;
      check(name.str() + ": loss", balance.value(), 1e-9);
      check(name.str() + ": no gain", gain.value(), 1e-12);
      check(name.str() + ": thrown back, and free", u > 0. && v >= 0. && c_n == 0.);
    }

  // Of a step from the exact state, u = cos t.
  for (const double beta : {0.25, 0.36}) {
    const auto integrator = newmark(beta, 2. * std::sqrt(beta) - 0.5);
    const double t = 1., dt = 1e-3;
    const State s{std::cos(t), -std::sin(t), -std::cos(t)};
    const State next = advance(integrator, {1., 0.}, dt, s);
    const double error = next.u - std::cos(t + dt);
    check("error of a step with beta = " + std::to_string(beta),
          std::abs(integrator.error_factor() * dt * dt * (next.a - s.a) / error - 1.), 0.01);
  }
}

} // namespace time_integrator_test
