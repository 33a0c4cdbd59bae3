// SPDX-License-Identifier: LGPL-2.1-or-later
// Facets that are divided, since the tool could enter between their nodes: how many parts they have; forces
// that are those of the stored energy, and together the load on the tool; a uniform pressure that stays a
// uniform stress; how deep a tool is between nodes; the tangent; springs that harden; a ball that bounces off
// the middle of a facet, and a plate that bounces off the edge of a tool.
#include "billet/contact/facet_division.h"
#include "billet/contact/hardening_spring.h"

#include "explicit_run.h"
#include "tangent_check.h"

#include <deal.II/base/mpi.h>

namespace divided_facets_test {

using namespace billet;
using billet::testing::check;
using billet::testing::ExplicitRun;
using billet::testing::SurfacePart;
using dealii::Tensor;

namespace {

const SurfacePart box{"extruded profile",
                      "set Corners = -0.8, 0 ; 0.8, 0 ; 0.8, -0.5 ; -0.8, -0.5 ; -0.8, 0\n"
                      "set Axis = 0, -1, 0\nset Direction = 1, 0, 0\nset Length = 1.6"};

/// A sphere of radius R, a cylinder, an edge of 90 degrees and a fin as wide as t need squares of s² ≤ R L/2,
/// s² ≤ R L, s ≤ L/4 and s about t.
void test_parts() {
  const auto n_parts = [](const SurfacePart &part, const double length) {
    const auto surface = testing::make_surface(part.shape, part.lines);
    const auto parts = FacetDivision(*surface, {Tensor<1, 3>(), 5.}).find_parts(length);
    return parts.is_enough ? parts.n : 0;
  };
  const SurfacePart ball{"sphere", "set Radius = 1"};
  check("plane: whole facets", n_parts({"plane", ""}, 1.) == 1);
  check("ball of two facets: whole facets", n_parts(ball, 0.48) == 1);
  check("smaller ball: 4 parts", n_parts(ball, 0.51) == 4);
  check("ball of a quarter of a facet: 4 parts", n_parts(ball, 4.) == 4);
  check("ball of a tenth: 16 parts", n_parts(ball, 10.) == 16);
  check("ball of a sixth: 8 parts", n_parts(ball, 6.) == 8);
  check("ball of a hundredth: too few parts", n_parts(ball, 100.) == 0);
  check("cavity: whole facets", n_parts({"sphere", "set Radius = 1\nset Side = inside"}, 0.9) == 1);
  const SurfacePart roll{"cylinder", "set Radius = 1"};
  check("roll of a facet: whole facets", n_parts(roll, 0.124) == 1);
  check("box: 4 parts", n_parts(box, 0.25) == 4);
  const SurfacePart fin{"extruded profile", "set Corners = -0.05, -1 ; -0.05, 0 ; 0.05, 0 ; 0.05, -1\n"
                                            "set Axis = 0, 1, 0\nset Direction = 1, 0, 0"};
  check("fin of 0.1 facets: 16 parts", n_parts(fin, 1.) == 16);
}

/// A block on a tool, displaced at will, without a motion.
struct Pressed {
  explicit Pressed(const SurfacePart &part, const bool hardens = true)
      : scene(read(part, hardens)), discretization(scene, MPI_COMM_WORLD), nodes(discretization),
        contact(scene, 0, nodes), u(nodes.make_vectors()), forces(u), bounds(u) {}
  static parameters::Scene read(const SurfacePart &part, const bool hardens) {
    parameters::Scene parameters = testing::read_test_scene("hard_blow.prm");
    parameters.bodies[0].mesh.arguments = "2, 2, 1 : -0.5, -0.5, 0 : 0.5, 0.5, 0.5 : true";
    parameters.tools[0].surface = testing::make_surface(part.shape, part.lines);
    parameters.pairs[0].penalty.is_given = !hardens;
    return parameters;
  }
  ContactLoad press() {
    for (auto &value : forces)
      value = 0.;
    contact.without_matrix().update(u);
    return contact.without_matrix().add_forces(forces, bounds);
  }

