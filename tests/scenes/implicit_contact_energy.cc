// SPDX-License-Identifier: LGPL-2.1-or-later
// Implicit dynamics makes no energy by contact, however stiff the penalty is for the step: a bar on a wall,
// and two bars on each other. Where steps resolve contact nothing is damped.
#include "implicit_run.h"

#include "billet/diagnostic_kinds.h"

#include <deal.II/base/mpi.h>

namespace implicit_contact_energy_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

struct Run {
  double made = 0., lost = 0., rise = 0.; // parts of the initial energy; rise: of kinetic and elastic
  bool is_damped = false, is_reported = false, names_impacts = false;
};

Run run(parameters::Scene scene, const double penalty, const double friction = 0.) {
  auto &stepping = scene.time_stepping;
  stepping.scheme = parameters::TimeStepping::Scheme::implicit_dynamics;
  stepping.control = parameters::TimeStepping::Control::automatic;
  stepping.initial_step = stepping.end_time / 200.;
  stepping.max_step = stepping.end_time / 50.;
  stepping.min_step = 1e-7 * stepping.end_time;
  stepping.few_iterations = 5;
  stepping.many_iterations = 9;
  stepping.growth_factor = 1.5;
  stepping.shrink_factor = 0.7;
  stepping.cut_factor = 0.5;
  scene.implicit_dynamics.error_tolerance = 1e-3;
  scene.output.interval = 0.; // steps do not end at the states that an explicit scene writes
  for (auto &pair : scene.pairs) {
    pair.penalty.normal = pair.penalty.tangential = penalty;
    pair.friction = make_coulomb(friction);
  }
  SceneRun run(scene);
  const EnergyLedger &energies = run.problem.state().energies;
  Run result;
  run.finish([&](const NewtonReport &report) {
    const double drift = energies.drift() / energies.initial;
    result.made = std::max(result.made, -drift);
    result.lost = std::max(result.lost, drift);
    result.rise = std::max(result.rise, (energies.kinetic + energies.elastic) / energies.initial - 1.);
    for (const auto &message : report.diagnostics)
      if (&message.kind() == &diagnostic::contact_dissipates) {
        result.is_reported = true;
        result.names_impacts =
            message.what().find("% by damped impacts within a step") < message.what().find(" % by nodes");
      }
  });
  result.is_damped = energies.numerical > 1e-4 * energies.initial;
  return result;
}

} // namespace

BILLET_MPI_TEST(implicit_contact_energy) {
  parameters::Scene bar = testing::read_test_scene("elastic_bar.prm");
  bar.bodies[0].mesh.arguments = "16, 1, 1 : 0.002, 0, 0 : 0.202, 0.0125, 0.0125 : true";
  testing::set_newmark(bar); // which takes nothing by itself
  for (const double penalty : {1., 1e3, 1e6}) {
    std::ostringstream name;
    name << "a bar on a wall, " << penalty << " E/h";
    const Run result = run(bar, penalty);
    check(name.str() + ": no energy is made", result.made, 0.01);
    check(name.str() + ": nor lost without account", result.lost, 0.01);
    check(name.str() + ": none that moves or strains the bar", result.rise, 0.01);
    check(name.str() + ": damped where it has to be", result.is_damped == (penalty > 10.));
  }
  bar.pairs[0].penalty.normal = 1.;
  const Run rough = run(bar, 1e4, 0.3);
  check("with friction: no energy is made", rough.made, 0.01);
  // A single brick holds all of its energy by the nodes that hit the wall.
  bar.bodies[0].mesh.arguments = "1, 1, 1 : 0.002, 0, 0 : 0.202, 0.2, 0.2 : true";
  const Run block = run(bar, 1e4);
  check("a brick: no energy is made", block.made, 0.01);
  check("  a warning is printed if contact takes energy", block.is_reported);
  check("  and that impacts do it", block.names_impacts);
}

} // namespace implicit_contact_energy_test
