// SPDX-License-Identifier: LGPL-2.1-or-later
// The parts of contact with a tool on a block of a scene, which the test displaces without a step: tangents
// of each kind against differences of forces, with friction or without, in each scheme and beyond an edge;
// derivatives for tools that a force drives; penalties and multipliers; nodes on an edge.
#include "billet/contact/rigid_contact.h"
#include "billet/friction/coulomb.h"

#include "explicit_run.h"

#include "../geometry/make_surface.h"

#include <deal.II/base/mpi.h>

namespace tool_contact_test {

using namespace billet;
using billet::testing::check;
using dealii::FullMatrix;
using dealii::Tensor;

namespace {

using Scheme = parameters::TimeStepping::Scheme;
using testing::SurfacePart;

const SurfacePart ball{"sphere", "set Centre = 0.1, 0.2, -20\nset Radius = 20"}, plane{"plane", ""},
    half_plane{"extruded profile", "set Corners = -2, 0 ; 0.49, 0\nset Axis = 0, -1, 0\n"
                                   "set Direction = 1, 0, 0"};

parameters::Scene read(const SurfacePart &part, const FrictionPointer &friction,
                       const Scheme scheme = Scheme::quasi_static) {
  parameters::Scene parameters = testing::read_test_scene("hard_blow.prm");
  parameters.bodies[0].mesh.arguments = "2, 2, 1 : -0.5, -0.5, 0 : 0.5, 0.5, 0.5 : true";
  parameters.tools[0].surface = testing::make_surface(part.shape, part.lines);
  parameters.pairs[0].friction = friction;
  parameters.pairs[0].penetration_tolerance = 0.;
  parameters.time_stepping.scheme = scheme;
  if (scheme == Scheme::quasi_static) { // a scene needs it; no slave is on the upper face
    parameters.bodies[0].supports = testing::read_test_scene("block_on_plane.prm").bodies[0].supports;
    parameters.bodies[0].supports[0].displacement.value = {"0", "0", "0"};
  }
  return parameters;
}

/// A block whose lower face, of 2 × 2 facets, is pressed onto a tool.
struct Block {
  explicit Block(const parameters::Scene &parameters)
      : scene(parameters), discretization(scene, MPI_COMM_WORLD), nodes(discretization),
        u(discretization.make_ghosted_vector()), displacements(nodes.make_vectors()) {}

  /// Displaces all nodes, and each at random by up to `scatter` more.
  const Vector &put(const Tensor<1, 3> &by, const double scatter) {
    for (unsigned int node = 0; node < nodes.size(); ++node)
      for (unsigned int i = 0; i < 3; ++i)
        displacements[std::size_t{nodal_stride} * node + i] = by[i] + random(-scatter, scatter);
    nodes.copy(displacements, u);
    return u;
  }

