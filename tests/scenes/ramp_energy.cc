// SPDX-License-Identifier: LGPL-2.1-or-later
// The ramp of an initial penetration δ(t) presses a block on a floor, a tool or a stiff body. Nothing else
// does work, and nothing moves fast, so that the work of the ramp (A2) is what the block stores. Its mean
// force in a step is that of both ends, and where contact is damped (I4) that of the end alone.
#include "scene_run.h"

#include <deal.II/base/mpi.h>

#include <string>

namespace ramp_energy_test {

using namespace billet;
using billet::testing::check;
using billet::testing::near;
using billet::testing::SceneRun;

namespace {

constexpr double penetration = 0.01, modulus = 1000.;

/// Returns the work of the ramp of a scene, over that on a linear bar.
double find_work(const std::string &scene, const bool is_damped) {
  SceneRun run(testing::read_test_scene(scene));
  ImplicitProblem &problem = run.problem.equation();
  run.finish([&](const NewtonReport & /*report*/) {
    if (is_damped)
      problem.parts().scheme().contact().damp(problem.step().start);
  });
  return run.problem.state().energies.external / (0.5 * modulus * penetration * penetration);
}

} // namespace

BILLET_MPI_TEST(ramp_energy) {
  for (const std::string scene : {"ramp_energy.prm", "ramp_energy_slab.prm"}) {
    // Of Hencky's bar, whose energy is ½ E ln²(1 − δ).
    const double exact = std::pow(std::log(1. - penetration) / penetration, 2);
    for (const bool is_damped : {false, true})
      check(scene + (is_damped ? ", damped" : "") + ": the ramp does the work that the bar stores",
            near(find_work(scene, is_damped), exact, 1e-3));
  }
}

} // namespace ramp_energy_test
