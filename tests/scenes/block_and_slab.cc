// SPDX-License-Identifier: LGPL-2.1-or-later
// Blocks that land on the end of a slab, where nodes come in beside its end face, keep their energy; and the
// search's margin changes nothing.
#include "explicit_run.h"

#include <deal.II/base/mpi.h>

namespace block_and_slab_test {

using namespace billet;
using billet::testing::check;

namespace {

parameters::Scene make_scene(const double x, const double gap, const std::string &v_x, const std::string &v_z,
                             const double end) {
  parameters::Scene scene = testing::read_test_scene("block_and_slab.prm");
  scene.bodies[1].mesh.translation[0] = x;
  scene.bodies[1].mesh.translation[2] = 0.01 + gap;
  scene.bodies[1].initial_velocity.value = {v_x, "0", v_z};
  scene.time_stepping.end_time = end;
  return scene;
}

void test_end(const std::string &name, const parameters::Scene &scene) {
  testing::ExplicitRun run(scene);
  double force = 0.;
  run.finish(0.01 * scene.time_stepping.end_time, [&] {
    for (const auto &load : run.state().body_pair_loads)
      force = std::max(force, load.force.norm());
  });
  check(name + ": they touch", force > 100.);
  check(name + ": energy", run.worst_drift, 0.01);
}

void test_margin() {
  std::vector<Vector> displacements;
  for (const double margin : {0.01, 0.1, 0.5, 2.}) {
    parameters::Scene scene = make_scene(0.0117, 5e-4, "0", "-50", 1e-4);
    scene.pairs[0].facets.search_margin = margin;
    testing::ExplicitRun run(scene);
    run.finish(1e-4, [] {});
    displacements.push_back(run.state().displacements);
  }
  for (std::size_t i = 1; i < displacements.size(); ++i) {
    displacements[i] -= displacements[0];
    check("search margin: the same bits", displacements[i].linfty_norm(), 0.);
  }
}

} // namespace

BILLET_MPI_TEST(block_and_slab) {
  test_end("block that flies onto the end", make_scene(-0.0145, 5e-4, "50", "-3", 5e-4));
  test_end("block that lands half beside the end", make_scene(-0.0057, 1e-4, "0", "-3", 2e-4));
  test_margin();
}

} // namespace block_and_slab_test