  Scene scene;
  Discretization discretization;
  LocalNodes nodes;
  RigidContact contact;
  NodalVectors u, forces, bounds;
};

void test_potential(const std::string &name, const SurfacePart &part) {
  Pressed block(part);
  testing::Random random;
  const auto &nodes = block.nodes;
  for (unsigned int node = 0; node < nodes.size(); ++node)
    add_vector(block.u.data(), node, random.vector(0.01));
  const ContactLoad load = block.press();
  Tensor<1, 3> sum, moment;
  bool are_nodes_free = true;
  for (const auto &report : block.contact.measures().report())
    are_nodes_free = are_nodes_free && report.gap > 0.;
  double scale = 0.;
  for (unsigned int node = 0; node < nodes.size(); ++node) {
    const Tensor<1, 3> force = get_vector(block.forces.data(), node);
    sum += force;
    scale += force.norm();
    moment += dealii::cross_product_3d(
        get_vector(nodes.positions().data(), node) + get_vector(block.u.data(), node), force);
  }
  check(name + ": no node is in the tool", are_nodes_free);
  check(name + ": facets are pressed", load.stored_energy > 0. && sum[2] > 0.);
  check(name + ": force on the tool", (sum - load.force).norm() / scale, 1e-13);
  check(name + ": moment on the tool", (moment - load.moment).norm() / scale, 1e-13);
  testing::WorstError error;
  for (unsigned int k = 0; k < 5; ++k) {
    NodalVectors direction = nodes.make_vectors();
    double power = 0.;
    for (unsigned int node = 0; node < nodes.size(); ++node) {
      const Tensor<1, 3> way({random(-1., 1.), random(-1., 1.), random(-1., 1.)});
      add_vector(direction.data(), node, way);
      power += way * get_vector(block.forces.data(), node);
    }
    const double slope = testing::central_difference(
        [&](const double h) {
          NodalVectors moved = block.u;
          for (std::size_t i = 0; i < moved.size(); ++i)
            moved[i] += h * direction[i];
          block.contact.without_matrix().update(moved);
          return block.contact.measures().compute_load().stored_energy;
        },
        1e-6);
    error.add(std::abs(power + slope) / scale);
  }
  check(name + ": forces are those of the stored energy", error.value(), 1e-7);
}

void test_patch() {
  Pressed on_plane({"plane", ""}), on_box(box, false);
  for (auto *block : {&on_plane, &on_box}) {
    for (unsigned int node = 0; node < block->nodes.size(); ++node) // it spreads, and sinks in
      add_vector(block->u.data(), node,
                 0.1 * get_vector(block->nodes.positions().data(), node) + Tensor<1, 3>({0., 0., -0.005}));
    block->press();
  }
  double error = 0., maximum = 0., bound = 0.;
  for (std::size_t i = 0; i < on_plane.forces.size(); ++i) {
    error = std::max(error, std::abs(on_plane.forces[i] - on_box.forces[i]));
    maximum = std::max(maximum, std::abs(on_plane.forces[i]));
    bound = std::max(bound, on_plane.bounds[i] - 1.05 * on_box.bounds[i]);
  }
  check("uniform pressure on divided facets: that of whole ones", error / maximum, 1e-12);
  check("uniform pressure on divided facets: as stiff", bound <= 0.);
}

/// Facets that are stretched over a cylinder of radius 1, with all nodes on it. Between those at x = 0 and x
/// = 0.8, a distance of l = √0.8, it enters by 1 − √(1 − l²/4).
void test_between_nodes() {
  const auto measure = [](const SurfacePart &part, const double sign) {
    Pressed block(part);
    for (unsigned int node = 0; node < block.nodes.size(); ++node) {
      const Tensor<1, 3> at = get_vector(block.nodes.positions().data(), node);
      const double x = 1.6 * at[0];
      add_vector(block.u.data(), node, Tensor<1, 3>({x - at[0], 0., sign * (std::sqrt(1. - x * x) - 1.)}));
    }
    block.press();
    return block.contact.measures().penetration_between_nodes();
  };
  const std::string axis = "set Axis = 0, 1, 0\nset Radius = 1\nset Point = 0, 0, ";
  const FacetPenetration roll = measure({"cylinder", axis + "-1"}, 1.);
  const double length = std::sqrt(0.8), depth = 1. - std::sqrt(0.8);
  check("stretched over a roll: depth between nodes", std::abs(roll.length - depth), 1e-12);
  check("stretched over a roll: part of the facet", std::abs(roll.of_facet - depth / length), 1e-12);
  check("stretched over a roll: length of the facet", std::abs(roll.facet_length - length), 1e-12);
  check("stretched over a roll: in the middle of a side",
        std::abs(std::abs(roll.position[0]) - 0.4) + std::abs(roll.position[2] + 0.2), 1e-12);
  check("on a plane: none", measure({"plane", ""}, 0.).length == 0.);
}

/// At d = d_0 the pressure is 2 k d and the slope 4 k; forces and slopes are derivatives.
void test_hardening() {
  const HardeningSpring spring{3., 0.5}, linear{3.};
  check("hardening: as stiff again", std::abs(spring.pressure(0.5) - 3.) + std::abs(spring.slope(0.5) - 12.),
        1e-15);
  check("hardening: energy", std::abs(spring.energy(0.5) - 0.5625), 1e-15);
  testing::WorstError error;
  for (const double depth : {0.01, 0.3, 0.9, 4.}) {
    const double h = 1e-4 * depth;
    const auto slope_of = [&](const auto &function) {
      return testing::central_difference([&](const double x) { return function(depth + x); }, h);
    };
    const double pressure = slope_of([&](const double d) { return spring.energy(d); });
    const double slope = slope_of([&](const double d) { return spring.pressure(d); });
    error.add(std::abs(pressure / spring.pressure(depth) - 1.));
    error.add(std::abs(slope / spring.slope(depth) - 1.));
  }
  check("hardening: derivatives", error.value(), 1e-7);
  check("linear springs", linear.pressure(0.3) == 3. * 0.3 && linear.slope(7.) == 3. &&
                              linear.energy(0.3) == 0.5 * 3. * 0.3 * 0.3);
}

void test_tangent() {
  for (const double friction : {0.8, 0.03, 0.}) {
    parameters::Scene scene =
        testing::make_curved({"sphere", "set Centre = 0.45, 0.55, -0.09\nset Radius = 0.1"}, friction);
    scene.time_stepping.initial_step = 0.05; // longer ones push the ball through the facet's middle
    for (const auto kind : {parameters::ContactTangent::exact, parameters::ContactTangent::numerical}) {
      scene.solver.contact_tangent = kind;
      testing::SceneRun run(scene);
      const std::string name = std::string("ball in facets, ") +
                               (kind == parameters::ContactTangent::exact ? "exact" : "numerical") +
                               " tangent, friction " +
                               (friction > 0.5  ? "0.8"
                                : friction > 0. ? "0.03"
                                                : "0");
      check(name, testing::tangent_error(run, 0.75, 3), 1e-6);
    }
  }
}

/// A ball of 0.6 facets that flies at the middle of a facet of a plate and does not pass.
void test_bounce() {
  parameters::Scene scene = testing::read_test_scene("hard_blow.prm");
  scene.bodies[0].mesh.arguments = "4, 4, 1 : -2, -2, 0 : 2, 2, 0.5 : true";
  scene.bodies[0].initial_velocity.value = {"0", "0", "-10"};
  scene.tools[0].surface = testing::make_surface("sphere", "set Centre = 0.5, 0.5, -0.61\nset Radius = 0.6");
  scene.time_stepping.end_time = 0.06;
  ExplicitRun run(scene);
  const double start = -0.08; // 8e-3 of mass at 10
  run.finish(1e-4, [] {});
  check("bounce off a facet: energy", run.worst_drift, 0.01);
  check("bounce off a facet: it does not pass", run.state().momentum[2] > 0.5 * start);
}

/// A plate that flies with its edge at the edge of a thin tool, between its nodes. On a mesh three times as
/// fine it comes back with 0.94 of its momentum.
void test_edge() {
  parameters::Scene scene = testing::read_test_scene("hard_blow.prm");
  scene.bodies[0].mesh.arguments = "4, 1, 4 : 2.02, 0.33, -1.73 : 6.02, 0.43, 2.27 : true";
  scene.bodies[0].initial_velocity.value = {"-20", "0", "0"};
  scene.pairs[0].boundary_ids.value = {0, 1, 2, 3, 4, 5};
  scene.tools[0].surface =
      testing::make_surface("extruded profile", "set Corners = -2, 0 ; 2, 0 ; 2, 0.1 ; -2, 0.1 ; -2, 0\n"
                                                "set Outside = right\nset Axis = 0, -1, 0\n"
                                                "set Direction = 1, 0, 0\nset Length = 4");
  scene.time_stepping.end_time = 0.025;
  ExplicitRun run(scene);
  double start = 0.;
  run.finish(1e-4, [&] { start = std::min(start, run.state().momentum[0]); });
  check("edge of a tool: energy", run.worst_drift, 0.03);
  check("edge of a tool: the plate comes back", run.state().momentum[0] > -0.75 * start);
}

} // namespace

BILLET_MPI_TEST(divided_facets) {
  test_parts();
  test_potential("small ball", {"sphere", "set Centre = 0.22, 0.27, -0.17\nset Radius = 0.2"});
  test_potential("ridge", {"extruded profile", "set Corners = -1, -1 ; 0.23, 0.03 ; 1, -1\n"
                                               "set Axis = 0.05, -1, 0\nset Direction = 1, 0.05, 0"});
  test_patch();
  test_between_nodes();
  test_hardening();
  test_tangent();
  test_bounce();
  test_edge();
}

} // namespace divided_facets_test
