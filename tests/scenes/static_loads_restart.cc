// SPDX-License-Identifier: LGPL-2.1-or-later
// A static scene with every kind of load stops and goes on: what follows is the same bit by bit, the work of
// the loads included.
#include "restart_run.h"

#include "../loads/make_load.h"

#include <deal.II/base/mpi.h>

namespace static_loads_restart_test {

using namespace billet;

namespace {

parameters::Scene make_scene() {
  parameters::Scene scene = testing::read_test_scene("block_on_plane.prm");
  scene.tools.clear();
  scene.pairs.clear();
  auto &body = scene.bodies[0];
  body.material.density.value = 1.;
  body.supports[0].displacement.value = {"0", "0", "0.001*t"};
  for (const auto &[type, lines] : std::initializer_list<std::array<std::string, 2>>{
           {"acceleration", "set Acceleration = 0.1 ; 0 ; -t"},
           {"body force", "set Body force = 1 ; 2*t ; 3"},
           {"pressure",
            "set Boundary ids = 0\nset Pressure = 2*t*(1 + x)\nset Until = 0.6\nset Fade time = 0.5"},
           {"dead traction", "set Boundary ids = 2\nset Traction = 1 ; t ; 2\nset From = 0.3"},
           {"spring", "set Boundary ids = 1\nset Stiffness = 30"},
           {"dashpot", "set Boundary ids = 3\nset Damping = 30"},
           {"force", "set Point = 0.3, 0.4, 0.5\nset Force = 0.1 ; 0.2*t ; 0.3"},
           {"moment", "set Boundary ids = 4\nset Moment = 0.2 ; 0.3*t ; 0.1"}})
    body.loads.push_back(testing::make_load(type, lines));
  scene.time_stepping.end_time = 1.5;
  scene.time_stepping.initial_step = 0.1;
  return scene;
}

} // namespace

BILLET_MPI_TEST(static_loads_restart) {
  testing::test_going_on<testing::ImplicitSolutionRun>(
      "Loads", make_scene(), {0.5, 0.9},
      [](auto &run, const double time, testing::History &history) { run.run(time, history); });
}

} // namespace static_loads_restart_test
