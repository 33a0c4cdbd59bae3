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
using billet::testing::near;
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
  /// The factor by which the penalty has risen.
  double stiffening(const std::size_t contact = 0) const {
    return run->problem.equation().parts().contacts()[contact].penalties().stiffening();
  }
};
double stiffening(const parameters::Scene &parameters) { return Pressed(parameters).stiffening(); }
double stiffening(const Spring &spring) { return stiffening(read(spring)); }

/// Of pairs with a tolerance.
void check_pace() {
  constexpr double tolerance = 1e-9;
  check("penalties rise where an augmentation leaves a quarter of the gap",
        stiffening({3.2, 0.245, tolerance}) == 1. && stiffening({3.2, 0.255, tolerance}) == 2.);
  // With 4 k the gap of K = 4/9 k would be a tenth.
  check("so that a tenth is left, in whole octaves",
        stiffening({2.4, 3.9 / 12.9, tolerance}) == 2. && stiffening({2.4, 4.1 / 13.1, tolerance}) == 4.);
  const Pressed hopeless({501., 0.8, tolerance, 20});
  check("it ends after twice five augmentations if it cannot get there",
        !hopeless.report.converged && hopeless.report.failure.find("after 10 augmentations") == 0);
}

/// Of pairs without one.
void check_softness() {
  check("against a tool they rise to 1000 E/h, if an octave is left",
        stiffening({490., 0.96, {}}) > 1. && stiffening({510., 0.96, {}}) == 1.);
  check("against one that confines a body to 1e5 E/h",
        stiffening({1e5 / 130., 0.985, {}}) == 128. && stiffening({1e5 / 126., 0.985, {}}) == 64.);
  check("which is a body that gives way by a fiftieth",
        stiffening({501., 0.978, {}}) == 1. && stiffening({501., 0.982, {}}) == 128.);
  const Spring soft{501., 0.8, {}};
  const Pressed six(soft);
  check("there are six augmentations for softness",
        near(six.run->load().force[2], young * soft.stiffness() * motion * (1. - std::pow(soft.left, 7.)),
             1e-3));
}

/// The factor by which the penalty of such a spring rises if this part of the force of another pair of the
/// scene, over 1e-2, is missing after two augmentations.
double stiffening_beside_another(const Spring &spring, const double missing) {
  const Spring firm{10., 1. / 11., {}};
  auto parameters = read(firm);
  parameters.bodies.push_back(parameters.bodies[0]);
  parameters.bodies.back().name = "other";
  // With n = K/(K + k), the second one leaves K d n² (1 − n) of the one, and has closed 1 − n³ of K d of the
  // other. After the first one, less is missing than was expected: the pace is not known yet.
  const double young_of_other = young * missing * 0.01 * firm.stiffness() * (1. - std::pow(firm.left, 3.)) /
                                (spring.stiffness() * std::pow(spring.left, 2.) * (1. - spring.left));
  testing::set_elasticity(parameters.bodies.back().material, parameters.bodies[0].material.law->name(),
                          young_of_other, poisson_ratio(spring.stiffness()));
  parameters.pairs.push_back(parameters.pairs[0]);
  auto &pair = parameters.pairs.back();
  pair.name = "foot of other";
  pair.body.value = "other";
  pair.penalty.normal = spring.penalty;
  return Pressed(parameters).stiffening(1);
}

/// A pair with little force counts with a hundredth of the largest one, of which 0.002 may be missing.
void check_confined() {
  const Spring confined{501., 0.985, {}};
  check("a body counts as confined if 100 times what is allowed is missing",
        stiffening_beside_another(confined, 0.204) > 1. && stiffening_beside_another(confined, 0.196) == 1.);
}

/// Returns the factor by which the penalty rises if the element lies on a held one in place of the tool. From
/// the second augmentation on, the secant quadruples multiplier offsets, so that 1 - 4 (1 - n) of the gap is
/// left, n = K/(K + k).
double stiffening_between_bodies(const Spring &spring) {
  auto parameters = read(spring);
  parameters::Body held = parameters.bodies[0];
  held.name = "held";
  held.mesh.arguments = "1, 1, 1 : 0, 0, -1 : 1, 1, 0 : true";
  held.supports[0].boundary_ids.value = {4, 5};
  held.supports[0].components = {true, true, true};
  held.supports[0].displacement.value = {"0", "0", "0"};
  parameters.bodies.push_back(held);
  parameters.tools.clear();
  auto &pair = parameters.pairs[0];
  pair.tool.value.clear();
  pair.second_body.value = held.name;
  pair.second_boundary_ids.value = {5};
  pair.facets.method.value = FacetMethod::planed;
  pair.facets.passes = parameters::ContactPair::Passes::one;
  pair.penalty.of = parameters::ContactPair::PenaltyOf::stiffer;
  return stiffening(parameters);
}

/// The second augmentation adds nearly four times the spring force of either body, and springs keep 0.908 or
/// 0.892 of it at the third one. The first one adds less than 0.98 of it.
void check_secant() {
  check("an extrapolated augmentation shows a confined body if springs keep nine tenths of their force",
        stiffening_between_bodies({501., 0.977, {}}) > 1. &&
            stiffening_between_bodies({501., 0.973, {}}) == 1.);
}

/// Newton iterations of the first equilibria, by the residuals from which they start, at this tolerance of
/// forces. Iterations reduce a residual by much more than augmentations do.
std::vector<std::vector<double>> iterations(const double left, const double force_tolerance) {
  auto parameters = read({6., left, 1e-6, 4});
  parameters.bodies[0].supports[0].displacement.value[2] = "-0.01*t"; // so that one iteration is not enough
  parameters.solver.force_tolerance = force_tolerance;
  parameters.solver.energy_tolerance = parameters.solver.displacement_tolerance = 1e6; // forces alone count
  std::vector<std::vector<double>> result;
  for (const NewtonIteration &iteration : Pressed(parameters).report.iterations) {
    if (result.empty() || iteration.force > 0.1 * result.back().back())
      result.emplace_back();
    result.back().push_back(iteration.force);
  }
  return result;
}

/// Returns the factor of the tolerance of forces after so many augmentations: the tolerance is sought at
/// which a second iteration begins.
double accuracy_after(const unsigned int n_augmentations, const double left) {
  double low = 1e-7, high = 0.5, residual = 0.;
  while (high > 1.01 * low) {
    const double middle = std::sqrt(low * high);
    const std::vector<double> of_equilibrium = iterations(left, middle).at(n_augmentations);
    if (of_equilibrium.size() > 1) {
      low = middle;
      residual = of_equilibrium[1];
    } else
      high = middle;
  }
  return residual / low;
}

void check_accuracy() {
  const auto is = [](const double factor, const double expected) { return near(factor, expected, 0.03); };
  check("residuals stay as allowed where augmentations leave less than half of the gap",
        is(accuracy_after(2, 0.48), 1.) && is(accuracy_after(4, 0.48), 1.));
  check("they are a tenth of that where one leaves more", is(accuracy_after(2, 0.52), 0.1));
  check("a hundredth after two", is(accuracy_after(3, 0.52), 0.01));
  check("and no less after three", is(accuracy_after(4, 0.52), 0.01));
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
  check_pace();
  check_softness();
  check_confined();
  check_secant();
  check_accuracy();
  check("a warning is printed if forces still change by 0.5 %",
        finish(0.0051).size() == 1 && finish(0.0049).empty());
}

} // namespace augmentation_test
