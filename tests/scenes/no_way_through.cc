// SPDX-License-Identifier: LGPL-2.1-or-later
// Bodies and tools that would pass through each other: a strip between rolls, in whose support it sinks with
// long steps; blocks that are far apart at the start; a block that flies at a plate; a tool that turns by
// a whole turn. Forces are those of the same scenes with steps of 0.005 of the run, or 0.02 and ten times the
// penalty for the blocks, which deform each other by more than their facets bear at 10 E/h.
#include "scene_run.h"

#include <deal.II/base/mpi.h>

namespace no_way_through_test {

using namespace billet;
using billet::testing::check;
using billet::testing::near;
using billet::testing::SceneRun;

namespace {

parameters::Scene read(const std::string &name) {
  return parameters::Scene::read(std::string(SOURCE_DIR) + "/" + name);
}

/// Of the body's nodes, the least height at the end.
double lowest(const SceneRun &run, const std::size_t body) {
  double minimum = 1e300;
  for (const auto &element : run.discretization.elements(body))
    for (const unsigned int v : element.cell->vertex_indices())
      minimum = std::min(minimum, element.cell->vertex(v)[2] + run.problem.state().displacements(
                                                                   element.cell->vertex_dof_index(v, 2)));
  return minimum;
}

} // namespace

BILLET_MPI_TEST(no_way_through) {
  {
    SceneRun run(read("strip_on_rolls.prm"));
    run.finish();
    check("strip on rolls", near(run.load(0).force[2], 124.05, 0.01));
  }
  for (const bool is_lower_slave : {true, false}) {
    parameters::Scene scene = read("distant_blocks.prm");
    if (!is_lower_slave) {
      auto &pair = scene.pairs[0];
      std::swap(pair.body, pair.second_body);
      std::swap(pair.boundary_ids, pair.second_boundary_ids);
    }
    SceneRun run(scene);
    run.finish();
    check(std::string("distant blocks, slave is the ") + (is_lower_slave ? "lower" : "upper"),
          near(std::abs(run.problem.state().body_pair_loads[0].force[2]), 125.4, 0.01)); // on either side
  }
  {
    SceneRun run(read("block_flies_at_plate.prm"));
    run.finish();
    check("the block has bounced off the plate", lowest(run, 1) > 1.);
  }
  {
    SceneRun run(read("turning_tool.prm"));
    run.finish(); // as with a 'Penetration tolerance' of 1e-5
    check("moment of a tool that turns", near(run.load(0).moment[2], 2667.3, 1e-3));
  }
}

} // namespace no_way_through_test
