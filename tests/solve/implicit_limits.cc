// SPDX-License-Identifier: LGPL-2.1-or-later
// Limits of the parts of an implicit step, of one element whose solution is known: first guesses, round-off,
// measurements of penetration, penalties that rise from lower ones, and errors of time integration.
#include "billet/solve/implicit/energy_balance.h"
#include "billet/solve/implicit/free_motion.h"
#include "billet/solve/implicit/path_guard.h"
#include "billet/solve/implicit/penalty_continuation.h"
#include "billet/solve/implicit/predictor.h"
#include "billet/solve/implicit/rigid_body_modes.h"

#include "../contact/memory_state.h"
#include "../scenes/scene_run.h"

#include <deal.II/base/mpi.h>

#include <limits>

namespace implicit_limits_test {

using namespace billet;
using billet::testing::check;
using billet::testing::near;
using billet::testing::SceneRun;

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// A bar of stiffness 1000 on a spring. `motion`: of its upper end.
parameters::Scene read_bar(const std::string &motion, const double penalty = 10.) {
  auto parameters = parameters::Scene::read(std::string(SOURCE_DIR) + "/confined_element.prm");
  parameters.bodies[0].supports[0].displacement.value[2] = motion;
  auto &pair = parameters.pairs[0];
  pair.penetration_tolerance = 0.;
  pair.penalty.is_given = true;
  pair.penalty.normal = penalty;
  return parameters;
}

/// A block above a floor. `velocity`: its vertical one.
parameters::Scene read_block(const std::string &velocity) {
  auto parameters = parameters::Scene::read(std::string(SOURCE_DIR) + "/implicit_guards.prm");
  parameters.bodies[0].initial_velocity.value = {{"0", "0", velocity}};
  return parameters;
}

/// Supports that move faster in a second step, by `jump` times the first.
void check_first_guess() {
  const auto continues = [](const double jump) {
    SceneRun run(read_bar("-1e-3*(t + " + std::to_string(jump) + "*max(t - 0.1, 0))"));
    run.problem.step(0.1, 0.);
    return Predictor(run.problem.equation()).guess(0.2, 0.1);
  };
  // The foot moves little beside the head.
  check("motion is continued if supports jump by less than a tenth of it",
        continues(0.098) && !continues(0.1025));
}

void check_round_off() {
  SceneRun run(read_bar("-1e-3*(1 - abs(t - 1))"));
  ImplicitProblem &problem = run.problem.equation();
  const double radius = run.discretization.radius();
  check("round-off of displacements is a hundred last bits",
        near(problem.scales().round_off, 100. * epsilon * 1000. * radius * radius, 1e-9));
  const ContactSet &contacts = problem.parts().contacts();
  const double reach = run.discretization.centre().norm() + radius + contacts[0].measures().surface_reach();
  check("that of springs is three of the reach",
        near(contacts.find_spring_round_off(), 3. * epsilon * contacts[0].penalties().max_spring() * reach,
             1e-9));
  run.problem.step(1., 0.);
  const double force = problem.force_scale();
  // The spring is ten times as stiff as the bar.
  check("without a tolerance 1e-5 facets are the unit of penetration",
        near(run.problem.penetration(), 1e-3 / 11. / 1e-5, 0.01));
  run.problem.step(2.5, 0.);
  check("a thousandth of former forces lasts as their scale",
        near(problem.force_scale(), 1e-3 * force, 0.01));
}

/// A probe that cannot converge.
void check_probe() {
  auto parameters = read_bar("-1e-3*t");
  parameters.solver.force_tolerance = -1.;
  SceneRun run(parameters);
  const std::string failure = run.problem.probe(1., 0.).newton.failure;
  check("probes take eight iterations at most", failure.find("in 8 iterations") != std::string::npos);
}

/// An augmentation leaves the part K/(K + k) of the penetration, K of the bar and k of the spring.
void check_measurement() {
  const auto measured = [](const double left) {
    SceneRun run(read_bar("-1e-5*t", (1. - left) / left));
    run.problem.measurement().ask();
    run.problem.step(1., 0.);
    const auto measurement = run.problem.measurement().take();
    return measurement ? measurement->without[0][0].norm() : 0.;
  };
  constexpr double rigid = 1e-2; // force
  check("a geometric series finds what is left, up to 0.8 of the penetration",
        near(measured(0.79), rigid, 1e-3) && near(measured(0.5), rigid, 1e-3) &&
            measured(0.81) < 0.99 * rigid);
}

/// Penalties so many octaves above 10 E/h: numbers of iterations, one for each penalty.
void check_continuation() {
  using Start = PenaltyContinuation::Start;
  const auto n_penalties = [](const int octaves, const Start start = Start::enough) {
    SceneRun run(read_bar("-1e-4*t", std::ldexp(10., octaves)));
    ImplicitProblem &problem = run.problem.equation();
    EquilibriumSolver solver(problem);
    PenaltyContinuation continuation(problem, solver);
    problem.step().time = 1.;
    problem.parts().scheme().start_step(0., 1., problem.step().start.displacements,
                                        problem.parts().tools().start_offsets());
    problem.start_step(1.);
    Vector x = problem.step().start.displacements;
    problem.parts().supports().at_time(1.).distribute(x);
    std::vector<double> offsets = problem.parts().tools().offsets();
    const NewtonReport report = continuation.iterate(start, offsets, x);
    return report.converged ? report.iterations.size() : 0;
  };
  check("penalties rise by three octaves at a time",
        n_penalties(3) == n_penalties(2) && n_penalties(4) == n_penalties(3) + 1);
  const auto n_from_low = [&](const int octaves) { return n_penalties(octaves, Start::low); };
  const unsigned int of_first = 6; // iterations with the lowest penalty, and five penalties above it
  check("low penalties are 13 octaves below 10 E/h", n_from_low(0) == of_first + 5 &&
                                                         n_from_low(2) == n_from_low(0) &&
                                                         n_from_low(3) == n_from_low(0) + 1);
}

/// Energies of a run before, as a checkpoint keeps them.
void check_balance() {
  SceneRun run(read_bar("-1e-3*t"));
  const auto is_told = [&](const double part) {
    StaticBalance balance(run.problem.equation());
    testing::MemoryState state;
    testing::MemoryWriter writer(state);
    writer.write("largest energy", {1.});
    writer.write("contact balance", {part});
    writer.write("rejected step", {-1., 0.});
    testing::MemoryReader reader(state);
    balance.load(reader);
    return !balance.finish().empty();
  };
  check("4 % of all work lost by contact are told", is_told(0.041) && !is_told(0.039) && is_told(-0.041));
}

/// Supports that hold still, and a node that moves by so many diameters of the scene before and in a step.
void check_far_motion() {
  SceneRun run(read_bar("0"));
  ImplicitProblem &problem = run.problem.equation();
  const auto is_too_far = [&](const double before, const double in_step) {
    const double diameter = 2. * run.discretization.radius();
    StepState &step = problem.step();
    for (const DofIndex dof : run.discretization.owned_dofs())
      if (!problem.parts().supports().homogeneous().is_constrained(dof)) {
        step.start.displacements(dof) = before * diameter;
        step.trial.displacements(dof) = (before + in_step) * diameter;
      }
    step.start.displacements.compress(dealii::VectorOperation::insert);
    step.trial.displacements.compress(dealii::VectorOperation::insert);
    return judge_travel(problem, 1.).has_value();
  };
  check("nodes move by one diameter in a step", !is_too_far(0., 0.98) && is_too_far(0., 1.02));
  check("and by ten in all", !is_too_far(9.3, 0.5) && is_too_far(9.7, 0.5));
}

/// Two bars on springs of which one is softer by this factor.
void check_stiffest_pairs() {
  const auto named = [](const double factor) {
    auto parameters = read_bar("0");
    parameters.bodies.push_back(parameters.bodies[0]);
    parameters.bodies.back().name = "other";
    parameters.pairs.push_back(parameters.pairs[0]);
    auto &pair = parameters.pairs.back();
    pair.name = "foot of other";
    pair.body.value = "other";
    pair.penalty.normal *= factor;
    pair.penalty.tangential *= factor;
    const SceneRun run(parameters);
    return run.problem.equation().parts().contacts().stiffest_pairs();
  };
  check("pairs with a tenth of the stiffest springs are named with it",
        named(0.102) == "'foot', 'foot of other'" && named(0.098) == "'foot'");
}

enum class Loss { held, shorter, final };

/// A block above a floor in a step of this part of the longest: contact held it before, at last with this
/// part of its largest force.
Loss lose(const double force, const double length) {
  auto parameters = read_bar("0");
  parameters.bodies[0].supports.clear();
  parameters.bodies[0].mesh.translation[2] = 0.1;
  parameters.bodies[0].is_stabilised.value = true;
  parameters.time_stepping.max_step = 1.;
  SceneRun run(parameters);
  ImplicitProblem &problem = run.problem.equation();
  RigidBodyModes modes(problem);
  RigidBodySupport::Result held;
  held.is_free = {false};
  for (unsigned int step = 0; step < 4; ++step) // until stabilising forces have faded
    problem.parts().stabilisation().commit(problem.step(), held, 0.);
  testing::MemoryState state;
  testing::MemoryWriter writer(state);
  writer.write("forces on bodies", {force});
  writer.write("largest forces on bodies", {1.});
  writer.write("free modes", {0.});
  testing::MemoryReader reader(state);
  modes.load(reader, true);
  DiagnosticList messages;
  try {
    modes.judge(length, messages);
  } catch (const SolutionFailure &) {
    return Loss::final;
  }
  return problem.parts().stabilisation().acts_on(0) ? Loss::held : Loss::shorter;
}

void check_losses() {
  check("bodies are held once less than a hundredth of their contact force is left",
        lose(0.0098, 0.5) == Loss::held && lose(0.0102, 0.5) == Loss::shorter);
  check("others are lost once steps are a thousandth of the longest",
        lose(1., 1.02e-3) == Loss::shorter && lose(1., 0.98e-3) == Loss::final);
}

/// What a step of a block at rest does to energies, of which the largest has been 1.
struct Energies {
  double of_contact = 0.;                     ///< taken by contact so far
  double of_elements = 0., of_last_step = 0.; ///< imbalance of the elements before, and in the step
};
struct Judged {
  bool makes_energy, takes_energy;
  double error; ///< over what is allowed
};
Judged judge(const Energies &energies) {
  constexpr double step = 1e-4;
  auto parameters = read_block("0");
  parameters.implicit_dynamics.error_tolerance = 0.;
  SceneRun run(parameters);
  ImplicitProblem &problem = run.problem.equation();
  const PathGuard paths(problem);
  DynamicBalance balance(problem, paths, *problem.parts().motion());
  testing::MemoryState state;
  testing::MemoryWriter writer(state);
  writer.write("largest energy", {1.});
  writer.write("contact balance", {energies.of_contact});
  writer.write("element balance", {energies.of_elements});
  writer.write("contact losses", ContactLosses().save());
  balance.load(testing::MemoryReader(state));
  problem.state().energies.elastic = -energies.of_last_step;
  problem.step().time = step;
  problem.parts().scheme().start_step(0., step, problem.step().start.displacements,
                                      problem.parts().tools().start_offsets());
  problem.start_step(step);
  balance.judge_accuracy(step);
  const double error = balance.time_error();
  DiagnosticList messages;
  const std::optional<StepFailure> failure = balance.judge_contact(step, messages);
  const auto is_of = [&failure](const StepFailure::Kind kind) { return failure && failure->kind == kind; };
  return {is_of(StepFailure::Kind::makes_energy), is_of(StepFailure::Kind::explained), error};
}

void check_dynamic_balance() {
  check("contact may make 0.005 of the energy",
        judge({-0.0051}).makes_energy && !judge({-0.0049}).makes_energy);
  check("what it may return is not taken, and 0.01 beside that in a step",
        judge({0.0152}).takes_energy && !judge({0.0148}).takes_energy);
  check("elements may be off by a twentieth of 0.02 of the energy in a step",
        near(judge({0., 0., 1e-3}).error, 1., 1e-9));
  check("then by a twentieth of the rest", near(judge({0., 0.01, 1e-3}).error, 2., 1e-9));
  check("and always by 1e-4", near(judge({0., 0.019, 1e-3}).error, 10., 1e-9));
}

void check_motion() {
  const auto accuracy = [](const double tolerance) {
    auto parameters = read_block("-1");
    parameters.implicit_dynamics.error_tolerance = tolerance;
    SceneRun run(parameters);
    return run.problem.equation().parts().motion()->wanted_accuracy();
  };
  check("errors below 1e-3 of the displacement ask for more accuracy",
        near(accuracy(0.5e-3), 0.5, 1e-12) && near(accuracy(0.98e-3), 0.98, 1e-12) &&
            accuracy(1.02e-3) == 1.);
  constexpr double step = 1e-4;
  // The block begins to stretch, by much less than a millionth of the scene.
  const auto error = [](const double reference) {
    auto parameters = read_block("1e-7*(z - 0.59)");
    parameters.implicit_dynamics.error_tolerance = 1e-3;
    parameters.implicit_dynamics.reference_displacement = reference;
    parameters.time_stepping.min_step = step; // no other errors count
    SceneRun run(parameters);
    run.problem.step(step, 0.);
    return std::array<double, 2>{{run.problem.balance().time_error(), run.discretization.radius()}};
  };
  const auto [by_default, radius] = error(0.);
  check("displacements below a millionth of the scene count as that much",
        by_default > 0. && near(by_default, error(1e-6 * radius)[0], 1e-9));
  auto parameters = read_block("-1");
  parameters.implicit_dynamics.error_tolerance = 0.;
  SceneRun run(parameters);
  run.problem.step(step, 0.);
  const double mass = 1e-3, factor = parameters.implicit_dynamics.integrator.mass_factor(step);
  check("round-off of inertia is ten last bits of the motion in a step",
        near(run.problem.equation().parts().motion()->round_off_force(),
             10. * epsilon * factor * mass / std::sqrt(8.) * step, 1e-9));
}

} // namespace

BILLET_MPI_TEST(implicit_limits) {
  check_first_guess();
  check_round_off();
  check_probe();
  check_measurement();
  check_continuation();
  check_balance();
  check_far_motion();
  check_stiffest_pairs();
  check_losses();
  check_dynamic_balance();
  check_motion();
}

} // namespace implicit_limits_test
