// SPDX-License-Identifier: LGPL-2.1-or-later
// Augmentation of one element of stiffness K that a spring k supports: each augmentation leaves K/(K + k) of
// the gap.
#include "billet/solve/implicit/augmentation.h"

#include "../scenes/materials.h"
#include "../scenes/scene_run.h"

#include <deal.II/base/mpi.h>

#include <cmath>
#include <memory>
#include <optional>

namespace augmentation_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

constexpr double young = 1000., motion = 1e-5; ///< in a step of 1, of an element of size 1

struct Spring {
  double penalty;                  ///< k [E/h]
  double left;                     ///< K/(K + k)
  std::optional<double> tolerance; ///< of the pair [facet sizes]
  unsigned int max_augmentations = 100;

  double stiffness() const { return left / (1. - left) * penalty; } ///< K [E/h]
};

/// Poisson's ratio ν at which (1 − ν)/((1 + ν)(1 − 2ν)) is this.
double poisson_ratio(const double stiffness) {
  const double b = 3. * stiffness - 1.;
  return 0.5 - 1. / (b + std::sqrt(b * b - 4. * stiffness));
}

parameters::Scene read(const Spring &spring) {
  auto parameters = parameters::Scene::read(std::string(SOURCE_DIR) + "/confined_element.prm");
  testing::set_poisson_ratio(parameters.bodies[0].material, poisson_ratio(spring.stiffness()));
  parameters.bodies[0].supports[0].displacement.value[2] = "-1e-5*t";
  auto &pair = parameters.pairs[0];
  pair.penalty.is_given = true;
  pair.penalty.normal = spring.penalty;
  pair.penetration_tolerance = spring.tolerance;
  parameters.solver.max_augmentations = spring.max_augmentations;
  testing::set_fixed_steps(parameters, 1);
  return parameters;
}

struct Pressed {
  std::unique_ptr<SceneRun> run;
  NewtonReport report;

  explicit Pressed(const parameters::Scene &parameters)
      : run(std::make_unique<SceneRun>(parameters)), report(run->problem.step(1., 0.)) {}
  explicit Pressed(const Spring &spring) : Pressed(read(spring)) {}
  /// The part of the force on a rigid support, K d, that is missing.
  double missing(const Spring &spring) const {
    return 1. - run->load().force[2] / (young * spring.stiffness() * motion);
  }
};

/// Without a tolerance it stops somewhere, and has left a whole power of K/(K + k).
void check_powers() {
  const Spring soft{501., 0.8, {}};
  const double power = std::log(Pressed(soft).missing(soft)) / std::log(soft.left);
  check("augmentations leave their powers of the gap", std::abs(power - std::round(power)), 1e-3);
  check("  and there are some", power > 1.5);
}

void check_tolerance() {
  for (const double left : {0.1, 0.6}) {
    const Spring spring{20., left, 1e-9};
    const Pressed pressed(spring);
    check("they go on to the tolerance of the pair",
          pressed.report.converged && std::abs(pressed.missing(spring)) <= 1e-9 / motion);
  }
  const Pressed hopeless({501., 0.8, 1e-9, 20});
  check("a penalty with which they do not get there fails the step, after what the scene allows",
        !hopeless.report.converged && hopeless.report.failure.find("augmentations") != std::string::npos);
}

/// Steps end while augmentation still changes the force by this part.
DiagnosticList finish(const double change) {
  SceneRun run(read({10., 0.5, {}}));
  ImplicitProblem &problem = run.problem.equation();
  EquilibriumSolver solver(problem);
  PenetrationMeasurement measurement(problem);
  Augmentation augmentation(problem, solver, measurement);
  SoftnessLimit softness({SoftnessLimit::Rule::general});
  ContactSprings springs;
  springs.normal.force = 1.;
  springs.normal.held = 0.1;
  softness.learn({springs}, {{SoftnessLimit::Change{change, change}, SoftnessLimit::Change{}}});
  softness.commit({springs});
  augmentation.set_softness(softness);
  return augmentation.finish();
}

} // namespace

BILLET_MPI_TEST(augmentation) {
  check_powers();
  check_tolerance();
  check("a warning is printed if forces still change much", finish(0.1).size() == 1 && finish(1e-5).empty());
}

} // namespace augmentation_test
