// SPDX-License-Identifier: LGPL-2.1-or-later
// Limits of what an implicit step may pass over, PathGuard, of what round-off may take, RoundOffGuard, of
// trials to balance bodies, ResultantGuard, and of sliding under loads, SlidingGuard.
#include "billet/solve/implicit/path_guard.h"
#include "billet/solve/implicit/resultant_guard.h"
#include "billet/solve/implicit/round_off_guard.h"
#include "billet/solve/implicit/sliding_guard.h"

#include "../scenes/scene_run.h"

#include <deal.II/base/mpi.h>

#include <fstream>
#include <string>

namespace implicit_guards_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

parameters::Scene read(const std::string &name) {
  return parameters::Scene::read(std::string(SOURCE_DIR) + "/" + name);
}

void check_cuts() {
  auto parameters = read("confined_element.prm");
  parameters.time_stepping.min_step = 0.5;
  SceneRun run(parameters);
  const PathGuard paths(run.problem.equation());
  check("steps are cut until they are 1e-9 longer than the minimum",
        paths.may_be_cut(0.5 * (1. + 1.1e-9)) && !paths.may_be_cut(0.5 * (1. + 0.9e-9)));
}

/// Block and floor turn together, by 2 pi in a time of 1.
void check_turns() {
  auto parameters = read("../scenes/block_on_plane.prm");
  parameters.time_stepping.initial_step = 1.;
  SceneRun run(parameters);
  run.advance();
  const PathGuard paths(run.problem.equation());
  const auto turns_too_far = [&](const double degrees) {
    return paths.judge_turns(1. + degrees / 360.).has_value();
  };
  check("a tool with friction turns by 15 degrees at most", !turns_too_far(14.9) && turns_too_far(15.1));
}

/// Vertical motions of a support that a step from 0 to 1 of a run to 2 samples at its ends only.
void check_motions() {
  const auto skips = [](const std::string &motion) {
    auto parameters = read("confined_element.prm");
    parameters.time_stepping.end_time = 2.;
    parameters.bodies[0].supports[0].displacement.value[2] = "1e-3*(" + motion + ")";
    SceneRun run(parameters);
    return PathGuard(run.problem.equation()).judge_prescribed_motion(1.).has_value();
  };
  // Up by 1 + back, and back after a rest: the path is 1 + 2 back times the chord.
  const auto skips_return = [&](const double back) {
    const std::string b = std::to_string(back);
    return skips("(1 + " + b + ")*min(2*t, 1) - " + b + "*max(0, t - 0.75)/0.25");
  };
  check("paths of 1.003 times their chord are that of an arc of 15 degrees",
        !skips_return(0.00145) && skips_return(0.00155));
  const auto skips_part = [&](const double part) {
    return skips(std::to_string(part) + "*max(0, 0.5 - abs(0.5 - t)) + max(0, t - 1)");
  };
  check("paths of a twentieth of the way in the run do not count", !skips_part(0.048) && skips_part(0.053));
}

enum class Meeting { none, accepted, too_early };

/// A step of a block that is 0.09 facet sizes above the floor and would move by so many.
Meeting meet(const double motion) {
  constexpr double step = 1e-4;
  auto parameters = read("implicit_guards.prm");
  parameters.implicit_dynamics.error_tolerance = 0.;
  parameters.bodies[0].initial_velocity.value = {{"0", "0", std::to_string(-motion / step)}};
  SceneRun run(parameters);
  const NewtonReport report = run.problem.step(step, 0.);
  return report.failure.find("nodes approach by") != std::string::npos ? Meeting::too_early
         : run.load().area > 0.                                        ? Meeting::accepted
                                                                       : Meeting::none;
}

void check_first_contacts() {
  check("in a step of first contact nodes approach by a tenth of a facet",
        meet(0.098) == Meeting::accepted && meet(0.102) == Meeting::too_early);
}

