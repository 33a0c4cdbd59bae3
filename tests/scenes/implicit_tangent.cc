// SPDX-License-Identifier: LGPL-2.1-or-later
// The tangent of implicit dynamics against central differences of the residual: inertia, a pressure that
// follows its faces, a moment that does, springs, dashpots, contact with friction on a heavy tool whose
// travel is unknown, supports that move.
#include "billet/integration/time_integrator_type.h"

#include "tangent_check.h"

#include "../loads/make_load.h"

#include <deal.II/base/mpi.h>

namespace implicit_tangent_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

parameters::Scene make_scene() {
  parameters::Scene scene =
      testing::make_curved({"sphere", "set Centre = 0.45, 0.55, -5\nset Radius = 5"}, 0.2);
  scene.time_stepping.scheme = parameters::TimeStepping::Scheme::implicit_dynamics;
  auto &body = scene.bodies[0];
  body.material.density.value = 10.;
  body.supports[0].displacement.value = {"0.04*t", "0.03*t^2 - 0.01*z*t", "-0.08*t"};
  body.initial_velocity.value = {"0.04", "0", "-0.08*z"};
  for (const auto &[type, lines] : std::initializer_list<std::array<std::string, 2>>{
           {"acceleration", "set Acceleration = 0.1 ; 0 ; -t"},
           {"pressure", "set Boundary ids = 0\nset Pressure = 20*t*(1 + x)"},
           {"spring", "set Boundary ids = 1\nset Stiffness = 300"},
           {"spring", "set Boundary ids = 2\nset Stiffness = 300\nset Direction = normal"},
           {"dashpot", "set Boundary ids = 3\nset Damping = 30"},
           {"dashpot", "set Boundary ids = 2\nset Damping = 30\nset Direction = 0.6, 0, 0.8"},
           {"dead traction", "set Boundary ids = 3\nset Traction = 3*t ; x ; 1"},
           {"body force", "set Body force = 1 ; 2*t ; 3"},
           {"force", "set Point = 0.3, 0.4, 0.5\nset Force = 1 ; 2*t ; 3"},
           {"moment", "set Boundary ids = 1\nset Moment = 2 ; 3*t ; 1"},
           {"rigid face", "set Boundary ids = 2\nset Stiffness factor = 0.1"},
           {"moment", "set Boundary ids = 2\nset Moment = 1 ; 3*t ; 2\nset Follow = false"}})
    body.loads.push_back(testing::make_load(type, lines));
  return scene;
}

void check_scene(const std::string &name, const parameters::Scene &scene) {
  SceneRun run(scene);
  check(name, testing::tangent_error(run, 0.75, 3), 1e-6);
  bool touches = false;
  for (const auto &node : run.problem.equation().parts().contacts().of_tools()[0].measures().report())
    touches = touches || node.status != ContactStatus::open;
  check("  touches", touches);
}

} // namespace

BILLET_MPI_TEST(implicit_tangent) {
  parameters::Scene scene = make_scene();
  check_scene("generalised-alpha", scene);
  scene.implicit_dynamics.integrator = hilber_hughes_taylor(-0.2);
  scene.implicit_dynamics.mass = parameters::ImplicitDynamics::Mass::lumped;
  parameters::Scene statics = make_scene();
  statics.time_stepping.scheme = parameters::TimeStepping::Scheme::quasi_static;
  statics.bodies[0].initial_velocity.value = {"0", "0", "0"};
  check_scene("statics", statics);
  check_scene("HHT, lumped mass", scene);

  auto &motion = scene.tools[0].motion;
  motion.control = parameters::Motion::Control::force;
  motion.load.value = "1 + 5*t";
  motion.direction = dealii::Tensor<1, 3>({0., 0.6, 0.8});
  motion.inertia = 3.;
  check_scene("heavy tool with a force", scene);
  motion.control = parameters::Motion::Control::moment;
  motion.load.value = "0.3*t";
  check_scene("heavy tool with a moment", scene);
}

} // namespace implicit_tangent_test
