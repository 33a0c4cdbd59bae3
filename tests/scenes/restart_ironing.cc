// SPDX-License-Identifier: LGPL-2.1-or-later
// Ironing that stops while the die is drawn, and goes on, as in restart.cc, on a coarser mesh and a shorter
// way than prm/ironing.prm: facet against facet until the die has lifted off, and nodes against facets in two
// passes. On one rank the former is with steps as they come; on several, until the die has been drawn.
#include "restart_run.h"

#include <deal.II/base/mpi.h>

namespace restart_ironing_test {

using namespace billet;
using billet::testing::check;
using billet::testing::History;

namespace {

constexpr double pressed = 0.3, middle = 0.4, drawn = 0.6, lifted = 0.9; ///< times

/// Pressed by 0.3 mm, drawn by 1.5 mm, and lifted.
parameters::Scene read_scene() {
  parameters::Scene scene = testing::read_shipped_scene("ironing.prm");
  for (auto &body : scene.bodies)
    body.mesh.arguments = body.name == "slab" ? "14, 1, 3 : 0, 0, 0 : 12, 0.5, 3 : true"
                                              : "6, 1, 2 : -2, 0, 0 : 2, 0.5, 1.5 : true";
  for (auto &amplitude : scene.amplitudes)
    if (amplitude.name == "down") {
      amplitude.times = {0., pressed, drawn, lifted};
      amplitude.values = {0., -0.3, -0.3, 0.3};
    } else {
      amplitude.times = {pressed, drawn};
      amplitude.values = {0., 1.5};
    }
  scene.time_stepping.stops = {pressed, drawn};
  scene.time_stepping.end_time = lifted;
  scene.time_stepping.initial_step = scene.time_stepping.max_step = 0.1;
  return scene;
}

/// The same, not lifted.
parameters::Scene read_drawn() {
  parameters::Scene scene = read_scene();
  scene.time_stepping.end_time = drawn;
  scene.time_stepping.stops = {pressed};
  return scene;
}

/// Whether it slips where it stops while it is drawn, and whether it touches nothing at the end, are checked,
/// too.
void test_going_on(const std::string &name, const parameters::Scene &scene,
                   const std::vector<double> &stops) {
  bool slips = false, is_off = true;
  testing::test_going_on<testing::ImplicitSolutionRun>(
      name, scene, stops, [&](auto &run, const double time, History &history) {
        run.run(time, history);
        if (time == middle) {
          const auto reports = run.problem.report_contacts();
          for (const auto &node : reports[0])
            slips =
                slips || (node.status == ContactStatus::slip && run.problem.state().energies.friction > 0.);
        }
        if (time == lifted)
          is_off = is_off && run.problem.state().body_pair_loads[0].force.norm() == 0.;
      });
  if (!testing::is_first_rank())
    return;
  check(name + ": it is drawn", slips);
  if (scene.time_stepping.end_time == lifted)
    check(name + ": it has lifted off", is_off);
}

void test_fixed_steps(const std::string &name, parameters::Scene scene) {
  scene.solver.force_tolerance = 1e-11; // what Newton's method leaves depends on the ranks
  scene.time_stepping.control = parameters::TimeStepping::Control::fixed;
  test_going_on(name, scene, {middle});
}

} // namespace

BILLET_MPI_TEST(restart_ironing) {
  if (testing::n_ranks() == 1) // with iterations, on which steps and the tolerance depend, as they come
    test_going_on("Steps as they come", read_scene(), {middle});
  else
    test_fixed_steps("Overlap", read_drawn());
  if (testing::n_ranks() > 1) // nodes against facets go on from ring to ring in restart.cc
    return;
  // In the first step of lifting, friction turns round, and round-off chooses between two solutions whose
  // forces differ by 1e-4.
  parameters::Scene nodes = read_drawn();
  nodes.pairs[0].facets.method.value = FacetMethod::planed;
  test_fixed_steps("Planed, two passes", nodes);
}

} // namespace restart_ironing_test