/// Steps that round-off limits.
void check_lost_steps(const SceneRun &run) {
  RoundOffGuard guard(run.problem.equation());
  NewtonReport lost;
  lost.converged = lost.is_lost_in_round_off = true;
  const auto n_accepted = [&] {
    for (unsigned int n = 0; n < 10; ++n) {
      if (guard.judge(0.5, lost))
        return n;
      guard.commit(0.5, lost);
    }
    return 10U;
  };
  check("three steps in a row may be lost in round-off", n_accepted() == 3);
  guard.commit(0.5, NewtonReport());
  check("and again after one that is not", n_accepted() == 3);
  guard.commit(0.5, NewtonReport());
  const std::optional<StepFailure> last = guard.judge(1., lost);
  check("the last one may not", last && last->kind == StepFailure::Kind::round_off);
}

void check_round_off(SceneRun &run) {
  ForceScales &scales = run.problem.equation().scales();
  const RoundOffGuard guard(run.problem.equation());
  NewtonReport report;
  report.iterations.resize(1);
  const auto may_explain = [&](const double residual, const double springs) {
    scales.force = 1.;
    scales.spring_round_off = springs;
    report.force = residual;
    return guard.may_explain(report);
  };
  check("round-off of springs explains residuals up to ten times as large",
        may_explain(0.098, 0.01) && !may_explain(0.102, 0.01));
  check("if it is 0.005 of the forces", may_explain(0.01, 0.0051) && !may_explain(0.01, 0.0049));
  const auto is_told = [&](const double round_off) {
    scales = ForceScales();
    scales.force = 1.;
    scales.round_off = round_off;
    return guard.check(0.01, 1.).size() == 1;
  };
  check("forces below a tenth of the round-off of bodies are none", is_told(9.8) && !is_told(10.2));
}

/// Steps that go without further iterations after each of eight failures in a row to balance bodies.
void check_resultants(const SceneRun &run) {
  ResultantGuard guard(run.problem.equation());
  const auto n_without = [&guard] {
    guard.note(false);
    guard.commit();
    unsigned int n = 0;
    for (; !guard.is_hopeful(); ++n)
      guard.commit();
    return n;
  };
  bool doubles = true;
  for (const unsigned int n : {0U, 1U, 3U, 7U, 15U, 31U, 63U, 63U})
    doubles = n_without() == n && doubles;
  check("failures to balance bodies double the steps without a trial, up to the seventh", doubles);
  guard.note(true);
  guard.commit();
  check("a success ends that", n_without() == 0);
}

/// A block under a weight whose foot slides by so many facets in a step.
std::optional<StepFailure> slide(const double facets) {
  const std::string file = "sliding.prm";
  std::ofstream(file) << "include " << SOURCE_DIR << "/confined_element.prm\n"
                      << "subsection Bodies\n subsection block\n  subsection Loads\n   subsection weight\n"
                      << "    set Type = acceleration\n    set Acceleration = 0 ; 0 ; -1e-9\n   end\n  end\n"
                      << "  subsection Material\n   set Density = 1\n  end\n end\nend\n";
  auto parameters = parameters::Scene::read(file);
  parameters.bodies[0].supports[0].displacement.value[2] = "-1e-3*t";
  SceneRun run(parameters);
  run.problem.step(0.5, 0.);
  ImplicitProblem &problem = run.problem.equation();
  SlidingGuard guard(problem);
  problem.step().time = 1.;
  problem.parts().scheme().start_step(0.5, 1., problem.step().start.displacements,
                                      problem.parts().tools().start_offsets());
  problem.start_step(1.);
  Vector positions = run.discretization.make_owned_vector();
  positions = problem.step().start.displacements;
  for (const auto &element : run.discretization.elements(0))
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      positions(element.dofs[3 * a]) = facets; // of size 1
  positions.compress(dealii::VectorOperation::insert);
  Vector ghosted = run.discretization.make_ghosted_vector();
  ghosted = positions;
  problem.parts().contacts()[0].with_matrix().update(ghosted);
  DiagnosticList messages;
  return guard.judge(1., messages);
}

void check_sliding() {
  check("loads slide nodes by two facets in a step at most", !slide(1.98) && slide(2.02));
}

} // namespace

BILLET_MPI_TEST(implicit_guards) {
  check_cuts();
  check_turns();
  check_motions();
  check_first_contacts();
  SceneRun run(read("confined_element.prm"));
  check_lost_steps(run);
  check_round_off(run);
  check_resultants(run);
  check_sliding();
}

} // namespace implicit_guards_test
