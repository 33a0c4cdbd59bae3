// SPDX-License-Identifier: LGPL-2.1-or-later
// Nodes beyond the border of a tool's surface, where pressure fades: the exact tangent against central
// differences of the residual.
#include "tangent_check.h"

#include <deal.II/base/mpi.h>

namespace tool_borders_test {

using namespace billet;
using billet::testing::check;
using billet::testing::make_curved;
using billet::testing::SceneRun;
using billet::testing::tangent_error;

namespace {

unsigned int count_fading(const SceneRun &run) {
  unsigned int n_fading = 0;
  const Tool &tool = run.scene.tools()[0];
  const auto &state = run.problem.state();
  for (const auto &node : run.problem.equation().parts().contacts().of_tools()[0].measures().report()) {
    if (node.status == ContactStatus::open)
      continue;
    for (const auto &element : run.discretization.elements(0))
      for (const unsigned int v : element.cell->vertex_indices()) {
        if (element.dofs[std::size_t{3} * v] != node.dofs[0])
          continue;
        dealii::Tensor<1, 3> x = element.cell->vertex(v);
        for (unsigned int i = 0; i < 3; ++i)
          x[i] += state.displacements(element.dofs[3 * v + i]);
        n_fading += tool.surface().project(state.placements[0].to_tool(x)).exists ? 0 : 1;
      }
  }
  return n_fading;
}

/// Nodes that stick stay near the smaller surface's border, those that slide come to the larger one's.
void check_edge(const std::string &name, const testing::SurfacePart &small,
                const testing::SurfacePart &large) {
  for (const double friction : {0.8, 0.03, 0.}) {
    const std::string state = friction > 0.5  ? ", much friction"
                              : friction > 0. ? ", little friction"
                                              : ", no friction";
    parameters::Scene scene = make_curved(friction > 0.5 ? small : large, friction);
    // Not so deep that edges give way with a jerk.
    scene.bodies[0].supports[0].displacement.value = {"0.02*t", "0.015*t - 0.01*z*t", "-0.012*t"};
    scene.tools[0].motion.translation.value = {"0", "0", "0.001*t"};
    scene.tools[0].motion.rotation_angle.value = "0.01*t";
    scene.solver.contact_tangent = parameters::ContactTangent::exact;
    SceneRun run(scene);
    check(name + state + ": exact tangent", tangent_error(run, 0.75, 3), 1e-6);
    check(name + state + ": pressure fades at some nodes", count_fading(run) > 0);
  }
}

} // namespace

BILLET_MPI_TEST(tool_borders) {
  const std::string flat = "set Centre = 0.5, 0.5, 0\n",
                    round = "set Centre = 0.5, 0.5, -4.955\nset Radius = 5\n";
  check_edge("rectangle", {"rectangle", flat + "set Length = 0.994\nset Width = 0.994"},
             {"rectangle", flat + "set Length = 1.02\nset Width = 1.02"});
  check_edge("disc", {"disc", flat + "set Radius = 0.703"}, {"disc", flat + "set Radius = 0.72"});
  check_edge("zone of a sphere", {"sphere", round + "set From latitude = 81.92"},
             {"sphere", round + "set From latitude = 81.82"});
}

} // namespace tool_borders_test
