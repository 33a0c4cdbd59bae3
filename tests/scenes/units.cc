// SPDX-License-Identifier: LGPL-2.1-or-later
// mm-N-MPa and m-N-Pa give the same steps, the same iterations and the same forces.
#include "materials.h"
#include "scene_run.h"

#include <deal.II/base/mpi.h>

namespace units_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

struct Result {
  std::vector<unsigned int> iterations;
  std::vector<double> forces;
};

Result run(const parameters::Scene &parameters) {
  Result result;
  SceneRun scene(parameters);
  scene.finish([&](const NewtonReport &report) {
    result.iterations.push_back(static_cast<unsigned int>(report.iterations.size()));
    result.forces.push_back(scene.load().force.norm());
  });
  return result;
}

} // namespace

BILLET_MPI_TEST(units) {
  for (const bool absolute : {true, false}) {
    parameters::Scene in_mm = testing::read_shipped_scene("billet_upsetting.prm");
    if (!absolute) {
      in_mm.pairs[0].penalty.unit = parameters::ContactPair::PenaltyUnit::factor;
      in_mm.pairs[0].penalty.normal = in_mm.pairs[0].penalty.tangential = 5.;
    }
    parameters::Scene in_m = in_mm;
    auto &body = in_m.bodies[0];
    body.mesh.scale = 1e-3;
    LinearHardening hardening = testing::linear_hardening(body.material);
    hardening.yield_stress *= 1e6;
    hardening.modulus *= 1e6;
    testing::set_young_modulus(body.material, 1e6 * testing::young_modulus(body.material));
    testing::set_hardening(body.material, hardening);
    in_m.tools[0].surface =
        testing::make_plane(dealii::Tensor<1, 3>({0., 0., 15e-3}), dealii::Tensor<1, 3>({0., 0., -1.}));
    in_m.tools[0].motion.translation.value[2] = "-9.6e-3*t";
    if (absolute) {
      in_m.pairs[0].penalty.normal *= 1e9; // N/mm³ to N/m³
      in_m.pairs[0].penalty.tangential *= 1e9;
    }
    const Result mm = run(in_mm), m = run(in_m);
    const std::string name = absolute ? "absolute penalties" : "penalty factors";
    check(name + ": same steps and iterations", mm.iterations == m.iterations);
    testing::WorstError error;
    for (std::size_t i = 0; i < std::min(mm.forces.size(), m.forces.size()); ++i)
      error.add(std::abs(mm.forces[i] / m.forces[i] - 1.));
    check(name + ": same forces", error.value(), 1e-8);
  }
}

} // namespace units_test