  Scene scene;
  Discretization discretization;
  LocalNodes nodes;
  Vector u;
  NodalVectors displacements;
  testing::Random random;
};

std::vector<FullMatrix<double>> collect(const RigidContactParts &parts, const ContactTangent kind) {
  std::vector<FullMatrix<double>> matrices;
  make_tool_tangents(parts, kind)
      ->visit(0, parts.slaves.facets.size(),
              [&](const ContactFacet &, const FullMatrix<double> &matrix) { matrices.push_back(matrix); });
  return matrices;
}

double compare(const std::vector<FullMatrix<double>> &a, const std::vector<FullMatrix<double>> &b) {
  testing::WorstError error;
  double scale = 0.;
  for (std::size_t f = 0; f < b.size(); ++f)
    scale = std::max(scale, b[f].frobenius_norm());
  for (std::size_t f = 0; f < b.size(); ++f) {
    FullMatrix<double> difference = a.at(f);
    difference.add(-1., b[f]);
    error.add(difference.frobenius_norm() / scale);
  }
  return error.value();
}

void check_tangents(const std::string &name, const SurfacePart &part, const double coefficient,
                    const Scheme scheme) {
  Block block(read(part, make_coulomb(coefficient), scheme));
  RigidContactParts parts(block.scene, block.scene.pairs()[0], block.discretization);
  parts.step.duration = 0.1;
  auto evaluation = make_tool_evaluation(parts, ContactTangent::exact);
  evaluation->run(block.put(Tensor<1, 3>({0., 0., -0.03}), 0.004));
  parts.commit();
  evaluation->run(block.put(Tensor<1, 3>({0.001, 0., -0.03}), 0.004));
  unsigned int n_touching = 0, n_fading = 0;
  for (const auto &state : parts.states) {
    n_touching += state.status != ContactStatus::open;
    n_fading += state.status != ContactStatus::open && state.share < 1.;
  }
  check(name + ": contact is as meant", n_touching >= 4 && (n_fading > 0) == (&part == &half_plane));
  const auto exact = collect(parts, ContactTangent::exact);
  check(name + ": facets that touch have tangents", exact.size() == 4);
  check(name + ": the exact one is that of differences",
        compare(exact, collect(parts, ContactTangent::numerical)), 2e-6);
  const std::vector<ToolContactState> states = parts.states;
  make_tool_evaluation(parts, ContactTangent::consistent)->run(block.u);
  const auto consistent = collect(parts, ContactTangent::consistent);
  bool are_same = true;
  for (std::size_t i = 0; i < states.size(); ++i)
    are_same = are_same && states[i].traction == parts.states[i].traction;
  check(name + ": another kind leaves tractions as they are", are_same);
  check(name + ": the consistent one takes areas and normals as fixed",
        compare(consistent, exact) > 1e-4 && compare(consistent, exact) < 0.5);
}

/// A tool that moves by s times a rate.
Placement place(const ToolRate &rate, const double s) {
  Placement placement;
  placement.centre = Tensor<1, 3>({0.2, -0.1, -1.});
  placement.translation = Tensor<1, 3>({0.001, 0.002, -0.001}) + s * rate.translation;
  if (const double size = rate.rotation.norm(); size > 0.)
    placement.rotation = dealii::Physics::Transformations::Rotations::rotation_matrix_3d(
        Tensor<1, 3>(rate.rotation / size), s * size);
  return placement;
}

void check_drive(const std::string &name, const ToolRate &rate) {
  Block block(read(ball, make_coulomb(0.2)));
  RigidContact contact(block.scene, 0, block.discretization, ContactTangent::exact);
  testing::Random random;
  contact.set_placement(place(rate, 0.));
  contact.with_matrix().update(block.put(Tensor<1, 3>({0., 0., -0.03}), 0.004));
  contact.commit();
  const Vector u = block.put(Tensor<1, 3>({0.001, 0., -0.03}), 0.004);
  const auto residual_at = [&](const double s) {
    contact.set_placement(place(rate, s));
    contact.with_matrix().update(u);
    Vector residual = block.discretization.make_additive_vector();
    contact.with_matrix().add_forces(residual);
    residual.compress(dealii::VectorOperation::add);
    return residual;
  };
  const auto power = [&] {
    const ContactLoad load = contact.measures().compute_load();
    return load.force * rate.translation + load.moment * rate.rotation;
  };
  residual_at(0.);
  Vector column = block.discretization.make_additive_vector(), row = column;
  const double slope = contact.drive().add_derivatives(contact.with_matrix().tangents(), rate, column, row);
  column.compress(dealii::VectorOperation::add);
  row.compress(dealii::VectorOperation::add);

  const double h = 1e-6;
  Vector difference = residual_at(h);
  difference -= residual_at(-h);
  difference *= 0.5 / h;
  difference -= column;
  check(name + "residual by a motion of the tool", difference.linfty_norm() / column.linfty_norm(), 1e-6);
  const double found = testing::central_difference(
      [&](const double s) {
        residual_at(s);
        return power();
      },
      h);
  check(name + "power by a motion of the tool", std::abs(found - slope) / std::abs(slope), 1e-6);
  contact.set_placement(place(rate, 0.));
  testing::WorstError of_row;
  for (unsigned int k = 0; k < 3; ++k) {
    Vector direction = block.discretization.make_owned_vector();
    double along_row = 0.;
    for (const auto i : block.discretization.owned_dofs()) {
      direction(i) = random(-1., 1.);
      along_row += direction(i) * row(i);
    }
    const double by_difference = testing::central_difference(
        [&](const double s) {
          Vector moved = u;
          moved.add(s, direction);
          contact.with_matrix().update(moved);
          return power();
        },
        h);
    of_row.add(std::abs(by_difference - along_row) / row.l1_norm());
  }
  check(name + "power by motions of nodes", of_row.value(), 1e-7);
}

void check_sliding() {
  for (const double coefficient : {0.1, 0.}) {
    const std::string name = coefficient > 0. ? "with friction: " : "without friction: ";
    Block block(read(plane, make_coulomb(coefficient)));
    RigidContact contact(block.scene, 0, block.discretization, ContactTangent::exact);
    const Tensor<1, 3> x({1., 0., 0.}), z({0., 0., 1.});
    contact.with_matrix().update(block.put(Tensor<1, 3>({0., 0., 0.02}), 0.));
    check(name + "way to the nodes", std::abs(contact.drive().distance_to_touch(z) - 0.02), 1e-12);
    check(name + "  there is none aside or away from them",
          std::isinf(contact.drive().distance_to_touch(x)) &&
              std::isinf(contact.drive().distance_to_touch(-z)) && !contact.measures().has_touching_nodes());
    contact.with_matrix().update(block.put(Tensor<1, 3>({0., 0., -0.01}), 0.));
    contact.commit();
    contact.with_matrix().update(block.put(Tensor<1, 3>({0.05, 0., -0.01}), 0.));
    const double pressure_force = contact.measures().compute_load().force[2];
    const ToolDrive::Sliding along = contact.drive().measure_sliding({x, {}}),
                             across = contact.drive().measure_sliding({z, {}}),
                             turning = contact.drive().measure_sliding({{}, z});
    check(name + "full sliding", testing::near(along.touching, pressure_force, 1e-12) &&
                                     along.slipping == along.touching && along.power_of_pressure == 0.);
    check(name + "  its pressure has the power of a motion along the normal",
          across.touching == 0. && testing::near(across.power_of_pressure, pressure_force, 1e-12));
    check(name + "  and turning slides", turning.slipping > 0.1 * pressure_force);
    contact.with_matrix().update(block.put(Tensor<1, 3>({1e-6, 0., -0.01}), 0.));
    check(name + "a node sticks or slips",
          (contact.drive().measure_sliding({x, {}}).slipping == 0.) == (coefficient > 0.));

    const auto residual = [&] {
      Vector result = block.discretization.make_additive_vector();
      contact.with_matrix().add_forces(result);
      result.compress(dealii::VectorOperation::add);
      return result;
    };
    Vector change = residual(), push = block.discretization.make_additive_vector();
    Placement after;
    after.translation[2] = 0.001;
    contact.drive().add_push(after, push);
    push.compress(dealii::VectorOperation::add);
    contact.set_placement(after);
    contact.with_matrix().update(block.u);
    change -= residual();
    change -= push;
    check(name + "push of a tool that moves", change.linfty_norm() / push.linfty_norm(), 1e-10);
    contact.remove_tool();
    contact.with_matrix().update(block.u);
    check(name + "a removed tool touches nothing",
          contact.measures().compute_load().area == 0. && std::isinf(contact.drive().distance_to_touch(z)));
  }
}

void check_penalties() {
  parameters::Scene parameters = read(plane, make_coulomb(10.));
  parameters.pairs[0].penetration_tolerance = 0.01;
  Block block(parameters);
  const auto force_of = [&](RigidContact &contact) {
    contact.with_matrix().update(block.u);
    return contact.measures().compute_load().force;
  };
  RigidContact contact(block.scene, 0, block.discretization, ContactTangent::exact);
  ToolPenalties &penalties = contact.penalties();
  contact.with_matrix().update(block.put(Tensor<1, 3>({0., 0., -0.01}), 0.));
  contact.commit();
  block.put(Tensor<1, 3>({1e-4, 0., -0.01}), 0.);
  const Tensor<1, 3> force = force_of(contact);
  const auto is = [&](const double normal, const double tangential) {
    const Tensor<1, 3> now = force_of(contact);
    return testing::near(now[2], normal * force[2], 1e-11) &&
           testing::near(now[0], tangential * force[0], 1e-9);
  };
  check("errors are relative to the tolerance", std::abs(penalties.augmentation_error() - 0.01 / 0.5 / 0.01),
        1e-10);
  ContactSprings springs = penalties.compute_springs();
  check("springs carry the force", testing::near(springs.normal.held, force[2], 1e-11) &&
                                       testing::near(springs.tangential.held, -force[0], 1e-9));
  penalties.augment();
  check("multipliers double it", is(2., 2.));
  springs = penalties.compute_springs();
  check("  of which springs carry a half",
        testing::near(springs.normal.held, 0.5 * springs.normal.force, 1e-11));
  const double left = penalties.stiffening_left(), spring = penalties.max_spring();
  penalties.scale(2., 4.);
  check("a stiffer penalty keeps multipliers", is(3., 5.));
  check("  and is nearer to its limit", penalties.stiffening() == 2. &&
                                            penalties.tangential_stiffening() == 4. &&
                                            testing::near(penalties.stiffening_left(), 0.5 * left, 1e-12) &&
                                            penalties.max_spring() >= 2. * spring);
  penalties.take_back_augmentation();
  check("an augmentation that is taken back", is(2., 4.));

  RigidContact other(block.scene, 0, block.discretization, ContactTangent::exact);
  block.put(Tensor<1, 3>({0., 0., -0.01}), 0.);
  const double before = force_of(other)[2];
  other.penalties().scale_under_load(4., 4.);
  check("a stiffer penalty under load keeps the force", std::abs(force_of(other)[2] / before - 1.), 1e-11);
  block.put(Tensor<1, 3>({0., 0., -0.011}), 0.);
  check("  and resists more", std::abs(force_of(other)[2] / before - 1.4), 1e-10);
}

void check_edge() {
  Block block(read(half_plane, nullptr));
  RigidContact contact(block.scene, 0, block.discretization, ContactTangent::exact);
  contact.with_matrix().update(block.put(Tensor<1, 3>(), 0.));
  const ToolChecks &checks = contact.checks();
  check("a node near the edge", checks.has_node_on_edge(Tensor<1, 3>({0.5, 0., 0.})));
  check("  others are not, and others are no nodes",
        !checks.has_node_on_edge(Tensor<1, 3>({0., 0., 0.})) &&
            !checks.has_node_on_edge(Tensor<1, 3>({0.49, 0., 0.})));
  check("  and nothing passes a half plane",
        !checks.may_let_nodes_through() && !checks.lets_nodes_through() && checks.check_step().empty());
  contact.remove_tool();
  check("  a removed tool has no edge", !checks.has_node_on_edge(Tensor<1, 3>({0.5, 0., 0.})));
}

} // namespace

BILLET_MPI_TEST(tool_contact) {
  for (const auto &[of_scheme, scheme] : {std::pair<std::string, Scheme>{"statics", Scheme::quasi_static},
                                          {"implicit dynamics", Scheme::implicit_dynamics},
                                          {"explicit dynamics", Scheme::explicit_dynamics}})
    for (const auto &[of_friction, coefficient] :
         {std::pair<std::string, double>{"no friction", 0.}, {"friction", 0.2}}) {
      check_tangents("ball, " + of_scheme + ", " + of_friction, ball, coefficient, scheme);
      check_tangents("edge, " + of_scheme + ", " + of_friction, half_plane, coefficient, scheme);
    }
  // As in the program, which a force or a moment drives.
  check_drive("force: ", {Tensor<1, 3>({0.6, 0., 0.8}), {}});
  check_drive("moment: ", {{}, Tensor<1, 3>({0.5, 0.1, 0.4})});
  check_sliding();
  check_penalties();
  check_edge();
}

} // namespace tool_contact_test
