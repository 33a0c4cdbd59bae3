// SPDX-License-Identifier: LGPL-2.1-or-later
// Implicit dynamics: heavy tools, supports that move, tools that are taken away, a load that comes at once,
// steps that accuracy chooses, steps that fail.
#include "implicit_run.h"

#include "../loads/make_load.h"

#include <deal.II/base/mpi.h>

#include <cstdlib>

namespace implicit_motion_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;
using billet::testing::WorstError;

namespace {

using dealii::Tensor;

bool shows() { return std::getenv("SHOW") != nullptr; }

parameters::Tool make_tool(const Tensor<1, 3> &point, const Tensor<1, 3> &normal) {
  parameters::Tool tool{};
  tool.name = "tool";
  tool.surface = testing::make_plane(point, normal);
  tool.motion.translation.value = {"0", "0", "0"};
  tool.motion.rotation_angle.value = "0";
  tool.motion.rotation_axis = Tensor<1, 3>({0., 0., 1.});
  tool.motion.removal_time.value = std::numeric_limits<double>::infinity();
  return tool;
}

/// The bar of implicit_bar.prm with a plane before its free end, that may press along −x.
parameters::Scene bar_with_tool() {
  parameters::Scene scene = testing::read_test_scene("implicit_bar.prm");
  scene.tools.push_back(make_tool(Tensor<1, 3>({8., 0., 0.}), Tensor<1, 3>({-1., 0., 0.})));
  parameters::ContactPair pair = testing::read_test_scene("implicit_sliding.prm").pairs[0];
  pair.body.value = "bar";
  pair.tool.value = "tool";
  pair.boundary_ids.value = {1};
  pair.friction = nullptr;
  pair.penalty.normal = 1.;
  scene.pairs.push_back(pair);
  return scene;
}

void check_heavy_tools() {
  // A tool flies into the free end of a free bar, and a force drives it: together they get its impulse.
  parameters::Scene scene = bar_with_tool();
  scene.bodies[0].supports.clear();
  auto &motion = scene.tools[0].motion;
  motion.control = parameters::Motion::Control::force;
  motion.load.value = "1e-3";
  motion.direction = Tensor<1, 3>({-1., 0., 0.});
  motion.inertia = 4.;
  motion.initial_rate = 0.01;
  // Another one turns, and touches nothing.
  scene.tools.push_back(make_tool({}, Tensor<1, 3>({0., 0., 1.})));
  scene.tools[1].name = "wheel";
  scene.tools[1].motion.control = parameters::Motion::Control::moment;
  scene.tools[1].motion.load.value = "0.3";
  scene.tools[1].motion.inertia = 2.;
  scene.tools[1].motion.initial_rate = -1.;
  scene.time_stepping.end_time = 40.;
  SceneRun run(scene);
  const SolutionState &state = run.problem.state();
  WorstError momentum, energy, turn;
  bool touches = false, lets_go = false;
  run.finish([&](const NewtonReport &) {
    const double t = state.time;
    momentum.add(std::abs(state.momentum[0] + 0.04 + 1e-3 * t));
    energy.add(std::abs(state.energies.drift()) / state.energies.total());
    turn.add(std::abs(state.placements[1].rotation_angle - (-t + 0.5 * 0.15 * t * t)));
    touches = touches || run.load().area > 0.;
    lets_go = lets_go || (touches && run.load().area == 0.);
  });
  if (shows())
    std::cout << momentum.value() << " " << energy.value() << " " << turn.value() << " "
              << state.energies.numerical << " of " << state.energies.total() << std::endl;
  check("heavy tool: momentum of tool and bar is its impulse", momentum.value(), 1e-9);
  check("  touches and lets go", touches && lets_go);
  check("  energy", energy.value(), 2e-3);
  check("  a moment turns an unimpeded tool", turn.value(), 1e-9);
}

/// The free end at 60 times, work of the support, and errors of the held velocity, with the root shaken.
struct Shaken {
  std::vector<double> ends;
  double work = 0., velocity = 0., drift = 0.;
};

Shaken shake(const unsigned int n_steps) {
  parameters::Scene scene = testing::read_test_scene("implicit_bar.prm");
  scene.time_stepping.end_time = 30.;
  scene.bodies[0].supports[0].displacement.value = {"1e-4*sin(pi*t/30)^4", "0", "0"};
  testing::set_fixed_steps(scene, n_steps);
  SceneRun run(scene);
  const SolutionState &state = run.problem.state();
  Shaken shaken;
  WorstError velocity, drift;
  run.finish([&](const NewtonReport &) {
    const double phase = M_PI * state.time / 30.;
    const double held = 4e-4 * M_PI / 30. * std::pow(std::sin(phase), 3) * std::cos(phase);
    velocity.add(std::abs(testing::along_x(run, state.velocities)[0.] - held) / 1e-5);
    drift.add(std::abs(state.energies.drift() / state.energies.total()));
    if (run.control.n_steps() % (n_steps / 60) == 0)
      shaken.ends.push_back(testing::along_x(run, state.displacements)[8.] / 1e-4);
  });
  shaken.work = state.energies.external;
  shaken.velocity = velocity.value();
  shaken.drift = drift.value();
  return shaken;
}

void check_moving_supports() {
  const Shaken coarse = shake(60), fine = shake(120), reference = shake(480);
  const auto error_of = [&](const Shaken &shaken) {
    double error = 0.;
    for (std::size_t i = 0; i < reference.ends.size(); ++i)
      error = std::max(error, std::abs(shaken.ends[i] - reference.ends[i]));
    return error;
  };
  const auto order = [](const double error, const double half_step) { return std::log2(error / half_step); };
  if (shows())
    std::cout << error_of(coarse) << " " << error_of(fine) << ", work " << coarse.work / reference.work - 1.
              << " " << fine.work / reference.work - 1. << ", velocity " << coarse.velocity << " "
              << fine.velocity << ", drift " << fine.drift << std::endl;
  check("shaken bar: error", error_of(fine), 0.02);
  check("  ... of second order", std::abs(order(error_of(coarse), error_of(fine)) - 2.), 0.25);
  check("  ... in the support's work",
        std::abs(order(std::abs(coarse.work - reference.work), std::abs(fine.work - reference.work)) - 2.),
        0.4);
  check("  ... in the held velocity", std::abs(order(coarse.velocity, fine.velocity) - 2.), 0.1);
  check("  energy", fine.drift, 1e-5);
}

void check_removal() {
  // The tool presses slowly, holds, and is gone: the end swings to the other side, in a triangle of period 4
  // L/c.
  parameters::Scene scene = bar_with_tool();
  constexpr double depth = 1e-4, removal = 100.;
  scene.tools[0].motion.translation.value = {"-0.5e-4*(1 - cos(pi*min(t, 80)/80))", "0", "0"};
  scene.tools[0].motion.removal_time.value = removal;
  scene.time_stepping.end_time = removal + 32.;
  scene.time_stepping.initial_step = 0.2;
  testing::set_hht(scene, -0.05);
  SceneRun run(scene);
  const SolutionState &state = run.problem.state();
  double pressed = 0., swung = 0., turned = 0., drift = 0., energy = 0.;
  run.finish([&](const NewtonReport &) {
    const double end = testing::along_x(run, state.displacements)[8.];
    if (state.time < removal + 0.05)
      pressed = end;
    if (std::abs(state.time - removal - 16.) < 0.05)
      swung = end;
    if (std::abs(state.time - removal - 8.) < 0.05)
      turned = end;
    if (std::abs(state.time - removal) < 0.05)
      energy = state.energies.total();
    drift = std::max(drift, std::abs(state.energies.drift()));
  });
  const double change =
      std::abs(state.energies.kinetic + state.energies.elastic + state.energies.numerical) / energy - 1.;
  if (shows())
    std::cout << pressed / depth << " " << turned / depth << " " << swung / depth << " " << drift / energy
              << " " << change << std::endl;
  check("tool taken away: the end was pressed", std::abs(pressed / depth + 1.), 0.15);
  check("  ... passes the middle", std::abs(turned / pressed), 0.1);
  check("  ... swings to the other side", std::abs(swung / pressed + 1.), 0.1);
  check("  ... and the energy stays", std::max(drift / energy, std::abs(change)), 1e-3);
}

void check_pressure() {
  // A pressure that comes at once stretches the bar to twice what it does slowly, at 2 L/c.
  parameters::Scene scene = testing::read_test_scene("implicit_bar.prm");
  scene.bodies[0].loads = {testing::make_load("pressure", "set Boundary ids = 1\nset Pressure = -1e-5")};
  scene.bodies[0].mesh.arguments = "32, 1, 1 : 0, 0, 0 : 8, 1, 1 : true";
  scene.time_stepping.initial_step = 0.1;
  scene.time_stepping.end_time = 16.;
  SceneRun run(scene);
  run.finish();
  const EnergyLedger &energies = run.problem.state().energies;
  check("sudden pull: twice the static stretch",
        std::abs(testing::along_x(run, run.problem.state().displacements)[8.] / (2. * 8e-5) - 1.), 0.015);
  check("  its work", std::abs(energies.external / (2. * 8e-10) - 1.), 0.015);
  check("  energy", std::abs(energies.drift()) / energies.external, 1e-3);

  // A dashpot of the bar's impedance, ρ c, at the end takes the wave that its root sends out, whole.
  scene.bodies[0].loads = {testing::make_load("dashpot", "set Boundary ids = 1\nset Damping = 1")};
  scene.bodies[0].supports[0].displacement.value = {"1e-4*(t < 6 ? 0.5*(1 - cos(2*pi*t/6)) : 0)", "0", "0"};
  scene.time_stepping.end_time = 24.;
  SceneRun quiet(scene);
  double maximum = 0.;
  quiet.finish(
      [&](const NewtonReport &) { maximum = std::max(maximum, quiet.problem.state().energies.total()); });
  if (shows())
    std::cout << quiet.problem.state().energies.total() / maximum << " "
              << quiet.problem.state().energies.numerical / maximum << std::endl;
  check("dashpot: the wave is gone",
        (quiet.problem.state().energies.kinetic + quiet.problem.state().energies.elastic) / maximum, 0.03);
}

/// Largest error of the free end against steps that are much shorter.
double error_of(const double tolerance, unsigned int &n_steps, unsigned int &n_cuts) {
  parameters::Scene scene = testing::read_test_scene("implicit_bar.prm");
  scene.bodies[0].initial_velocity.value[0] = "1e-5*sin(pi/16*x)";
  scene.time_stepping.end_time = 60.;
  scene.time_stepping.control = parameters::TimeStepping::Control::automatic;
  scene.time_stepping.initial_step = 4.;
  scene.time_stepping.min_step = 1e-6;
  scene.time_stepping.max_step = 20.;
  scene.time_stepping.growth_factor = 1.5;
  scene.time_stepping.cut_factor = 0.5;
  scene.time_stepping.shrink_factor = 0.7;
  scene.time_stepping.few_iterations = 5;
  scene.time_stepping.many_iterations = 9;
  scene.implicit_dynamics.error_tolerance = tolerance;
  testing::set_newmark(scene);
  SceneRun run(scene);
  const double c = std::cos(M_PI / 16.), omega = std::sqrt(6. * (1. - c) / (2. + c));
  WorstError error;
  run.finish([&](const NewtonReport &) {
    error.add(std::abs(testing::along_x(run, run.problem.state().displacements)[8.] * omega / 1e-5 -
                       std::sin(omega * run.control.time())));
  });
  n_steps = run.control.n_steps();
  n_cuts = run.control.n_cuts();
  return error.value();
}

void check_accuracy() {
  unsigned int n_coarse = 0, n_fine = 0, n_cuts = 0;
  const double coarse = error_of(1e-3, n_coarse, n_cuts), fine = error_of(1e-3 / 64., n_fine, n_cuts);
  if (shows())
    std::cout << coarse << " in " << n_coarse << ", " << fine << " in " << n_fine << " cuts " << n_cuts
              << std::endl;
  check("automatic steps: error", coarse, 0.1);
  // A local error of third order: steps four times shorter, a global error of second order.
  check("  a tolerance 64 times tighter: steps", std::abs(static_cast<double>(n_fine) / n_coarse / 4. - 1.),
        0.3);
  check("  ... and error", std::abs(coarse / fine / 16. - 1.), 0.5);
  check("  first steps are cut", n_cuts > 0);
}

bool same_bits(const SceneRun &a, const SceneRun &b) {
  const SolutionState &s = a.problem.state(), &t = b.problem.state();
  for (const auto i : a.discretization.owned_dofs())
    if (s.displacements(i) != t.displacements(i) || s.velocities(i) != t.velocities(i))
      return false;
  return a.load().force == b.load().force && s.energies.kinetic == t.energies.kinetic &&
         s.energies.numerical == t.energies.numerical && s.energies.external == t.energies.external &&
         s.energies.friction == t.energies.friction &&
         s.placements[1].translation == t.placements[1].translation;
}

/// With a tolerance the long steps converge, but are not accurate; without it they do not converge.
void check_failed_steps(const bool by_accuracy) {
  parameters::Scene scene = testing::read_test_scene("implicit_sliding.prm");
  scene.time_stepping.end_time = 4e-4;
  scene.bodies[0].initial_velocity.value = {"5", "0", "-20"};
  scene.tools.push_back(make_tool(Tensor<1, 3>({0., 0., 0.009}), Tensor<1, 3>({0., 0., -1.})));
  auto &motion = scene.tools[1].motion;
  motion.control = parameters::Motion::Control::force;
  motion.load.value = "50";
  motion.direction = Tensor<1, 3>({0., 0., -1.});
  motion.inertia = 1e-3;
  parameters::ContactPair pair = scene.pairs[0];
  pair.tool.value = "tool";
  pair.boundary_ids.value = {5};
  scene.pairs.push_back(pair);
  if (by_accuracy) {
    scene.implicit_dynamics.error_tolerance = 0.3;
    scene.implicit_dynamics.reference_displacement = 1e-3;
  } else
    scene.solver.max_iterations = 6;
  SceneRun untried(scene), tried(scene);
  bool failed = true, same = true;
  unsigned int n_inaccurate = 0;
  for (unsigned int step = 0; step < 15; ++step) {
    const NewtonReport report = tried.problem.step(tried.control.time() + 0.05, 1.);
    failed = failed && !report.converged;
    n_inaccurate += report.failure.find("time integration") != std::string::npos;
    untried.advance();
    tried.advance();
    same = same && same_bits(untried, tried);
    if (!failed)
      break;
  }
  std::cout << (by_accuracy ? "steps that are not accurate" : "steps that do not converge") << ": ";
  check("far too long ones fail", failed && by_accuracy == (n_inaccurate > 0));
  check("  ... and the short ones have the same bits as without them", same);
}

} // namespace

BILLET_MPI_TEST(implicit_motion) {
  check_heavy_tools();
  check_moving_supports();
  check_removal();
  check_pressure();
  check_accuracy();
  check_failed_steps(false);
  check_failed_steps(true);
}

} // namespace implicit_motion_test
