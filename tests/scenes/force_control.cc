// SPDX-License-Identifier: LGPL-2.1-or-later
// Tools whose travel is unknown. A billet that is pressed with the forces which a run with given travel has
// met ends each step at that travel; a die that stops at a force stops where the run had that force; a platen
// that a moment turns ends at the angle of a run with given angle; after the die is taken away a frictionless
// billet springs back to the plastic strain of the closed form, and no force is left.
#include "materials.h"
#include "scene_run.h"

#include <deal.II/base/mpi.h>

namespace force_control_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

constexpr unsigned int n_steps = 15;

struct Curve {
  std::vector<double> times{0.}, travels{0.}, forces{0.}, angles{0.}, moments{0.};
};

Curve record(SceneRun &run) {
  Curve curve;
  const auto axis = run.scene.tools()[0].rotation_axis();
  run.finish([&](const NewtonReport &) {
    const Placement &placement = run.problem.state().placements[0];
    curve.times.push_back(run.control.time());
    curve.travels.push_back(placement.translation[2]);
    curve.forces.push_back(run.load().force[2]);
    curve.angles.push_back(placement.rotation_angle);
    curve.moments.push_back(run.load().moment * axis);
  });
  return curve;
}

parameters::Amplitude make_amplitude(const std::string &name, const std::vector<double> &times,
                                     const std::vector<double> &values) {
  parameters::Amplitude amplitude;
  amplitude.name = name;
  amplitude.times = times;
  amplitude.values = values;
  amplitude.interpolation = parameters::Amplitude::Interpolation::linear;
  return amplitude;
}

double max_difference(const std::vector<double> &a, const std::vector<double> &b) {
  if (a.size() != b.size())
    return 1.;
  testing::WorstError error;
  double size = 0.;
  for (std::size_t i = 0; i < a.size(); ++i) {
    error.add(std::abs(a[i] - b[i]));
    size = std::max(size, std::abs(b[i]));
  }
  return error.value() / size;
}

void press(const std::string &name, const parameters::Scene &given) {
  SceneRun run(given);
  const Curve curve = record(run);
  parameters::Scene pressed = given;
  pressed.amplitudes.push_back(make_amplitude("press", curve.times, curve.forces));
  auto &motion = pressed.tools[0].motion;
  motion.translation.value = {"0", "0", "0"};
  motion.control = parameters::Motion::Control::force;
  motion.direction = dealii::Tensor<1, 3>({0., 0., -1.});
  motion.load.value = "-press";
  SceneRun again(pressed);
  const Curve result = record(again);
  check(name + ": the same travel", max_difference(result.travels, curve.travels), 1e-6);
  check(name + ": the forces asked for", max_difference(result.forces, curve.forces), 1e-6);
  check(name + ": about as many iterations", again.n_iterations < 2 * run.n_iterations);

  // A die that the same travel would take further, but that stops at the force of the 9th step.
  parameters::Scene stopping = given;
  stopping.tools[0].motion.control = parameters::Motion::Control::stop;
  stopping.tools[0].motion.direction = dealii::Tensor<1, 3>({0., 0., -1.});
  stopping.tools[0].motion.load.value = dealii::Utilities::to_string(-curve.forces[9]);
  SceneRun stopped(stopping);
  const Curve halted = record(stopped);
  check(name + ": stops at its force", std::abs(halted.forces[9] / curve.forces[9] - 1.), 1e-6);
  check(name + ": ... where the run had it", std::abs(halted.travels[9] / curve.travels[9] - 1.), 1e-6);
  check(name + ": ... for good", halted.travels.back() == halted.travels[9]);
}

} // namespace

