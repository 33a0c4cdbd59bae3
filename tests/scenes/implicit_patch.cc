// SPDX-License-Identifier: LGPL-2.1-or-later
// Patch test in statics with overlapping facets: meshes that do not match, distorted by 30 % and turned, pass
// on a uniform stress to round-off, whatever the penalty, the passes and the augmentation; and it is that of
// the closed form with the penetration p/k. A block with an inclined cut that friction holds comes as close
// to that as penalties are stiff, or as augmentation is asked to. Lifted, neither keeps a stress.
#include "unloaded.h"

#include <deal.II/base/mpi.h>

#include <iomanip>
#include <sstream>

namespace implicit_patch_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;
using dealii::SymmetricTensor;

namespace {

std::string print(const double number) {
  std::ostringstream out;
  out << number;
  return out.str();
}
std::string print_exactly(const double number) {
  std::ostringstream out;
  out << std::setprecision(17) << number;
  return out.str();
}

constexpr double E = 2e5, edge = 0.5;

/// Largest difference of an element's stress from `exact`, relative to that.
double stress_error(const SceneRun &run, const SymmetricTensor<2, 3> &exact) {
  testing::WorstError worst;
  for (unsigned int body = 0; body < 2; ++body)
    for (const auto &element : run.problem.summarize(body))
      worst.add((element.cauchy_stress - exact).norm() / exact.norm());
  return worst.value();
}

/// Uniaxial strain of Hencky's law along n: τ = (λ + 2μ) ln s and λ ln s across, σ = τ/s, where the stretch s
/// of 4 mm and the penetration −σ/k make up the travel.
SymmetricTensor<2, 3> exact_stress(const dealii::Tensor<1, 3> &n, const double nu, const double travel,
                                   const double penalty) {
  const double lame = E * nu / (1. + nu) / (1. - 2. * nu), along = lame + E / (1. + nu);
  double low = 0.9, high = 1.;
  for (unsigned int i = 0; i < 100; ++i) {
    const double s = 0.5 * (low + high), penetration = penalty > 0. ? -along * std::log(s) / s / penalty : 0.;
    (4. * (1. - s) + penetration > travel ? low : high) = s;
  }
  SymmetricTensor<2, 3> stress;
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = i; j < 3; ++j)
      stress[i][j] = std::log(low) / low * ((i == j ? lame : 0.) + (along - lame) * n[i] * n[j]);
  return stress;
}

/// Presses until 1, then lifts by two fifths of the travel, in steps of a half.
void test_unloading(const std::string &name, parameters::Scene scene, const double travel,
                    const dealii::Tensor<1, 3> &direction) {
  for (unsigned int i = 0; i < 3; ++i)
    scene.bodies[1].supports[0].displacement.value[i] =
        print_exactly(travel * direction[i]) + "*(t < 1 ? t : 2.4 - 1.4*t)";
  scene.time_stepping.end_time = 2.;
  SceneRun run(scene);
  double stored = 0., in_springs = 0., taken_while_pressed = 0.;
  run.finish([&](const NewtonReport &) {
    const SolutionState &state = run.problem.state();
    stored = std::max(stored, state.energies.elastic);
    if (state.time < 1.8) {
      check(name + " at " + print(state.time) + ": it is pressed",
            state.body_pair_loads[0].force.norm() > 0.);
      in_springs = state.energies.contact;
      taken_while_pressed = state.energies.friction;
    }
  });
  testing::check_unloaded(name + ": ", run, stored);
  check(name + ": nothing has slipped", taken_while_pressed / stored, 1e-10);
  const double released = run.problem.state().energies.friction;
  check(name + ": at most what springs held is released when it lifts",
        released >= 0. && released <= in_springs);
}

} // namespace

