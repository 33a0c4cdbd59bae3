// SPDX-License-Identifier: LGPL-2.1-or-later
// Penalties that are far too low or far too high, and matrices that lose most digits, are reported; others
// are not.
#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"
#include "materials.h"
#include "scene_run.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <string>

namespace penalty_watch_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

/// How many steps of a run with this penalty factor of the pair have a message of each kind: penalty too low,
/// round-off (of contact: at the end, a note where it is little), ill-conditioned.
std::array<unsigned int, 3> count(const std::string &scene, const double factor,
                                  const double modulus_ratio = 1., const double force_tolerance = 1e-6) {
  auto parameters = testing::read_shipped_scene(scene);
  parameters.pairs[0].penalty.unit = parameters::ContactPair::PenaltyUnit::factor;
  parameters.pairs[0].penalty.normal = parameters.pairs[0].penalty.tangential = factor;
  testing::set_young_modulus(parameters.bodies[0].material,
                             modulus_ratio * testing::young_modulus(parameters.bodies[0].material));
  parameters.time_stepping.end_time = scene == "billet_upsetting.prm" ? 0.2 : 1.;
  parameters.solver.force_tolerance = force_tolerance;
  SceneRun run(parameters);
  std::array<unsigned int, 3> n{};
  const auto inspect = [&](const NewtonReport &report) {
    // A penalty that is much too low is warned about.
    n[0] += find(report.diagnostics, diagnostic::penalty_too_low) != nullptr ? 1 : 0;
    n[1] += find(report.diagnostics, diagnostic::round_off_limits_forces) != nullptr ? 1 : 0;
    n[2] += find(report.diagnostics, diagnostic::ill_conditioned) != nullptr ? 1 : 0;
  };
  try {
    run.finish(inspect);
  } catch (const SolutionFailure &failure) { // nodes are deeper than contact follows them
    if (std::string(failure.what()).find("a larger 'Normal penalty'") == std::string::npos)
      throw;
    ++n[0];
  }
  const DiagnosticList messages = run.problem.finish();
  n[1] += find(messages, diagnostic::balanced_to_round_off) != nullptr ||
                  find(messages, diagnostic::round_off_limits_forces) != nullptr
              ? 1
              : 0;
  return n;
}

} // namespace

BILLET_MPI_TEST(penalty_watch) {
  using Counts = std::array<unsigned int, 3>;
  for (const std::string scene : {"billet_upsetting.prm", "patch_test.prm"}) {
    check(scene + ": nothing is said of the usual", count(scene, 10.) == Counts{});
    check(scene + ": too soft", count(scene, 1e-4)[0] >= 1);
    check(scene + ": too stiff", count(scene, 1e6, 1., 1e-11)[1] >= 1);
  }
  check("a body a million million times as stiff", count("patch_test.prm", 10., 1e13)[2] == 1);
}

} // namespace penalty_watch_test
