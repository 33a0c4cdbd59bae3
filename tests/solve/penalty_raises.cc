// SPDX-License-Identifier: LGPL-2.1-or-later
// Penalties that rise in static steps: a body that hardly yields is pushed into a floor. It penetrates by
// what its support moves, whatever the penalty.
#include "billet/diagnostic_kinds.h"

#include "../scenes/materials.h"
#include "../scenes/scene_run.h"

#include <deal.II/base/mpi.h>

namespace penalty_raises_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

struct Push {
  double depth;        ///< over what penalties allow, 0.2 facet sizes
  double penalty = 0.; ///< of the scene [E/h]; 0: the default one, 10
  double step = 1.;    ///< length of the first step, over the initial step of the scene
};

struct Raises {
  bool converged;
  std::vector<double> factors;
};

/// Returns the raises of the penalty in the first step.
Raises push(const Push &by) {
  auto parameters = parameters::Scene::read(std::string(SOURCE_DIR) + "/confined_element.prm");
  parameters.bodies[0].supports[0].displacement.value[2] = std::to_string(-0.2 * by.depth / by.step) + "*t";
  testing::set_poisson_ratio(parameters.bodies[0].material, 0.49999999); // 1.7e7 times as stiff as E
  auto &pair = parameters.pairs[0];
  pair.penetration_tolerance = 0.;
  pair.penalty.is_given = by.penalty > 0.;
  if (pair.penalty.is_given)
    pair.penalty.normal = by.penalty;
  parameters.time_stepping.initial_step = 1.;
  SceneRun run(parameters);
  const NewtonReport report = run.problem.step(by.step, 0.);
  Raises raises{report.converged, {}};
  for (const Diagnostic &message : report.diagnostics)
    if (&message.kind() == &diagnostic::penalty_raised)
      raises.factors.push_back(message.values().front().second);
  return raises;
}

/// The factor of the first raise, 1 without one.
double first(const Push &by) {
  const Raises raises = push(by);
  return raises.factors.empty() ? 1. : raises.factors[0];
}

} // namespace

BILLET_MPI_TEST(penalty_raises) {
  check("penetration above what is allowed raises penalties, by twice the ratio in whole octaves",
        first({0.98}) == 1. && first({1.02}) == 2. && first({1.98}) == 2. && first({2.02}) == 4.);
  check("by a factor of 8 at most", first({3.9}) == 4. && first({4.1}) == 8. && first({8.2}) == 8.);
  // They rise to 1000 E/h, if an octave is left.
  check("and of 2 at least", first({4.1, 490.}) == 2. && first({4.1, 510.}) == 1.);
  check("a penalty of the scene stays up to 3.6 times that",
        first({3.55, 1.}) == 1. && first({3.65, 1.}) > 1.);
  check("unless steps are shorter than a hundredth of the first",
        first({1.1, 1., 0.0102}) == 1. && first({1.1, 1., 0.0098}) == 2.);
  // Here raises do not help.
  const Raises by_default = push({1.1}), of_scene = push({1.1, 1., 0.0098});
  check("six raises in a step exhaust a default penalty",
        by_default.converged && by_default.factors.size() == 6);
  check("there are no more for a lower one", !of_scene.converged && of_scene.factors.size() == 6);
}

} // namespace penalty_raises_test
