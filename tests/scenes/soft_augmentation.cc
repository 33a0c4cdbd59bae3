// SPDX-License-Identifier: LGPL-2.1-or-later
// Augmented contact does not depend on the penalty that it begins with, and where it cannot have what is
// asked for it says so before the last augmentation.
#include "scene_run.h"

#include <deal.II/base/mpi.h>

namespace soft_augmentation_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

struct Outcome {
  dealii::Tensor<1, 3> force;
  unsigned int n_iterations;
};

parameters::Scene read(const std::string &scene, const double factor, const double tolerance) {
  auto parameters = testing::read_shipped_scene(scene);
  for (auto &pair : parameters.pairs) {
    pair.penalty.unit = parameters::ContactPair::PenaltyUnit::factor;
    pair.penalty.normal = pair.penalty.tangential = factor;
    pair.penetration_tolerance = tolerance;
  }
  if (scene == "billet_upsetting.prm")
    parameters.time_stepping.end_time *= 0.1;
  return parameters;
}

Outcome press(const std::string &scene, const double factor, const double tolerance) {
  SceneRun run(read(scene, factor, tolerance));
  run.finish();
  const auto &state = run.problem.state();
  return {state.tool_loads.empty() ? state.body_pair_loads.at(0).force : state.tool_loads[0].force,
          run.n_iterations};
}

/// Why the first step fails.
std::string fail(const double tolerance, const unsigned int maximum) {
  auto parameters = read("billet_upsetting.prm", 10., tolerance);
  parameters.solver.max_augmentations = maximum;
  SceneRun run(parameters);
  return run.problem.step(parameters.time_stepping.initial_step, 0.).failure;
}

} // namespace

BILLET_MPI_TEST(soft_augmentation) {
  for (const std::string scene : {"billet_upsetting.prm", "patch_test.prm"}) {
    const Outcome usual = press(scene, 10., 1e-4);
    for (const double factor : {1e-3, 0.1, 1e7}) {
      const Outcome soft = press(scene, factor, 1e-4);
      std::ostringstream name;
      name << scene << ": a penalty of " << factor << " E/h";
      check(name.str() + " gives the same force", (soft.force - usual.force).norm(),
            2e-3 * usual.force.norm());
      check(name.str() + " takes at most twice the iterations", soft.n_iterations <= 2 * usual.n_iterations);
    }
  }
  const std::string hopeless = fail(1e-18, 1000);
  check("less than round-off is given up", hopeless.find("no longer falls") != std::string::npos ||
                                               hopeless.find("At the present rate") != std::string::npos);
  check("with numbers that are some", hopeless.find("inf") == std::string::npos);
  check("and not after all augmentations", hopeless.find("after 1000") == std::string::npos);
}

} // namespace soft_augmentation_test
