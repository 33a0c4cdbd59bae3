// SPDX-License-Identifier: LGPL-2.1-or-later
// Tools that make one face press like one: where another goes on, pressure does not fade beyond a border.
#include "tangent_check.h"

#include <deal.II/base/mpi.h>

namespace flush_tools_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

parameters::Scene read() {
  parameters::Scene scene = parameters::Scene::read(std::string(SOURCE_DIR) + "/flush_tools.prm");
  scene.solver.force_tolerance = 1e-10;
  return scene;
}

} // namespace

BILLET_MPI_TEST(flush_tools) {
  SceneRun both(read());
  both.finish();
  const auto &loads = both.problem.state().tool_loads;
  parameters::Scene whole = read();
  const std::string flat = "set Normal = 0, 0, -1\nset Direction = 1, 0, 0\nset Length = 9\nset Width = 4\n";
  whole.tools[0].surface = testing::make_surface("rectangle", flat + "set Centre = 0, 0, 2");
  whole.tools[1].surface = testing::make_surface("rectangle", flat + "set Centre = 20, 0, 2");
  SceneRun one(whole);
  one.finish();
  const auto &alone = one.problem.state().tool_loads;
  check("the face presses", alone[0].force.norm() > 1. && alone[1].force.norm() == 0.);
  check("two tools press like one", (loads[0].force + loads[1].force - alone[0].force).norm(),
        1e-8 * alone[0].force.norm());
  check("neither pushes sideways", std::hypot(loads[0].force[0], loads[1].force[0]),
        1e-8 * alone[0].force.norm());
}

} // namespace flush_tools_test