BILLET_MPI_TEST(implicit_patch) {
  const dealii::Tensor<1, 3> n({2. / 3., -1. / 3., 2. / 3.});
  const auto turned = testing::read_shipped_scene("patch_test.prm");
  using Passes = parameters::ContactPair::Passes;
  using Facets = FacetMethod;
  for (const auto passes : {Passes::one, Passes::two}) {
    const std::string name = passes == Passes::one ? "one pass" : "two passes";
    for (const double factor : {0.2, 100., 1e4}) { // with 0.1 nodes go so deep that it is raised
      auto scene = turned;
      scene.pairs[0].facets.passes = passes;
      scene.pairs[0].penalty.normal = factor * E / edge;
      SceneRun run(scene);
      run.finish();
      check(name + ", penalty " + print(factor) + " E/h",
            stress_error(run, exact_stress(n, 0.3, 0.2, scene.pairs[0].penalty.normal)), 1e-8);
    }
    {
      const double factor = passes == Passes::one ? 1. : 100.;
      auto scene = turned;
      scene.pairs[0].facets.passes = passes;
      scene.pairs[0].penalty.normal = factor * E / edge;
      scene.pairs[0].penetration_tolerance = 1e-9;
      scene.solver.max_augmentations = 100;
      SceneRun run(scene);
      run.finish();
      check(name + ", augmented, " + print(factor) + " E/h", stress_error(run, exact_stress(n, 0.3, 0.2, 0.)),
            1e-8);
    }
  }

  // Where the upper part begins as deep in the lower one as it likes, that depth counts as none.
  for (const auto facets : {Facets::overlap, Facets::planed}) {
    auto scene = turned;
    scene.pairs[0].facets.method.value = facets;
    scene.pairs[0].facets.passes = Passes::one;
    scene.pairs[0].initial.may_overlap = true;
    scene.pairs[0].initial.ramp_time = 0.;
    scene.bodies[1].mesh.translation -= 0.01 * n;
    const std::string name = facets == Facets::overlap ? "overlap" : "planed";
    if (facets == Facets::overlap) {
      SceneRun run(scene);
      run.finish();
      check(name + ", shifted", stress_error(run, exact_stress(n, 0.3, 0.2, scene.pairs[0].penalty.normal)),
            1e-8);
    }
    for (auto &displacement : scene.bodies[1].supports[0].displacement.value)
      displacement = "0";
    SceneRun run(scene);
    run.finish();
    check(name + ", shifted, not moved", run.problem.state().body_pair_loads[0].force.norm(), 1e-12 * E);
  }

  // The upper part is displaced by s along the cut, and is not below, or above, the other one at its ends.
  const auto cut = testing::read_shipped_scene("patch_test_cut.prm");
  for (const double factor : {1., 100., 1e4}) {
    auto scene = cut;
    scene.pairs[0].penalty.normal = scene.pairs[0].penalty.tangential = factor * E / edge;
    SceneRun run(scene);
    run.finish();
    // Vertical tractions on an inclined area, so that the vertical spring is stiffer.
    const auto exact = exact_stress(dealii::Tensor<1, 3>({0., 0., 1.}), 0., 0.004,
                                    scene.pairs[0].penalty.normal * std::hypot(1., 0.3));
    check("inclined cut, penalty " + print(factor) + " E/h", stress_error(run, exact),
          run.problem.state().body_pair_loads[0].deepest / edge);
    check("inclined cut sticks, penalty " + print(factor) + " E/h",
          run.problem.state().energies.friction / run.problem.state().energies.elastic, 1e-10);
  }
  // What augmentation leaves, along the cut too, in each of two steps, is part of the travel: of the upper
  // part's facets, which are slaves.
  constexpr double slave_edge = 2. / 3.;
  for (const double factor : {1., 100.}) {
    auto scene = cut;
    scene.pairs[0].penalty.normal = scene.pairs[0].penalty.tangential = factor * E / edge;
    scene.pairs[0].penetration_tolerance = 1e-6;
    scene.solver.max_augmentations = 100;
    SceneRun run(scene);
    run.finish();
    check("inclined cut, augmented, " + print(factor) + " E/h",
          stress_error(run, exact_stress(dealii::Tensor<1, 3>({0., 0., 1.}), 0., 0.004, 0.)),
          2. * 1e-6 * slave_edge / 0.004);
  }

  for (const auto facets : {Facets::overlap, Facets::planed}) {
    const std::string name = facets == Facets::overlap ? "overlap" : "planed";
    auto scene = turned;
    scene.pairs[0].facets.method.value = facets;
    test_unloading("turned block, " + name, scene, 0.2, -n);
    scene = cut;
    scene.pairs[0].facets.method.value = facets;
    test_unloading("inclined cut, " + name, scene, 0.004, dealii::Tensor<1, 3>({0., 0., -1.}));
  }
  auto augmented = turned;
  augmented.pairs[0].penetration_tolerance = 1e-6;
  test_unloading("turned block, augmented", augmented, 0.2, -n);
}

} // namespace implicit_patch_test
