// SPDX-License-Identifier: LGPL-2.1-or-later
// What contact with automatic tolerances takes of the forces, against a closed form and tight augmentation.
#include "scene_run.h"

#include <deal.II/base/mpi.h>

#include <cmath>

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

constexpr double allowed = 5e-3; // of the force: what such a run may lack

parameters::Scene read() { return parameters::Scene::read(std::string(SOURCE_DIR) + "/firm_contact.prm"); }

double press(const std::function<void(parameters::ContactPair &)> &change) {
  parameters::Scene parameters = read();
  for (auto &pair : parameters.pairs)
    change(pair);
  SceneRun run(parameters);
  run.finish();
  return run.load(0).force[2];
}

/// On the lower plate, after it has moved sideways under a block that sticks.
dealii::Tensor<1, 3> shear(const double tolerance) {
  parameters::Scene parameters = read();
  parameters.time_stepping.end_time = 2.;
  for (auto &pair : parameters.pairs) {
    pair.friction_coefficient = 1.;
    if (tolerance > 0.)
      pair.penetration_tolerance = tolerance;
  }
  SceneRun run(parameters);
  run.finish();
  return run.load(1).force;
}

} // namespace

int main(int argc, char *argv[]) {
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  // Uniaxial stress in Hencky's law: τ = E ln λ, and the force is τ A_0/λ.
  const double stretch = 0.9, exact = -1000. * std::log(stretch) / stretch;
  const auto error = [&](const double force) { return std::abs(std::abs(force) / exact - 1.); };
  check("a block between plates bears what it should", error(press([](auto &) {})), allowed);
  check("penalties alone take a part of that",
        error(press([](auto &pair) { pair.penetration_tolerance = 0.; })) > 0.05);
  const auto sheared = shear(0.), reference = shear(1e-7);
  check("so does one that is sheared", (sheared - reference).norm(), allowed * reference.norm());
  check("by friction, too", std::abs(sheared[0] - reference[0]), 2. * allowed * std::abs(reference[0]));
  check("which is much of the force", std::abs(reference[0]) > 0.05 * reference.norm());
  return testing::exit_code();
}
