// SPDX-License-Identifier: LGPL-2.1-or-later
// Without friction the billet stays a cylinder, and the press force has a closed form. With the logarithmic
// axial strain ε = ln(1 − reduction), uniaxial stress and yield in Kirchhoff stress, per unit of axial
// plastic strain α:
//   τ = σ_y + H α,  α = |ε| − τ/E,  lateral strain ε_l = ν τ/E + α/2,  force = τ/J π R² exp(2 ε_l),  J =
//   exp(−τ (1 − 2ν)/E).
#include "scene_run.h"

#include <deal.II/base/mpi.h>

namespace frictionless_upsetting_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

double closed_form(const double reduction) {
  const double E = 200e3, nu = 0.3, yield = 700., H = 300., R = 10.;
  const double strain = -std::log(1. - reduction);
  const double tau = (yield + H * strain) / (1. + H / E);
  const double alpha = strain - tau / E;
  const double lateral = nu * tau / E + 0.5 * alpha;
  const double J = std::exp(-tau * (1. - 2. * nu) / E);
  return tau / J * M_PI * R * R * std::exp(2. * lateral);
}

struct Variant {
  unsigned int refinements, layers, steps;
  double penalty;
};

/// Relative errors of the force on the whole billet at 60 % and 64 %, and the relative spread of the plastic
/// strain.
std::array<double, 3> run(const Variant &variant) {
  parameters::Scene parameters = testing::read_shipped_scene("billet_upsetting.prm");
  parameters.pairs[0].friction = nullptr;
  parameters.pairs[0].penalty.normal = variant.penalty;
  parameters.bodies[0].mesh.refinements = variant.refinements;
  parameters.bodies[0].mesh.n_layers = variant.layers;
  testing::set_fixed_steps(parameters, variant.steps);
  parameters.output.interval = 0.9375; // 60 %
  SceneRun scene(parameters);
  std::array<double, 3> errors{1., 1., 1.};
  scene.finish([&](const NewtonReport &) {
    const double time = scene.control.time();
    const double error = std::abs(4. * scene.load().force.norm() / closed_form(0.64 * time) - 1.);
    if (std::abs(time - 0.9375) < 1e-12)
      errors[0] = error;
    if (time == 1.)
      errors[1] = error;
  });
  double minimum = 1e9, maximum = 0.;
  for (const auto &element :
       scene.problem.equation().parts().internal().summarize(0, scene.problem.state().displacements)) {
    minimum = std::min(minimum, element.equivalent_plastic_strain);
    maximum = std::max(maximum, element.equivalent_plastic_strain);
  }
  errors[2] = maximum / minimum - 1.;
  return errors;
}

} // namespace

BILLET_MPI_TEST(frictionless_upsetting) {
  check("closed form at 60 %: 764.53 kN", std::abs(closed_form(0.60) - 764.53e3), 5.);
  check("closed form at 64 %: 877.02 kN", std::abs(closed_form(0.64) - 877.02e3), 5.);

  const double paper = 3.5e5;
  double soft = 0.;
  for (const auto &variant :
       {Variant{1, 5, 10, paper}, {1, 5, 5, paper}, {2, 10, 5, paper}, {1, 3, 80, paper}}) {
    const auto errors = run(variant);
    if (soft == 0.)
      soft = errors[1];
    const std::string name = std::to_string(12 * (variant.refinements == 1 ? 1 : 4) * variant.layers) +
                             " elements, " + std::to_string(variant.steps) + " steps";
    check(name + ", 60 %", errors[0], 1e-3);
    check(name + ", 64 %", errors[1], 1e-3);
    check(name + ", all elements alike", errors[2], 1e-6);
  }
  // The error is the penetration's, and falls with it.
  const double hard = run({1, 5, 10, 10. * paper})[1];
  const double hardest = run({1, 5, 10, 100. * paper})[1];
  check("ten times the penalty, a tenth of the error", std::abs(hard / soft - 0.1), 0.01);
  check("a hundred times the penalty, a hundredth", std::abs(hardest / soft - 0.01), 0.005);
}

} // namespace frictionless_upsetting_test
