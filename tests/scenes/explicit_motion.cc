// SPDX-License-Identifier: LGPL-2.1-or-later
// Motion without contact, or with a tool that has a mass, against closed forms: flight, fall, springs,
// dashpots, pressure, prescribed displacements; momentum and energy.
#include "explicit_run.h"

#include "../loads/make_load.h"

#include <deal.II/base/mpi.h>

namespace explicit_motion_test {

using namespace billet;
using billet::testing::check;
using billet::testing::ExplicitRun;
using dealii::Tensor;

namespace {

constexpr double mass = 8000 * 0.2 * 0.02 * 0.02;

/// The bar of elastic_bar.prm alone, at rest, for `end` µs.
parameters::Scene bar_alone(const double end) {
  parameters::Scene scene = testing::read_test_scene("elastic_bar.prm");
  scene.bodies[0].mesh.arguments = "10, 2, 2 : 0, 0, 0 : 0.2, 0.02, 0.02 : true";
  scene.bodies[0].initial_velocity.value = {"0", "0", "0"};
  scene.pairs.clear();
  scene.tools.clear();
  scene.time_stepping.end_time = end * 1e-6;
  return scene;
}

/// Puts a load of these lines on the bar.
void add_load(parameters::Scene &scene, const std::string &type, const std::string &lines) {
  scene.bodies[0].loads.push_back(testing::make_load(type, lines));
}

/// Mean displacement along an axis.
double mean_displacement(const ExplicitRun &run, const unsigned int axis) {
  return testing::mean_of_body(run, run.state().displacements, 0)[axis];
}

void test_flight() {
  // Turns about its middle while it flies, stretched by its own inertia.
  parameters::Scene scene = bar_alone(400.);
  scene.bodies[0].initial_velocity.value = {"-3000*(y-0.01)", "3000*(x-0.1)", "20"};
  ExplicitRun run(scene);
  Tensor<1, 3> p_0, L_0;
  testing::WorstError momentum, angular;
  run.finish(20e-6, [&] {
    if (run.state().time == 0.) {
      p_0 = run.state().momentum;
      L_0 = run.state().angular_momentum;
    }
    momentum.add((run.state().momentum - p_0).norm() / p_0.norm());
    angular.add((run.state().angular_momentum - L_0).norm() / L_0.norm());
  });
  check("flight: momentum", momentum.value(), 1e-12);
  check("flight: angular momentum", angular.value(), 1e-12);
  check("flight: energy", run.worst_drift, 1e-4);
}

void test_fall() {
  parameters::Scene scene = bar_alone(100.);
  add_load(scene, "acceleration", "set Acceleration = 0 ; 0 ; -1e6");
  ExplicitRun run(scene);
  run.finish(100e-6, [] {});
  // Central differences are exact at a constant acceleration but for steps that vary.
  check("fall: way", std::abs(mean_displacement(run, 2) / (-0.5 * 1e6 * 1e-8) - 1.), 1e-10);
  check("fall: work", std::abs(run.state().energies.external / (0.5 * mass * 1e4) - 1.), 0.01);
  check("fall: energy", run.worst_drift, 1e-10);
}

void test_mass_scaling() {
  // The fall again, with four times the mass and the same weight.
  parameters::Scene scene = bar_alone(100.);
  add_load(scene, "acceleration", "set Acceleration = 0 ; 0 ; -1e6");
  ExplicitRun plain(scene);
  plain.problem.prepare_step(1.); // one step of 0.75 times the bound, but for what divides the second
  scene.explicit_dynamics.scaled_step = 2. * plain.problem.step_length();
  ExplicitRun run(scene);
  const double factor = run.problem.added_mass() / mass + 1.;
  check("mass scaling: factor", std::abs(factor / 4. - 1.), 1e-4);
  check("mass scaling: the bodies' mass", std::abs(run.problem.mass() / mass - 1.), 1e-12);
  run.problem.prepare_step(1.);
  check("mass scaling: step", std::abs(run.problem.step_length() / scene.explicit_dynamics.scaled_step - 1.),
        1e-4);
  ExplicitRun fall(scene);
  fall.finish(100e-6, [] {});
  check("mass scaling: gravity is what it was",
        std::abs(fall.state().momentum[2] / (-1e6 * mass * 1e-4) - 1.), 1e-10);
  check("mass scaling: way", std::abs(mean_displacement(fall, 2) / (-0.5 * 1e6 / factor * 1e-8) - 1.), 1e-10);
  check("mass scaling: energy", fall.worst_drift, 1e-10);
}

void test_spring() {
  // On one end face, soft against the bar: the bar as a point, at a quarter of its period.
  const double k = 4e7, omega = std::sqrt(k * 4e-4 / mass), quarter = 0.5 * dealii::numbers::PI / omega;
  parameters::Scene scene = bar_alone(1e6 * quarter);
  scene.bodies[0].initial_velocity.value = {"1", "0", "0"};
  add_load(scene, "spring", "set Boundary ids = 0\nset Direction = normal\nset Stiffness = 4e7");
  ExplicitRun run(scene);
  run.finish(quarter, [] {});
  check("spring: amplitude", std::abs(mean_displacement(run, 0) * omega - 1.), 1e-3);
  check("spring: at rest there", std::abs(run.state().momentum[0] / mass), 1e-2);
}

void test_dashpot() {
  const double c = 5e5, rate = c * 4e-4 / mass; // slow: the bar's ends hardly lag behind
  parameters::Scene scene = bar_alone(1e6 / rate);
  scene.bodies[0].initial_velocity.value = {"0", "0", "1"};
  add_load(scene, "dashpot", "set Boundary ids = 0, 1\nset Damping = 2.5e5"); // at both ends half of it
  ExplicitRun run(scene);
  run.finish(1. / rate, [] {});
  check("dashpot: decay", std::abs(run.state().momentum[2] / mass * std::exp(1.) - 1.), 1e-3);
  check("dashpot: energy", run.worst_drift, 1e-3);
}

void test_pressure() {
  // A closed surface feels no resultant, however it is deformed; the bar shrinks by p (1 - 2 ν)/E, with ν =
  // 0.
  parameters::Scene scene = bar_alone(2000.);
  add_load(scene, "pressure", "set Boundary ids = 0, 1, 2, 3, 4, 5\nset Pressure = 2e8*min(1, t/1e-3)");
  ExplicitRun run(scene);
  testing::WorstError momentum;
  double change = 0.;
  run.finish(50e-6, [&] {
    momentum.add(run.state().momentum.norm() / (2e8 * 4e-4 * 1e-3));
    if (run.state().time < 1.5e-3) // the mean of ringing that is left
      return;
    double minimum = 0., maximum = 0.;
    for (const auto &element : run.discretization.elements(0))
      for (unsigned int a = 0; a < n_element_nodes; ++a) {
        const double u = run.state().displacements(element.dofs[std::size_t{3} * a]);
        minimum = std::min(minimum, u);
        maximum = std::max(maximum, u);
      }
    change += (maximum - minimum) / 11.;
  });
  check("pressure: no resultant", momentum.value(), 1e-12);
  check("pressure: strain", std::abs(change / 0.2 / 1e-3 - 1.), 0.01);
  check("pressure: energy", run.worst_drift, 1e-3);
}

void test_supports() {
  // One end held, the other drawn slowly: tension E A u/L.
  parameters::Scene scene = bar_alone(4000.);
  scene.bodies[0].supports.resize(2);
  scene.bodies[0].supports[0].boundary_ids.value = {0};
  scene.bodies[0].supports[1].boundary_ids.value = {1};
  for (auto &support : scene.bodies[0].supports) {
    support.components = {{true, false, false}};
    support.displacement.value = {"0", "0", "0"};
  }
  scene.bodies[0].supports[1].displacement.value[0] = "1e-4*(t/4e-3)^2*(3-2*t/4e-3)";
  ExplicitRun run(scene);
  run.finish(100e-6, [] {});
  const double work = 0.5 * 2e11 * 4e-4 / 0.2 * 1e-8;
  check("supports: work", std::abs(run.state().energies.external / work - 1.), 0.01);
  check("supports: elastic energy", std::abs(run.state().energies.elastic / work - 1.), 0.01);
  check("supports: energy", run.worst_drift, 1e-3);
}

void test_sector() {
  // A sixth of a thin ring between oblique planes breathes at sqrt(E/ρ)/r.
  parameters::Scene scene = bar_alone(1.);
  auto &mesh = scene.bodies[0].mesh;
  mesh.arguments = "2, 12, 2 : 0.99, 0, 0 : 1.01, 1.0471975511965976, 0.02 : true";
  mesh.positions.value = {"x*cos(y)", "x*sin(y)", "z"};
  parameters::SymmetryPlane below, above;
  below.normal[1] = 1.;
  below.offset = above.offset = 0.;
  above.normal[0] = -std::sin(dealii::numbers::PI / 3.);
  above.normal[1] = std::cos(dealii::numbers::PI / 3.);
  scene.bodies[0].symmetry_planes.value = {below, above};
  scene.bodies[0].initial_velocity.value = {"x/sqrt(x^2+y^2)", "y/sqrt(x^2+y^2)", "0"};
  const double omega = 5000., quarter = 0.5 * dealii::numbers::PI / omega;
  scene.time_stepping.end_time = quarter;
  ExplicitRun run(scene);
  run.finish(quarter, [] {});
  testing::WorstError radial;
  for (const auto &element : run.discretization.elements(0))
    for (unsigned int a = 0; a < n_element_nodes; ++a) {
      const auto X = element.cell->vertex(a);
      const double angle = std::atan2(X[1], X[0]);
      const double u = run.state().displacements(element.dofs[std::size_t{3} * a]) * std::cos(angle) +
                       run.state().displacements(element.dofs[3 * a + 1]) * std::sin(angle);
      radial.add(std::abs(u * omega - 1.));
    }
  check("sector: amplitude, everywhere", radial.value(), 0.02);
  check("sector: energy", run.worst_drift, 1e-4);
}

void test_removal() {
  // A tool that is driven against the bar's end, which is held at the other one, and taken away; with and
  // without a time in which its force fades; with its own motion, with a mass, and stopped at a force.
  for (const double release : {0., 20e-6})
    for (const auto control : {parameters::Motion::Control::motion, parameters::Motion::Control::force,
                               parameters::Motion::Control::stop}) {
      parameters::Scene scene = testing::read_test_scene("elastic_bar.prm");
      scene.bodies[0].initial_velocity.value = {"0", "0", "0"};
      scene.bodies[0].mesh.arguments = "20, 2, 2 : 0, 0, 0 : 0.2, 0.02, 0.02 : true";
      scene.bodies[0].supports.resize(1);
      scene.bodies[0].supports[0].boundary_ids.value = {1};
      scene.bodies[0].supports[0].components = {{true, false, false}};
      scene.bodies[0].supports[0].displacement.value = {"0", "0", "0"};
      auto &motion = scene.tools[0].motion;
      motion.control = control;
      motion.direction[0] = 1.;
      motion.load.value = control == parameters::Motion::Control::force ? "4e5" : "1.2e6";
      motion.inertia = 0.1 * mass;
      motion.removal_time.value = 120e-6;
      motion.release_time = release;
      if (control != parameters::Motion::Control::force)
        motion.translation.value[0] = "50*t";
      ExplicitRun run(scene);
      double travel = 0., force = 0.;
      run.finish(1e-6, [&] {
        if (run.state().time < 120e-6) {
          travel = run.state().placements[0].translation[0];
          force = std::max(force, run.state().tool_loads[0].force[0]);
        }
      });
      const std::string name = "removal, control " + std::to_string(static_cast<int>(control)) +
                               (release > 0. ? ", released" : "");
      check(name + ": energy", run.worst_drift, 5e-3);
      check(name + ": it pressed", force > 3e5);
      // The fading force ends by round-off.
      check(name + ": touches no more", run.state().tool_loads[0].force.norm(), 1e-12 * force);
      if (control == parameters::Motion::Control::force)
        check(name + ": stays where it was", std::abs(run.state().placements[0].translation[0] / travel - 1.),
              0.05);
      if (control == parameters::Motion::Control::stop)
        check(name + ": stopped", travel < 0.8 * 50. * 119e-6);
    }
}

void test_free_tool() {
  // A wall with the bar's mass flies at it at 100 m/s, driven by nothing: they exchange momentum.
  parameters::Scene scene = testing::read_test_scene("elastic_bar.prm");
  scene.bodies[0].initial_velocity.value = {"0", "0", "0"};
  auto &motion = scene.tools[0].motion;
  motion.control = parameters::Motion::Control::force;
  motion.load.value = "0";
  motion.direction[0] = 1.;
  motion.inertia = mass;
  motion.initial_rate = 100.;
  ExplicitRun run(scene);
  testing::WorstError momentum;
  run.finish(1e-6, [&] { momentum.add(std::abs(run.state().momentum[0] / (100. * mass) - 1.)); });
  check("free tool: momentum", momentum.value(), 1e-12);
  check("free tool: energy", run.worst_drift, 2e-3);
  // From 20 to 100 µs, two passages of the wave, the bar's ρ c v A slows it as exp(−c t/L); then it flies on.
  const double left = std::exp(-2.), way = 100. * (20e-6 + 40e-6 * (1. - left) + 40e-6 * left);
  check("free tool: way", std::abs(run.state().placements[0].translation[0] / way - 1.), 0.02);

  // Driven by a force, it touches nothing for a while.
  motion.load.value = "1000";
  motion.initial_rate = 0.;
  scene.time_stepping.end_time = 100e-6;
  ExplicitRun driven(scene);
  driven.finish(100e-6, [] {});
  check("driven tool: way",
        std::abs(driven.state().placements[0].translation[0] / (0.5 * 1000. / mass * 1e-8) - 1.), 1e-10);
  check("driven tool: work", driven.worst_drift, 1e-10);

  // The same with a moment about its axis, far from the bar.
  motion.control = parameters::Motion::Control::moment;
  motion.load.value = "-3";
  motion.inertia = 2e-3;
  motion.initial_rate = 1.;
  ExplicitRun turned(scene);
  turned.finish(100e-6, [] {});
  check("turned tool: angle",
        std::abs(turned.state().placements[0].rotation_angle / (1e-4 - 0.5 * 3. / 2e-3 * 1e-8) - 1.), 1e-10);
  check("turned tool: work", turned.worst_drift, 1e-10);
}

} // namespace

BILLET_MPI_TEST(explicit_motion) {
  test_flight();
  test_fall();
  test_mass_scaling();
  test_spring();
  test_dashpot();
  test_pressure();
  test_supports();
  test_sector();
  test_removal();
  test_free_tool();
}

} // namespace explicit_motion_test