BILLET_MPI_TEST(force_control) {
  if (!testing::is_first_rank())
    std::cout.setstate(std::ios::failbit); // one rank speaks
  parameters::Scene billet = testing::read_shipped_scene("billet_upsetting.prm");
  testing::set_fixed_steps(billet, n_steps);
  billet.time_stepping.end_time = 0.6;
  billet.time_stepping.initial_step = 0.6 / n_steps;
  billet.solver.force_tolerance = 1e-9;
  press("rough billet", billet);

  parameters::Scene smooth = billet;
  smooth.pairs[0].friction = nullptr;
  if (testing::n_ranks() == 1)
    press("smooth billet", smooth);

  // A block, stuck to a plane that a moment turns under it.
  parameters::Scene block = parameters::Scene::read(std::string(SOURCE_DIR) + "/block_on_plane.prm");
  block.bodies[0].supports[0].displacement.value = {"0", "0", "-0.01"};
  block.tools[0].motion.centre = dealii::Tensor<1, 3>({0.5, 0.5, 0.});
  block.tools[0].motion.translation.value = {"0", "0", "0"};
  block.tools[0].motion.rotation_angle.value = "0.002*t";
  block.time_stepping.initial_step = 0.1;
  block.pairs[0].initial.allowed_penetration.value = 1.;
  SceneRun turned(block);
  const Curve twist = record(turned);
  parameters::Scene twisted = block;
  twisted.amplitudes.push_back(make_amplitude("twist", twist.times, twist.moments));
  twisted.tools[0].motion.rotation_angle.value = "0";
  twisted.tools[0].motion.control = parameters::Motion::Control::moment;
  twisted.tools[0].motion.load.value = "twist";
  SceneRun follows(twisted);
  const Curve angles = record(follows);
  check("there is a moment", std::abs(twist.moments.back()) > 1e-3);
  check("a moment turns the plane by the same angle", max_difference(angles.angles, twist.angles), 1e-6);

  if (testing::n_ranks() > 1)
    return; // the same unknowns

  // A holder that has some way to go before it touches.
  parameters::Scene apart = smooth;
  apart.tools[0].surface =
      testing::make_plane(dealii::Tensor<1, 3>({0., 0., 16.}), dealii::Tensor<1, 3>({0., 0., -1.}));
  apart.tools[0].motion.translation.value = {"0", "0", "0"};
  apart.tools[0].motion.control = parameters::Motion::Control::force;
  apart.tools[0].motion.direction = dealii::Tensor<1, 3>({0., 0., -1.});
  apart.tools[0].motion.load.value = "1e4*t";
  SceneRun closing(apart);
  closing.finish();
  check("a tool apart goes until it touches, and presses", std::abs(closing.load().force[2] / -6e3 - 1.),
        1e-6);
  check("... an elastic billet", closing.problem.state().placements[0].translation[2] < -1.);

  // A block between a plane and a platen that presses, and lets go: nothing but friction and the platen holds
  // it.
  parameters::Scene held = parameters::Scene::read(std::string(SOURCE_DIR) + "/block_on_plane.prm");
  held.amplitudes.push_back(make_amplitude("load", {0., 1., 2.}, {0., 1., 0.}));
  held.bodies[0].supports.clear();
  testing::set_hardening(held.bodies[0].material,
                         LinearHardening{1e6, testing::linear_hardening(held.bodies[0].material).modulus});
  held.tools[0].motion.translation.value = {"0", "0", "0"};
  held.tools[0].motion.rotation_angle.value = "0";
  held.tools.push_back(held.tools[0]);
  held.tools[1].name = "platen";
  held.tools[1].surface =
      testing::make_plane(dealii::Tensor<1, 3>({0., 0., 1.}), dealii::Tensor<1, 3>({0., 0., -1.}));
  held.tools[1].motion.control = parameters::Motion::Control::force;
  held.tools[1].motion.direction = dealii::Tensor<1, 3>({0., 0., -1.});
  held.tools[1].motion.load.value = "20*load";
  held.pairs.push_back(held.pairs[0]);
  held.pairs[1].boundary_ids.value = {5};
  held.pairs[1].tool.value = "platen";
  held.time_stepping.control = parameters::TimeStepping::Control::automatic;
  held.time_stepping.end_time = 5.;
  held.solver.force_tolerance = 1e-6;
  SceneRun let_go(held);
  double pressed_by = 0.;
  unsigned int n_late = 0;
  let_go.finish([&](const NewtonReport &report) {
    pressed_by = std::max(pressed_by, let_go.load().force[2]);
    n_late += let_go.control.time() > 2.2 ? static_cast<unsigned int>(report.iterations.size()) : 0;
  });
  check("a block that is let go: it was pressed", pressed_by > 15.);
  check("... is at rest", let_go.load().force.norm() + let_go.load(1).force.norm(), 1e-6);
  check("... without iterations", n_late == 0 && let_go.control.n_cuts() < 5);

  // Springback.
  for (const double release : {0., 0.2}) {
    parameters::Scene sprung = smooth;
    sprung.time_stepping.end_time = 1.;
    sprung.tools[0].motion.removal_time.value = 0.6;
    sprung.tools[0].motion.release_time = release;
    sprung.solver.force_tolerance = 1e-10;
    SceneRun back(sprung);
    double strain_before = 0., strain_after = 0., force_before = 0., elastic_before = 0., drift_before = 0.;
    const EnergyLedger &energies = back.problem.state().energies;
    back.finish([&](const NewtonReport &) {
      strain_after = back.problem.equation()
                         .parts()
                         .internal()
                         .summarize(0, back.problem.state().displacements)
                         .front()
                         .equivalent_plastic_strain;
      if (back.control.time() < 0.6 - 1e-9) {
        force_before = back.load().force.norm();
        elastic_before = energies.elastic;
      } else if (back.control.time() < 0.6 + 1e-9) {
        strain_before = strain_after;
        drift_before = energies.drift();
      }
    });
    const std::string name = release > 0. ? "springback, faded" : "springback, at once";
    check(name + ": there was a force", force_before > 1e5);
    check(name + ": there is none", back.load().force.norm() == 0.);
    check(name + ": unloading is elastic", strain_after == strain_before);
    check(name + ": no elastic energy is left", energies.elastic / elastic_before, 1e-12);
    if (release > 0.)
      check(name + ": the bodies give it to what fades",
            std::abs(energies.drift() - drift_before) / elastic_before, 0.02);
  }
}

} // namespace force_control_test
