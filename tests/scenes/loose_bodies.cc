// SPDX-License-Identifier: LGPL-2.1-or-later
// Bodies that viscous forces hold until tools and bodies do, (Q3): their forces are those of the scene in
// which they touch at the start, energies balance, a checkpoint in the middle of the fading changes nothing,
// and where the forces do much of all work a warning says so.
#include "restart_run.h"

#include "billet/diagnostic_kinds.h"

#include <deal.II/base/mpi.h>

namespace loose_bodies_test {

using namespace billet;
using billet::testing::check;
using billet::testing::ImplicitSolutionRun;
using billet::testing::SceneRun;

namespace {

/// Nodes against facets take half as long as overlaps.
parameters::Scene read(const FacetMethod facets = FacetMethod::planed) {
  parameters::Scene scene = testing::read_test_scene("loose_bodies.prm");
  scene.pairs[1].facets.method.value = facets;
  return scene;
}

/// The same without gaps, by bodies that stand on each other and are held at the start by nothing else.
parameters::Scene without_gaps() {
  parameters::Scene scene = read();
  for (auto &body : scene.bodies)
    body.is_stabilised.value = false;
  scene.bodies[0].mesh.translation[2] = -0.2;
  scene.bodies[1].mesh.translation[2] = -0.3;
  scene.tools[0].motion.translation.value[2] = "-0.3 - 0.05*t";
  return scene;
}

void set_way(parameters::Scene &scene, const std::string &way) {
  scene.tools[0].motion.translation.value[2] = way;
}

} // namespace

BILLET_MPI_TEST(loose_bodies) {
  // On several ranks: forces and energies as on one, also of runs that go on.
  const bool is_alone = testing::n_ranks() == 1;
  const bool is_first = billet::testing::is_first_rank();
  const auto check_here = [&](const std::string &name, const auto... values) {
    if (is_first)
      check(name, values...);
  };
  if (is_alone) {
    SceneRun touching(without_gaps()), loose(read());
    touching.finish();
    billet::testing::WorstError drift;
    double last_factor = 1.;
    bool comes_back = false;
    loose.finish([&](const NewtonReport &) {
      const EnergyLedger &energies = loose.problem.state().energies;
      drift.add(std::abs(energies.drift()));
      const double factor = loose.problem.equation().parts().stabilisation().get()->factor(0);
      comes_back = comes_back || factor > last_factor;
      last_factor = factor;
    });
    const EnergyLedger &energies = loose.problem.state().energies;
    const double force = touching.load(0).force.norm();
    check_here("the force is that of bodies that touch at the start",
               (loose.load(0).force - touching.load(0).force).norm(), 0.01 * force);
    check_here("that of the table, too", (loose.load(1).force - touching.load(1).force).norm(), 0.01 * force);
    check_here("energies balance", drift.value(), 0.01 * energies.external);
    const ContactStabilisation &stabilisation = *loose.problem.equation().parts().stabilisation().get();
    check_here("viscous forces have done work", energies.viscous > 0.);
    check_here("which is in the account",
               std::abs(energies.viscous - stabilisation.work(0) - stabilisation.work(1)),
               1e-12 * energies.viscous);
    check_here("and less than a thousandth of all", energies.viscous, 1e-3 * energies.external);
    check_here("they have gone and did not come back", !stabilisation.acts() && !comes_back);
    check_here("without a message", loose.problem.finish().empty());
  }
  if (is_alone) {
    parameters::Scene scene = read();
    set_way(scene, "-0.300005*t");
    SceneRun run(scene);
    run.finish();
    const DiagnosticList messages = run.problem.finish();
    const Diagnostic *found = find(messages, diagnostic::stabilisation_too_strong);
    const double part =
        run.problem.equation().parts().stabilisation().get()->work(0) / run.problem.state().energies.external;
    check_here("bodies that are hardly pressed: a warning", found != nullptr && part > 1e-3);
    check_here("with the factor", found != nullptr && std::abs(*found->measure() / (1e3 * part) - 1.) < 0.2);
  }
  if (is_alone) {
    parameters::Scene scene = read();
    set_way(scene, "-0.28*t");
    SceneRun run(scene);
    run.finish();
    check_here("bodies that nothing stops: a warning",
               find(run.problem.finish(), diagnostic::stabilised_loads) != nullptr &&
                   run.problem.equation().parts().stabilisation().get()->factor(0) == 1.);
  }
  // On several ranks round-off decides where the block goes: the direct solver sums in any order.
  if (is_alone) {
    parameters::Scene scene = read();
    for (auto &pair : scene.pairs) {
      pair.friction = nullptr;
      pair.penetration_tolerance = 0.; // springs bear that until the end
    }
    {
      scene.time_stepping.initial_step = scene.time_stepping.max_step = 0.02;
      SceneRun run(scene);
      run.finish();
      check_here("without friction an eccentric block is squeezed out: a warning",
                 find(run.problem.finish(), diagnostic::stabilisation_too_strong) != nullptr);
    }
    scene.bodies[1].mesh.translation = dealii::Tensor<1, 3>({-0.1, -0.15, 0.});
    SceneRun run(scene);
    run.finish();
    check_here("a block in the middle could slide, but no force moves it: no message",
               run.problem.finish().empty() && run.problem.equation().parts().stabilisation().acts());
  }
  if (is_alone) {
    // A force presses in place of a given motion.
    parameters::Scene scene = read();
    set_way(scene, "0");
    scene.tools[0].motion.control = parameters::Motion::Control::force;
    scene.tools[0].motion.load.value = "10*t";
    scene.tools[0].motion.direction = dealii::Tensor<1, 3>({0., 0., -1.});
    SceneRun run(scene);
    run.finish();
    check_here("a force pushes them together, too", std::abs(run.load(1).force[2] - 10.), 0.01 * 10.);
    check_here("its work over the gaps is no reason to warn",
               run.problem.finish().empty() && !run.problem.equation().parts().stabilisation().get()->acts());
  }
  if (is_alone) {
    // Pressed, then die and table go apart.
    parameters::Scene scene = read();
    set_way(scene, "-0.7*min(t, 0.5) + (t > 0.6)*(t - 0.6)");
    scene.tools[1].motion.translation.value[2] = "-(t > 0.6)*(t - 0.6)";
    scene.time_stepping.min_step = 1e-3;
    SceneRun run(scene);
    bool is_reported = false, was_reported_before = false;
    try {
      run.finish([&](const NewtonReport &report) {
        is_reported = is_reported || find(report.diagnostics, diagnostic::unsupported_body) != nullptr;
        was_reported_before = was_reported_before || (is_reported && run.control.time() < 0.6);
      });
    } catch (const SolutionFailure &failure) {
      is_reported = std::string(failure.what()).find("has no support at time") != std::string::npos;
    }
    check_here("bodies that lose their contacts afterwards: as without viscous forces",
               is_reported && !was_reported_before && run.control.time() > 0.6 &&
                   !run.problem.equation().parts().stabilisation().get()->acts());
  }
  {
    parameters::Scene scene = read(FacetMethod::overlap);
    // What Newton's method leaves depends on round-off, and so on the ranks; weak modes make it larger.
    scene.solver.force_tolerance = 1e-11;
    scene.solver.linear_solver.value = DirectMethod::klu; // adds up in the same order
    set_way(scene, "-0.35*(t < 0.2 ? 4*t : 0.6 + t)");    // quickly over the gaps
    scene.time_stepping.end_time = 0.36;
    billet::testing::set_fixed_steps(scene, 9);
    const double middle = 0.32;
    bool fades = true;
    billet::testing::test_going_on<ImplicitSolutionRun>(
        "loose bodies", scene, {middle},
        [&](ImplicitSolutionRun &run, const double until, auto &history) {
          run.run(until, history);
          const double factor = run.problem.equation().parts().stabilisation().get()->factor(0);
          if (until == middle)
            fades = fades && factor > 0. && factor < 0.5;
        },
        1e-5);
    check_here("they stop in the middle of the fading", fades);
  }
}

} // namespace loose_bodies_test
