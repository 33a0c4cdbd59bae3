// SPDX-License-Identifier: LGPL-2.1-or-later
// Free vibration of a bar of linear elements, against closed forms in space and time: its modes are sin(k x)
// at the nodes, with ω² = 6 (1 − cos k)/(2 + cos k) of the consistent mass and 2 (1 − cos k) of the lumped
// one.
#include "implicit_run.h"

#include "billet/integration/time_integrator_type.h"

#include <deal.II/base/mpi.h>

#include <sstream>

namespace implicit_vibration_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;
using billet::testing::WorstError;

namespace {

constexpr unsigned int n_elements = 8;
constexpr double velocity_size = 1e-5; // of the velocities: small strains
constexpr double tiny_size = 1e-8;     // where energies are compared, which strains change by their own size

double wave_number(const unsigned int mode) { return (mode - 0.5) * M_PI / n_elements; }

double frequency(const unsigned int mode, const bool is_lumped = false) {
  const double c = std::cos(wave_number(mode));
  return std::sqrt(is_lumped ? 2. * (1. - c) : 6. * (1. - c) / (2. + c));
}

/// The part of a mode in a nodal field.
double project(const SceneRun &run, const Vector &field, const unsigned int mode) {
  double sum = 0.;
  for (const auto &[x, value] : testing::along_x(run, field))
    sum += value * std::sin(wave_number(mode) * x) * (x == n_elements ? 1. : 2.) / n_elements;
  return sum;
}

parameters::Scene make_scene(const std::vector<unsigned int> &modes, const double step,
                             const double size = velocity_size) {
  parameters::Scene scene = testing::read_test_scene("implicit_bar.prm");
  std::ostringstream velocity;
  velocity.precision(17);
  velocity << "0";
  for (const unsigned int mode : modes)
    velocity << " + " << size << "*sin(" << wave_number(mode) << "*x)";
  scene.bodies[0].initial_velocity.value[0] = velocity.str();
  scene.time_stepping.initial_step = step;
  return scene;
}

/// Error in displacement and velocity of the first mode at the end, over their amplitudes.
double final_error(parameters::Scene scene, const double step, const bool is_lumped) {
  scene.time_stepping.initial_step = step;
  if (is_lumped)
    scene.implicit_dynamics.mass = parameters::ImplicitDynamics::Mass::lumped;
  SceneRun run(scene);
  run.finish();
  const double omega = frequency(1, is_lumped), t = run.control.time();
  return std::hypot(project(run, run.problem.state().displacements, 1) * omega / velocity_size -
                        std::sin(omega * t),
                    project(run, run.problem.state().velocities, 1) / velocity_size - std::cos(omega * t));
}

/// A single degree of freedom through the same integrator.
class Oscillator {
public:
  Oscillator(const TimeIntegrator &integrator, const double omega, const double step)
      : integrator_(integrator), k_(omega * omega), step_(step) {}
  double advance() {
    const auto v = integrator_.velocity(step_), a = integrator_.acceleration(step_);
    const double v_still = v.velocity * v_ + v.acceleration * a_,
                 a_still = a.velocity * v_ + a.acceleration * a_;
    const double residual = k_ * u_ * (1. + integrator_.forces_before()) +
                            integrator_.inertia_now() * a_still + integrator_.inertia_before() * a_;
    const double increment = -residual / (k_ + integrator_.mass_factor(step_));
    u_ += increment;
    v_ = v_still + v.increment * increment;
    a_ = a_still + a.increment * increment;
    return u_;
  }

private:
  TimeIntegrator integrator_;
  double k_, step_, u_ = 0., v_ = 1., a_ = 0.;
};

} // namespace

BILLET_MPI_TEST(implicit_vibration) {

  for (const bool is_lumped : {false, true})
    for (const std::string method : {"Newmark", "HHT", "generalised"}) {
      if (is_lumped && method != "Newmark")
        continue;
      parameters::Scene scene = make_scene({1}, 1.);
      if (method == "Newmark")
        testing::set_newmark(scene);
      else if (method == "HHT")
        testing::set_hht(scene, -0.1);
      else
        testing::set_generalised(scene, 0.5);
      const double coarse = final_error(scene, 0.5, is_lumped), fine = final_error(scene, 0.25, is_lumped);
      std::cout << method << (is_lumped ? ", lumped" : ", consistent") << " mass: ";
      check("error", coarse, 0.05);
      check("  falls with the square of the step", std::abs(std::log2(coarse / fine) - 2.), 0.05);
    }

  {
    parameters::Scene scene = make_scene({1, 4, 8}, 0.7, tiny_size);
    testing::set_newmark(scene);
    SceneRun run(scene);
    WorstError change, drift, numerical;
    const double initial = run.problem.state().energies.initial;
    run.finish([&](const NewtonReport &) {
      const EnergyLedger &energies = run.problem.state().energies;
      change.add(std::abs((energies.kinetic + energies.elastic) / initial - 1.));
      drift.add(std::abs(energies.drift()) / initial);
      numerical.add(std::abs(energies.numerical) / initial);
    });
    check("average acceleration keeps the energy", change.value(), 1e-7);
    check("... and takes nothing", numerical.value(), 1e-7);
    check("... the ledger balances", drift.value(), 1e-7);
  }

  // With steps that are 17 times the shortest period, the highest mode goes as the integrator says, the
  // lowest one stays.
  for (const bool is_hht : {true, false}) {
    const double step = 30., fine_step = 0.2;
    for (const double dt : {step, fine_step}) {
      parameters::Scene scene = make_scene({1, n_elements}, dt);
      scene.time_stepping.end_time = 20. * dt;
      if (is_hht)
        testing::set_hht(scene, -1. / 3.);
      else
        testing::set_generalised(scene, 0.6);
      const TimeIntegrator integrator = is_hht ? hilber_hughes_taylor(-1. / 3.) : generalised_alpha(0.6);
      Oscillator lowest(integrator, frequency(1), dt), highest(integrator, frequency(n_elements), dt);
      SceneRun run(scene);
      WorstError low, high, drift;
      run.finish([&](const NewtonReport &) {
        const Vector &u = run.problem.state().displacements;
        low.add(std::abs(project(run, u, 1) / velocity_size - lowest.advance()) * frequency(1));
        high.add(std::abs(project(run, u, n_elements) / velocity_size - highest.advance()) *
                 frequency(n_elements));
        drift.add(std::abs(run.problem.state().energies.drift()) / run.problem.state().energies.initial);
      });
      std::cout << (is_hht ? "HHT" : "generalised") << (dt == step ? ", long steps: " : ", short steps: ");
      check("lowest mode", low.value(), 1e-4);
      check("  highest mode", high.value(), 1e-4);
      check("  the ledger balances", drift.value(), 1e-4);
      check("  dissipation", run.problem.state().energies.numerical > 0.);
    }
  }
  {
    parameters::Scene scene = make_scene({1, n_elements}, 2.);
    scene.time_stepping.end_time = 128.;
    testing::set_generalised(scene, 0.6);
    SceneRun run(scene);
    double low = 0., high = 0.; // amplitudes over the last period of the lowest mode
    run.finish([&](const NewtonReport &) {
      if (run.control.time() < 128. - 2. * M_PI / frequency(1))
        return;
      low = std::max(low, std::abs(project(run, run.problem.state().velocities, 1)) / velocity_size);
      high =
          std::max(high, std::abs(project(run, run.problem.state().velocities, n_elements)) / velocity_size);
    });
    check("the lowest mode stays", 1. - low, 0.05);
    check("the highest goes", high, 1e-3);
  }
}

} // namespace implicit_vibration_test
