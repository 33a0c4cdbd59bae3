// SPDX-License-Identifier: LGPL-2.1-or-later
// Reactions of implicit scenes: closed forms; and in every scene the sum of reactions, contact forces, loads
// and inertia is that of the free residuals, whatever constrains a node.
#include "implicit_run.h"

namespace reactions_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;
using billet::testing::WorstError;

namespace {

using Vector3 = dealii::Tensor<1, 3>;

/// Returns the reaction of a support or symmetry plane of the first body.
const Resultant &reaction(const SceneRun &run, const std::string &name) {
  const std::vector<NamedSupport> supports = named_supports(run.scene);
  for (std::size_t i = 0; i < supports.size(); ++i)
    if (supports[i].body == 0 && supports[i].name == name)
      return run.problem.reactions().of_supports.at(i);
  throw std::logic_error("no " + name);
}

/// A cube under a frictionless die: the plane beneath takes all, at the middle of its face.
void press_cube() {
  SceneRun run(testing::read_test_scene("upset_cube.prm"));
  run.finish();
  const double force = 975.324 * 1.57960 * 1.57960, arm = 0.5 * 1.57960;
  const Resultant &base = reaction(run, "symmetry plane z = 0");
  check("cube: force of the plane beneath", std::abs(base.force[2] / force - 1.), 1e-4);
  check("cube: it is that of the die", std::abs(base.force[2] / run.load().force[2] + 1.), 1e-6);
  check("cube: a plane has no force along itself", base.force[0] == 0. && base.force[1] == 0.);
  check("cube: moment about the origin",
        (base.moment - Vector3({arm * force, -arm * force, 0.})).norm() / (arm * force), 1e-4);
  check("cube: nothing holds the sides",
        (reaction(run, "symmetry plane x = 0").force + reaction(run, "symmetry plane y = 0").force).norm() /
            force,
        1e-7);
  const ContactLoad &pair = run.problem.reactions().of_tool_pairs.at(0);
  check("cube: force of the pair", (pair.force - run.load().force).norm() == 0.);
  check("cube: its moment about the origin balances that of the plane",
        (pair.moment + base.moment).norm() / base.moment.norm(), 1e-6);
}

/// With the trapezoidal rule, the impulse of the reaction is the change of momentum.
void swing_bar() {
  parameters::Scene parameters = testing::read_test_scene("implicit_bar.prm");
  testing::set_newmark(parameters);
  parameters.bodies[0].initial_velocity.value[0] = "0.01*x";
  parameters.time_stepping.end_time = testing::n_ranks() == 1 ? 5. : 2.;
  SceneRun run(parameters);
  Vector3 momentum, force;
  double time = 0.;
  WorstError worst;
  run.finish([&](const NewtonReport &) {
    const SolutionState &state = run.problem.state();
    const Vector3 now = reaction(run, "support root").force;
    if (time > 0.)
      worst.add((state.momentum - momentum - 0.5 * (state.time - time) * (force + now)).norm() / 0.32);
    momentum = state.momentum;
    force = now;
    time = state.time;
  });
  check("bar: impulse of the root", worst.value(), 1e-9);
}

/// A second support of the same face: the first one takes the force, and the sum stays.
void hold_twice() {
  parameters::Scene parameters = testing::read_test_scene("implicit_bar.prm");
  testing::set_newmark(parameters);
  parameters.bodies[0].initial_velocity.value[0] = "0.01*x";
  parameters.time_stepping.end_time = 2.;
  SceneRun once(parameters);
  once.finish();
  parameters.bodies[0].supports.push_back(parameters.bodies[0].supports[0]);
  parameters.bodies[0].supports.back().name = "again";
  SceneRun twice(parameters);
  twice.finish();
  const Vector3 force = reaction(once, "support root").force;
  check("bar, held twice: the first support takes the force",
        (reaction(twice, "support root").force - force).norm() == 0. && force.norm() > 1e-3);
  check("bar, held twice: the second has none", reaction(twice, "support again").force.norm() == 0.);
}

/// A difference above round-off is a warning, in float above that of float.
void warn() {
  ForceBalance forces;
  forces.reactions[0] = forces.free[0] = forces.size = 1.;
  check("forces that balance are no warning", check_force_balance(forces, 0., false).empty());
  forces.free[0] += 1e-8;
  check("a difference is one", check_force_balance(forces, 0., false).size() == 1);
  forces.round_off = 1e-7;
  check("round-off of positions is none", check_force_balance(forces, 0., false).empty());
  check("not in float", check_force_balance(forces, 0., true).empty());
  forces.contact[1] = 0.01;
  check("a large one is one in float, too", check_force_balance(forces, 0., true).size() == 1);
}

/// Runs a few steps of a scene, and checks the balance of its forces.
void balance(const std::string &name, const std::function<void(parameters::Scene &)> &change = {}) {
  parameters::Scene parameters = testing::read_test_scene(name + ".prm");
  if (change)
    change(parameters);
  SceneRun run(parameters);
  WorstError defect, pairs;
  double largest = 0.;
  const unsigned int n_steps = testing::n_ranks() == 1 ? 4 : 2;
  for (unsigned int step = 0; step < n_steps && !run.control.is_finished(); ++step) {
    run.advance();
    const Reactions &reactions = run.problem.reactions();
    defect.add(reactions.balance.defect());
    largest = std::max(largest, reactions.balance.size);
    std::vector<Vector3> of_tools(run.scene.tools().size());
    for (std::size_t i = 0; i < run.scene.pairs().size(); ++i)
      of_tools[run.scene.pairs()[i].tool] += reactions.of_tool_pairs[i].force;
    for (std::size_t i = 0; i < of_tools.size(); ++i)
      pairs.add((of_tools[i] - run.load(i).force).norm() / reactions.balance.size);
  }
  check(name + ": forces balance", largest > 0. ? defect.value() : 1., 1e-12);
  check(name + ": forces of pairs are those of tools", pairs.value(), 1e-14);
}

} // namespace

BILLET_MPI_TEST(reactions) {
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) != 0)
    std::cout.setstate(std::ios::failbit);
  const bool is_alone = testing::n_ranks() == 1;
  if (is_alone)
    press_cube();
  swing_bar();
  for (const std::string name : {"restart_press", "dragged_blocks", "turning_tool"})
    balance(name);
  if (!is_alone)
    return;
  hold_twice();
  warn();
  for (const std::string name :
       {"block_on_plane", "confined_block", "drawn_block", "flush_tools", "friction_account_of_bodies",
        "open_ring", "pressed_blocks", "restart_blocks"})
    balance(name);
  balance("implicit_bar", [](parameters::Scene &scene) {
    testing::set_hht(scene, -0.2);
    scene.bodies[0].initial_velocity.value[0] = "0.01*x";
  });
}

} // namespace reactions_test
