// SPDX-License-Identifier: LGPL-2.1-or-later
// Scenes with every kind of load on nodes, which begin, end and fade, stop and go on in every scheme: what
// follows is the same bit by bit, the work of the loads included. They also stop where loads begin and end.
#include "restart_run.h"

#include "../loads/make_load.h"

#include <deal.II/base/mpi.h>

namespace node_loads_restart_test {

using namespace billet;

namespace {

/// Returns a block under loads on nodes.
parameters::Scene make_scene(const parameters::TimeStepping::Scheme scheme) {
  parameters::Scene scene = testing::read_test_scene("block_on_plane.prm");
  scene.tools.clear();
  scene.pairs.clear();
  auto &body = scene.bodies[0];
  body.material.density.value = 1.;
  body.supports[0].displacement.value = {"0", "0", "0"};
  const std::string corners = "set Nodes = at 0, 0, 0 ; at 1, 0, 0 ; at 1, 1, 0\n";
  const std::string edge = "set Nodes = on line 0, 1, 0 : 1, 1, 0\n", side = "set Nodes = at 0.5, 0, 0.5\n";
  for (const auto &[type, lines] : std::initializer_list<std::array<std::string, 2>>{
           {"force",
            edge + "set Force = 0.1 ; 0.2*t ; 0.3\nset From = 0.3\nset Until = 0.6\nset Fade time = 0.5"},
           {"moment", corners + "set Moment = 0.2 ; 0.3*t ; 0.1\nset Until = 0.9\nset Fade time = 0.3"},
           {"spring", edge + "set Stiffness = 30\nset From = 0.3"},
           {"dashpot", side + "set Damping = 3\nset Direction = 1, 0, 0"},
           {"spring", side + "set Stiffness = 20\nset Until = 0.6\nset Fade time = 0.2"}})
    body.loads.push_back(testing::make_load(type, lines));
  scene.time_stepping.scheme = scheme;
  scene.time_stepping.end_time = 1.5;
  scene.time_stepping.initial_step = 0.1;
  return scene;
}

} // namespace

BILLET_MPI_TEST(node_loads_restart) {
  using Scheme = parameters::TimeStepping::Scheme;
  const std::vector<double> stops{0.3, 0.5, 0.6, 0.9, 1.};
  for (const auto &[name, scheme] : std::initializer_list<std::pair<std::string, Scheme>>{
           {"Static", Scheme::quasi_static}, {"Implicit dynamics", Scheme::implicit_dynamics}})
    testing::test_going_on<testing::ImplicitSolutionRun>(
        name, make_scene(scheme), stops,
        [](auto &run, const double time, testing::History &history) { run.run(time, history); });
  testing::test_going_on<testing::ExplicitStops>(
      "Explicit", make_scene(Scheme::explicit_dynamics), stops,
      [](auto &run, const double time, testing::History &history) { run.run(time, 1, history); });
}

} // namespace node_loads_restart_test
