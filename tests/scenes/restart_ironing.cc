// SPDX-License-Identifier: LGPL-2.1-or-later
// Ironing that stops while the die is drawn, and goes on, as in restart.cc, on a coarser mesh and a shorter
// way than prm/ironing.prm: facet against facet until the die has lifted off, and nodes against facets in two
// passes.
#include "restart_run.h"

#include <deal.II/base/mpi.h>

namespace restart_ironing_test {

using namespace billet;
using billet::testing::check;
using billet::testing::History;

namespace {

const auto until_then = [](auto &run, const double time, History &history) { run.run(time, history); };

/// Pressed until 1, drawn by 2.5 mm until 1.5, lifted until 2.
parameters::Scene read_scene() {
  parameters::Scene scene = testing::read_shipped_scene("ironing.prm");
  for (auto &body : scene.bodies)
    body.mesh.arguments = body.name == "slab" ? "16, 1, 4 : 0, 0, 0 : 12, 0.5, 3 : true"
                                              : "7, 1, 3 : -2, 0, 0 : 2, 0.5, 1.5 : true";
  for (auto &amplitude : scene.amplitudes)
    if (amplitude.name == "down")
      amplitude.times = {0., 1., 1.5, 2.};
    else {
      amplitude.times = {1., 1.5};
      amplitude.values = {0., 2.5};
    }
  scene.time_stepping.stops = {1., 1.5};
  scene.time_stepping.end_time = 2.;
  return scene;
}

void test(const std::string &name, parameters::Scene scene) {
  scene.solver.force_tolerance = 1e-11; // what Newton's method leaves depends on the ranks
  scene.time_stepping.control = parameters::TimeStepping::Control::fixed;
  scene.time_stepping.initial_step = 0.1;
  testing::on_ranks(1, [&](MPI_Comm some) {
    testing::ImplicitSolutionRun run(scene, some);
    History ignored;
    run.run(1.3, ignored);
    bool slips = false;
    const auto reports = run.problem.report_contacts();
    for (const auto &node : reports[0])
      slips = slips || node.status == ContactStatus::slip;
    check(name + ": it is drawn", slips && run.problem.state().energies.friction > 0.);
    run.run(scene.time_stepping.end_time, ignored);
    if (scene.time_stepping.end_time > 1.5)
      check(name + ": it has lifted off", run.problem.state().body_pair_loads[0].force.norm() == 0.);
  });
  testing::test_going_on<testing::ImplicitSolutionRun>(name, scene, {1.3}, until_then);
}

} // namespace

BILLET_MPI_TEST(restart_ironing) {
  if (testing::n_ranks() == 1) // with iterations, on which steps and the tolerance depend, as they come
    testing::test_going_on<testing::ImplicitSolutionRun>("Steps as they come", read_scene(), {0.5, 1.3, 1.7},
                                                         until_then);
  test("Overlap", read_scene());
  parameters::Scene nodes = read_scene();
  nodes.pairs[0].facets.method.value = FacetMethod::planed;
  // In the first step of lifting, friction turns round, and round-off chooses between two solutions whose
  // forces differ by 1e-4.
  nodes.time_stepping.end_time = 1.5;
  nodes.time_stepping.stops = {1.};
  test("Planed, two passes", nodes);
}

} // namespace restart_ironing_test
