// SPDX-License-Identifier: LGPL-2.1-or-later
// What contact with automatic tolerances takes of the forces, against a closed form and tight augmentation.
#include "billet/solve/stick_softness.h"
#include "explicit_run.h"
#include "materials.h"
#include "scene_run.h"

#include <deal.II/base/mpi.h>

#include <cmath>

namespace firm_contact_test {

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
    pair.friction = make_coulomb(1.);
    if (tolerance > 0.)
      pair.penetration_tolerance = tolerance;
  }
  SceneRun run(parameters);
  run.finish();
  return run.load(1).force;
}

parameters::Scene read_stuck_slab(const parameters::TimeStepping::Scheme scheme) {
  parameters::Scene parameters = testing::read_test_scene("stuck_slab.prm");
  parameters.time_stepping.scheme = scheme;
  return parameters;
}

/// On the plane that drags the slab, in implicit scenes.
dealii::Tensor<1, 3> drag(const parameters::Scene &parameters) {
  SceneRun run(parameters);
  run.finish();
  return run.load(0).force;
}

dealii::Tensor<1, 3> drag_explicitly(const parameters::Scene &parameters) {
  testing::ExplicitRun run(parameters);
  run.finish(1., [] {});
  return run.state().tool_loads[0].force;
}

/// In dynamics nothing is augmented: penalties rise.
void check_motion() {
  using Scheme = parameters::TimeStepping::Scheme;
  parameters::Scene statics = read_stuck_slab(Scheme::quasi_static);
  statics.pairs[0].penetration_tolerance = 1e-7;
  const dealii::Tensor<1, 3> reference = drag(statics);
  const auto is_near = [&](const dealii::Tensor<1, 3> &force) {
    return std::abs(force[0] / reference[0] - 1.) < allowed &&
           (force - reference).norm() < allowed * reference.norm();
  };
  parameters::Scene implicit = read_stuck_slab(Scheme::implicit_dynamics),
                    explicit_scene = read_stuck_slab(Scheme::explicit_dynamics);
  explicit_scene.bodies[0].material.density.value *= 4.; // half as many steps
  check("a slab that is dragged by friction bears what it does in statics, implicitly",
        is_near(drag(implicit)));
  check("and explicitly", is_near(drag_explicitly(explicit_scene)));
  implicit.pairs[0].penalty.is_tangential_given = true;
  check("a tangential penalty that the scene sets stays, and takes a part of that",
        drag(implicit)[0] < 0.97 * reference[0]);
}

/// Against uniaxial strain in Hencky's law: τ = M ln λ, and the area stays.
void check_confinement() {
  parameters::Scene parameters = testing::read_test_scene("confined_block.prm");
  const auto exact = [](const double nu) {
    const double modulus = 1e5 * (1. - nu) / ((1. + nu) * (1. - 2. * nu)), stretch = 0.999;
    return modulus * std::log(stretch) / stretch;
  };
  check("a confined block that is hardly compressible bears what it should, implicitly",
        std::abs(drag(parameters)[2] / exact(0.4999) - 1.), allowed);
  parameters.time_stepping.scheme = parameters::TimeStepping::Scheme::explicit_dynamics;
  testing::set_poisson_ratio(parameters.bodies[0].material, 0.499);
  parameters.bodies[0].material.density.value = 10.;
  testing::ExplicitRun run(parameters);
  const double end = parameters.time_stepping.end_time;
  constexpr unsigned int steps_between_raises = 100;
  double worst_drift = 0.;
  for (;;) {
    run.problem.prepare_step(run.problem.time() < end ? end : 2. * end);
    if (run.problem.n_steps() % steps_between_raises == 0 || run.problem.time() >= end) {
      run.problem.update_state();
      worst_drift = std::max(worst_drift, std::abs(run.problem.relative_drift()));
    }
    if (run.problem.time() >= end)
      break;
    run.problem.finish_step();
  }
  check("and explicitly", std::abs(run.state().tool_loads[0].force[2] / exact(0.499) - 1.), allowed);
  check("with an energy that balances, also while penalties rise", worst_drift, 0.01);
}

void check_thickness() {
  parameters::Scene parameters = testing::read_test_scene("stuck_slab.prm");
  parameters.pairs.clear();
  parameters.bodies[0].mesh.arguments = "4, 3, 2 : 0, 0, 0 : 4, 2, 0.5 : true";
  parameters.bodies[0].mesh.rotation_axis = dealii::Tensor<1, 3>({0.6, 0., 0.8});
  parameters.bodies[0].mesh.rotation_angle = 0.7;
  const Scene scene(parameters);
  const Discretization discretization(scene, MPI_COMM_WORLD);
  check("a body is as thick as it is, however it lies", std::abs(body_thicknesses(discretization)[0] - 0.5),
        1e-12);
}

} // namespace

BILLET_MPI_TEST(firm_contact) {
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
  check_motion();
  check_confinement();
  check_thickness();
}

} // namespace firm_contact_test
