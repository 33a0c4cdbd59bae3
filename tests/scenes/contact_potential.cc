// SPDX-License-Identifier: LGPL-2.1-or-later
// Contact with a tool without a matrix: its forces are what the energy in its springs changes by, at any
// depth and with areas that change; together they are the load on the tool. And what that is for: blows at
// the speed of waves, much friction on nodes that lift, and stiff contact at long steps make no energy.
#include "billet/friction/coulomb.h"
#include "billet/friction/static_kinetic.h"
#include "explicit_run.h"
#include "materials.h"

#include "../geometry/make_surface.h"
#include "../loads/make_load.h"

#include <deal.II/base/mpi.h>

namespace contact_potential_test {

using namespace billet;
using billet::testing::check;
using billet::testing::ExplicitRun;
using dealii::Tensor;

namespace {

/// Nodes so deep: while that is little they stand on areas as they are, deep down on those before, too.
void test_potential(const std::string &name, const testing::SurfacePart &part, const double shallowest,
                    const double deepest) {
  parameters::Scene parameters = testing::read_test_scene("hard_blow.prm");
  parameters.bodies[0].mesh.arguments = "2, 2, 1 : -0.5, -0.5, 0 : 0.5, 0.5, 0.5 : true";
  parameters.tools[0].surface = testing::make_surface(part.shape, part.lines);
  const Scene scene(parameters);
  const Discretization discretization(scene, MPI_COMM_WORLD);
  const LocalNodes nodes(discretization);
  RigidContact contact(scene, 0, nodes);

  testing::Random random;
  NodalVectors u = nodes.make_vectors(), forces = u, bounds = u;
  const auto press = [&] {
    for (unsigned int node = 0; node < nodes.size(); ++node) {
      const Tensor<1, 3> reference = get_vector(nodes.positions().data(), node);
      Tensor<1, 3> x = reference + random.vector(0.1);
      if (reference[2] == 0.) {
        const auto projection = scene.tools()[0].surface().project(x);
        x -= (projection.gap + random(shallowest, deepest)) * projection.normal;
      }
      for (unsigned int i = 0; i < 3; ++i) {
        u[std::size_t{nodal_stride} * node + i] = x[i] - reference[i];
        forces[std::size_t{nodal_stride} * node + i] = 0.;
      }
    }
    contact.without_matrix().update(u);
    return contact.without_matrix().add_forces(forces, bounds);
  };
  press(); // they go deep where they are not later on
  const ContactLoad load = press();

  Tensor<1, 3> sum, moment;
  unsigned int n_pressed = 0;
  for (unsigned int node = 0; node < nodes.size(); ++node) {
    const Tensor<1, 3> force = get_vector(forces.data(), node);
    sum += force;
    moment += dealii::cross_product_3d(
        get_vector(nodes.positions().data(), node) + get_vector(u.data(), node), force);
    n_pressed += force.norm() > 0. ? 1 : 0;
  }
  check(name + ": nodes are pressed", n_pressed == 9);
  check(name + ": force on the tool", (sum - load.force).norm() / load.force.norm(), 1e-13);
  check(name + ": moment on the tool", (moment - load.moment).norm() / load.force.norm(), 1e-13);

  testing::WorstError error;
  for (unsigned int k = 0; k < 5; ++k) {
    NodalVectors direction = nodes.make_vectors();
    double power = 0., scale = 0.;
    for (unsigned int node = 0; node < nodes.size(); ++node) {
      const Tensor<1, 3> way({random(-1., 1.), random(-1., 1.), random(-1., 1.)});
      add_vector(direction.data(), node, way);
      power += way * get_vector(forces.data(), node);
      scale += get_vector(forces.data(), node).norm();
    }
    const double slope = testing::central_difference(
        [&](const double h) {
          NodalVectors moved = u;
          for (std::size_t i = 0; i < moved.size(); ++i)
            moved[i] += h * direction[i];
          contact.without_matrix().update(moved);
          return contact.measures().compute_load().stored_energy;
        },
        1e-4);
    error.add(std::abs(power + slope) / scale);
  }
  check(name + ": forces are those of the stored energy", error.value(), 1e-9);
}

/// Blows at the speed of waves, with areas that grow while nodes are deep.
void test_impacts() {
  for (const double penalty : {10., 1.}) {
    parameters::Scene scene = testing::read_test_scene("hard_blow.prm");
    scene.pairs[0].penalty.normal = penalty;
    scene.pairs[0].penetration_tolerance = 0.; // it stays
    scene.explicit_dynamics.safety_factor = 0.3;
    ExplicitRun run(scene);
    run.finish(2e-5, [] {});
    check("blow with a penalty of " + std::to_string(static_cast<int>(penalty)) + ": energy", run.worst_drift,
          5e-3);
  }
}

/// A slender bar at that speed: springs that pull the rim of its last facet together must not make it so
/// small that the bar goes through the wall.
void test_bar() {
  for (const double penalty : {10., 1.}) {
    parameters::Scene scene = testing::read_test_scene("hard_blow.prm");
    scene.pairs[0].penalty.normal = penalty;
    scene.pairs[0].penetration_tolerance = 0.; // it stays
    scene.bodies[0].mesh.arguments = "1, 1, 8 : 0, 0, 0 : 0.125, 0.125, 1 : true";
    testing::set_poisson_ratio(scene.bodies[0].material, 0.);
    ExplicitRun run(scene);
    double begin = 0.;
    run.finish(2e-5, [&] { begin = std::min(begin, run.state().momentum[2]); });
    const std::string name = "bar with a penalty of " + std::to_string(static_cast<int>(penalty));
    check(name + ": energy", run.worst_drift, 5e-3);
    check(name + ": comes back", run.state().momentum[2] > -0.6 * begin);
  }
}

/// The block stands under its weight, is thrown along the floor, tumbles and bounces.
void test_chatter() {
  struct Case {
    std::string name;
    FrictionPointer friction;
    double penalty, safety;
  };
  // Springs that are stiff let go often, and then push nodes along as often as they hold them back.
  for (const auto &[name, friction, penalty, safety] :
       {Case{"Coulomb", make_coulomb(2.), 10., 0.3},
        {"static-kinetic", std::make_shared<const StaticKinetic>(2., 1., 1.), 10., 0.3},
        {"stiff Coulomb", make_coulomb(2.), 1000., 0.9}}) {
    parameters::Scene scene = testing::read_test_scene("hard_blow.prm");
    scene.bodies[0].mesh.arguments = "2, 2, 1 : -0.5, -0.5, 0 : 0.5, 0.5, 0.5 : true";
    scene.bodies[0].initial_velocity.value = {"10", "0", "0"};
    scene.bodies[0].loads = {testing::make_load("acceleration", "set Acceleration = 0 ; 0 ; -2000")};
    scene.pairs[0].friction = friction;
    scene.pairs[0].penalty.normal = scene.pairs[0].penalty.tangential = penalty;
    scene.time_stepping.end_time = 0.04;
    scene.explicit_dynamics.safety_factor = safety;
    ExplicitRun run(scene);
    run.finish(1e-4, [] {});
    check("bounces with " + name + " friction: energy", run.worst_drift, 5e-3);
    check("bounces with " + name + " friction: friction takes energy",
          run.state().energies.friction > 0.3 * run.state().energies.initial);
  }
}

/// A block that goes deep at several times the speed of its waves, aslant, and whose friction springs let go
/// on areas that have changed since.
void test_deep_friction() {
  parameters::Scene scene = testing::read_test_scene("hard_blow.prm");
  scene.bodies[0].mesh.arguments = "2, 2, 2 : -0.5, -0.5, 0.02 : 0.5, 0.5, 1.02 : true";
  scene.bodies[0].initial_velocity.value = {"500", "300", "-2000"};
  scene.pairs[0].friction = make_coulomb(2.);
  scene.pairs[0].penalty.tangential = 0.5;
  scene.time_stepping.end_time = 3e-3;
  ExplicitRun run(scene);
  run.finish(1e-5, [] {});
  check("deep friction springs that let go: energy", run.worst_drift, 1e-2);
}

/// A cube that is one element, so that all of it is at the wall: the step gives way to what enters and
/// leaves.
void test_long_steps() {
  parameters::Scene scene = testing::read_test_scene("hard_blow.prm");
  scene.bodies[0].mesh.arguments = "1, 1, 1 : 0, 0, 0 : 1, 1, 1 : true";
  scene.bodies[0].initial_velocity.value = {"0", "0", "-10"};
  testing::set_poisson_ratio(scene.bodies[0].material, 0.);
  ExplicitRun run(scene);
  run.finish(1e-4, [] {});
  check("one element at a wall: energy", run.worst_drift, 0.03);
}

} // namespace

BILLET_MPI_TEST(contact_potential) {
  const auto test = [](const std::string &name, const testing::SurfacePart &part) {
    test_potential(name, part, 0.002, 0.008);
    test_potential(name + ", deep", part, 0.02, 0.4);
  };
  test("plane", {"plane", ""});
  test("sphere", {"sphere", "set Centre = 0.1, 0.2, -3\nset Radius = 3"});
  test("bowl", {"sphere", "set Centre = 0.1, 0.2, 3.85\nset Radius = 4\nset Side = inside"});
  test("cylinder", {"cylinder", "set Point = 0, 0, -3\nset Radius = 3\nset Axis = 1, 0.4, 0"});
  test_impacts();
  test_bar();
  test_chatter();
  test_deep_friction();
  test_long_steps();
}

} // namespace contact_potential_test
