// SPDX-License-Identifier: LGPL-2.1-or-later
// The state of single nodes on a tool, with friction or without, in statics and with inertia, by each kind of
// tangents: tractions against those of the law in a contact frame, tangents against differences, nodes that
// rest, pass an edge or fade beyond it; the energies and areas of the springs.
#include "billet/contact/tool_node.h"
#include "billet/contact/tool_evaluation.h"
#include "billet/contact/tool_springs.h"
#include "billet/discretization/local_nodes.h"
#include "billet/friction/coulomb.h"

#include "../geometry/make_surface.h"
#include "../testing.h"

#include <deal.II/base/mpi.h>

namespace tool_node_test {

using namespace billet;
using namespace billet::testing;
using dealii::Tensor;

namespace {

using Scheme = parameters::TimeStepping::Scheme;

constexpr double coefficient = 0.3, duration = 0.5, depth = 0.01;
const std::array<ContactStiffness, 2> stiffness{{{1e3, 400.}, {2e3, 500.}}};
const char *const half_plane_lines = "set Corners = -1, 0 ; 0, 0\nset Axis = 0, -1, 0\n"
                                     "set Direction = 1, 0, 0";

parameters::Scene make_scene(const SharedSurface &surface, const bool has_friction, const Scheme scheme) {
  const std::string scenes = std::string(SOURCE_DIR) + "/../scenes/";
  parameters::Scene parameters = parameters::Scene::read(scenes + "hard_blow.prm");
  parameters.bodies[0].mesh.arguments = "2, 2, 1 : -0.5, -0.5, 0 : 0.5, 0.5, 0.5 : true";
  parameters.tools[0].surface = surface;
  parameters.pairs[0].friction = has_friction ? make_coulomb(coefficient) : nullptr;
  parameters.pairs[0].penetration_tolerance = 0.;
  parameters.time_stepping.scheme = scheme;
  if (scheme == Scheme::quasi_static) { // a scene needs supports; no slave is on the upper face
    parameters.bodies[0].supports = parameters::Scene::read(scenes + "block_on_plane.prm").bodies[0].supports;
    parameters.bodies[0].supports[0].displacement.value = {"0", "0", "0"};
  }
  return parameters;
}

/// Two nodes of known stiffness on a tool; the others of the block play no part.
struct Bench {
  Bench(const SharedSurface &surface, const bool has_friction, const Scheme scheme,
        const ContactTangent of_kind)
      : scene(make_scene(surface, has_friction, scheme)), discretization(scene, MPI_COMM_WORLD),
        parts(scene, scene.pairs()[0], discretization), kind(of_kind) {
    parts.step.duration = duration;
    for (std::size_t i = 0; i < 2; ++i) {
      ContactPoint &node = parts.slaves.nodes[i];
      node.stiffness = node.given = stiffness[i];
      node.size = 1.;
    }
  }

  /// Starts a node at this position in space.
  void start(const std::size_t i, const Tensor<1, 3> &position) {
    const Tensor<1, 3> on_tool = parts.step.placement.to_tool(position);
    parts.slaves.nodes[i].gap_n = parts.step.surface.project(on_tool).gap;
    if (parts.friction) {
      parts.friction->start(i, on_tool);
      parts.friction->commit();
    }
  }

  ToolContactState evaluate(const std::size_t i, const Tensor<1, 3> &position) const {
    ToolContactState state;
    visit_tool_node(parts, kind, [&](const auto &node) {
      ToolFriction::History history;
      if constexpr (std::decay_t<decltype(node)>::has_friction)
        state = node.evaluate(i, position, &history);
      else
        state = node.evaluate(i, position, nullptr);
    });
    return state;
  }

  /// Returns the error of the tangent against differences [k_n].
  double compare_tangent(const std::size_t i, const Tensor<1, 3> &position) const {
    const Tensor<2, 3> tangent = evaluate(i, position).tangent;
    WorstError error;
    for (unsigned int j = 0; j < 3; ++j) {
      const Tensor<1, 3> slope = central_difference(
          [&](const double h) {
            Tensor<1, 3> moved = position;
            moved[j] += h;
            return evaluate(i, moved).traction;
          },
          1e-6);
      for (unsigned int c = 0; c < 3; ++c)
        error.add(std::abs(tangent[c][j] + slope[c]) / stiffness[i].normal);
    }
    return error.value();
  }

  Scene scene;
  Discretization discretization;
  RigidContactParts parts;
  const ContactTangent kind;
};

/// Returns the traction of the law in the frame of a plane, on a node that moves by `motion` along it.
Tensor<1, 3> expect(const Bench &bench, const std::size_t i, const Tensor<1, 3> &normal,
                    const Tensor<1, 3> &motion) {
  if (!bench.parts.friction)
    return compute_frictionless_traction(stiffness[i].normal, -depth).pressure * normal;
  const Frame frame = Frame::from_normal(normal);
  TangentialIncrement increment{{motion * frame.q, motion * frame.r}};
  increment.per_time = 1. / duration;
  const FrameTraction t = compute_traction(*bench.scene.pairs()[0].friction, stiffness[i],
                                           FrictionTangent::of(bench.kind), -depth, {}, increment);
  return t.tangential[0] * frame.q + t.tangential[1] * frame.r + t.pressure * normal;
}

void check_plane(const std::string &name, const bool has_friction, const Scheme scheme,
                 const ContactTangent kind) {
  Bench bench(make_surface("plane", ""), has_friction, scheme, kind);
  Random random;
  Placement &placement = bench.parts.step.placement;
  placement.rotation = random.rotation();
  placement.translation = random.vector(1.);
  bench.parts.step.placement_n = placement;
  const Tensor<1, 3> normal = placement.rotation * Tensor<1, 3>({0., 0., 1.});
  // The first node sticks, the second one slips.
  const std::array<Tensor<1, 3>, 2> motions{
      placement.rotation * Tensor<1, 3>({0.003, -0.004, 0.}),
      placement.rotation * Tensor<1, 3>({0.03, 0.04, 0.}),
  };
  WorstError traction, gap, size, tangent;
  std::array<ContactStatus, 2> statuses{};
  for (std::size_t i = 0; i < 2; ++i) {
    const Tensor<1, 3> at = placement.to_space(Tensor<1, 3>({0.1, 0.2, -depth}));
    bench.start(i, at);
    const ToolContactState state = bench.evaluate(i, at + motions[i]);
    const double pressure = stiffness[i].normal * depth;
    statuses[i] = state.status;
    gap.add(std::abs(state.gap + depth) / depth);
    traction.add((state.traction - expect(bench, i, normal, motions[i])).norm() / pressure);
    const double along = (state.traction - (state.traction * normal) * normal).norm();
    const double limit = has_friction ? coefficient * pressure : 0.;
    const double stretched = has_friction ? stiffness[i].tangential * motions[i].norm() : 0.;
    size.add(std::abs(along - std::min(limit, stretched)) / pressure);
    size.add(std::abs(state.pressure - pressure) / pressure);
    tangent.add(bench.compare_tangent(i, at + motions[i]));
  }
  check(name + ": gap", gap.value(), 1e-12);
  check(name + ": traction is that of the law", traction.value(), 1e-12);
  check(name + ": pressure k d and friction min(k u, mu p)", size.value(), 1e-12);
  check(name + ": status", statuses[0] == (has_friction ? ContactStatus::stick : ContactStatus::slip) &&
                               statuses[1] == ContactStatus::slip);
  check(name + ": tangent is that of differences", tangent.value(), 1e-7); // no curvature
  const ToolContactState open = bench.evaluate(0, placement.to_space(Tensor<1, 3>({0.1, 0.2, depth})));
  check(name + ": a node in front of the plane is open",
        open.status == ContactStatus::open && open.pressure == 0. && open.traction.norm() == 0. &&
            open.tangent.norm() == 0. && near(open.gap, depth, 1e-12));
}

void check_curvature(const std::string &name, const bool has_friction, const Scheme scheme) {
  const SharedSurface ball = make_surface("sphere", "set Centre = 0, 0, -2\nset Radius = 2");
  const Tensor<1, 3> at({0.3, -0.2, -0.04}), motion({0.02, 0.01, 0.});
  for (const ContactTangent kind : {ContactTangent::exact, ContactTangent::consistent}) {
    Bench bench(ball, has_friction, scheme, kind);
    bench.start(0, at);
    const double error = bench.compare_tangent(0, at + motion);
    if (kind == ContactTangent::exact)
      check(name + ": exact tangent on a ball", error, 1e-7);
    else
      check(name + ": the consistent one lacks the curvature", error > 1e-3 && error < 0.1);
  }
}

void check_rest(const std::string &name, const bool has_friction) {
  const SharedSurface plane = make_surface("plane", "");
  for (const bool has_inertia : {false, true}) {
    Bench bench(plane, has_friction, has_inertia ? Scheme::implicit_dynamics : Scheme::quasi_static,
                ContactTangent::exact);
    const double lifted = 0.5 * touching_gap;
    ContactPoint &node = bench.parts.slaves.nodes[0];
    node.touching_gap = has_inertia ? 0. : touching_gap;
    bench.start(0, Tensor<1, 3>({0.1, 0., lifted}));
    const ToolContactState state = bench.evaluate(0, Tensor<1, 3>({0.1, 0., lifted}));
    if (has_inertia)
      check(name + ": with inertia, not above it", state.status == ContactStatus::open);
    else
      check(name + ": a node rests on the plane in statics",
            state.status != ContactStatus::open && state.traction.norm() == 0. &&
                near(state.tangent[2][2], stiffness[0].normal, 1e-12));
    if (!has_inertia) {
      bench.parts.states[0] = bench.evaluate(0, Tensor<1, 3>({0.1, 0., 1.6 * lifted}));
      bench.parts.commit();
      check(name + ": it rests no more once a step has moved it away",
            bench.evaluate(0, Tensor<1, 3>({0.1, 0., lifted})).status == ContactStatus::open);
    }
    bench.start(0, Tensor<1, 3>({0.1, 0., 0.}));
    check(name + (has_inertia ? ": with inertia, on it" : ": in statics, on it"),
          bench.evaluate(0, Tensor<1, 3>({0.1, 0., 0.})).status != ContactStatus::open);
  }
}

void check_edge(const std::string &name, const bool has_friction) {
  const SharedSurface half_plane = make_surface("extruded profile", half_plane_lines);
  const Tensor<1, 3> beyond({0.2, 0.3, -0.1}), below({-0.2, 0.3, -0.1}), on_edge({0.02, 0.3, -0.01});
  for (const bool has_inertia : {false, true}) {
    Bench bench(half_plane, has_friction, has_inertia ? Scheme::implicit_dynamics : Scheme::quasi_static,
                ContactTangent::exact);
    const std::string scheme = name + (has_inertia ? ", with inertia" : ", statics");
    bench.start(0, beyond);
    const ToolContactState missed = bench.evaluate(0, beyond);
    check(scheme + ": a node beyond the edge",
          missed.status == ContactStatus::open && missed.is_behind == has_inertia);
    bench.parts.slaves.nodes[0].is_behind = true;
    bench.parts.slaves.nodes[0].behind_at = beyond;
    const ToolContactState passed = bench.evaluate(0, below);
    if (has_inertia)
      check(scheme + ": one that comes back behind the surface is not pressed",
            passed.status == ContactStatus::open && passed.is_passed && near(passed.gap, 0.1, 1e-12));
    else
      check(scheme + ": one that comes back is pressed",
            passed.status != ContactStatus::open && !passed.is_passed && near(passed.gap, -0.1, 1e-12));
    bench.parts.slaves.nodes[0].is_behind = false;
    bench.start(0, on_edge);
    const ToolContactState fading = bench.evaluate(0, on_edge);
    check(scheme + ": the pressure fades beyond the edge", fading.share > 0. && fading.share < 1. &&
                                                               fading.pressure > 0. &&
                                                               fading.pressure < stiffness[0].normal * 0.01);
    check(scheme + ": with an exact tangent", bench.compare_tangent(0, on_edge), 1e-6);
  }
}

void check_evaluation() {
  Bench bench(make_surface("plane", ""), true, Scheme::quasi_static, ContactTangent::exact);
  RigidContactParts &parts = bench.parts;
  LocalNodes nodes(bench.discretization);
  NodalVectors displacements = nodes.make_vectors();
  Vector u = bench.discretization.make_ghosted_vector();
  for (unsigned int node = 0; node < nodes.size(); ++node)
    displacements[std::size_t{nodal_stride} * node + 2] = -depth;
  nodes.copy(displacements, u);
  for (std::size_t i = 0; i < parts.slaves.nodes.size(); ++i) {
    parts.slaves.nodes[i].stiffness = stiffness[i % 2];
    bench.start(i, parts.slaves.nodes[i].reference);
  }
  make_tool_evaluation(parts, bench.kind)->run(u);
  bool are_same = true;
  WorstError energy;
  const ToolSprings<false> springs(parts);
  for (std::size_t i = 0; i < parts.states.size(); ++i) {
    const ToolContactState state =
        bench.evaluate(i, parts.slaves.nodes[i].reference + Tensor<1, 3>({0., 0., -depth}));
    are_same = are_same && parts.states[i].traction == state.traction &&
               parts.states[i].tangent == state.tangent && parts.states[i].gap == state.gap;
    energy.add(std::abs(springs.stored_energy(i) / (0.5 * stiffness[i % 2].normal * depth * depth) - 1.));
  }
  check("the loop sets the states of all nodes", are_same && parts.states.size() == 9);
  check("springs store k d²/2", energy.value(), 1e-12);
  double area = 0., counted = 0.;
  std::array<double, 9> of_node{};
  visit_areas(parts, [&](const unsigned int i, const double part) {
    area += part;
    of_node.at(i) += part;
  });
  springs.visit_counted_areas([&](const unsigned int, const double part) { counted += part; });
  check("areas of touching nodes sum to the face", std::abs(area - 1.), 1e-12);
  check("  the middle node has a quarter, those at corners a sixteenth",
        near(*std::max_element(of_node.begin(), of_node.end()), 0.25, 1e-12) &&
            near(*std::min_element(of_node.begin(), of_node.end()), 0.0625, 1e-12));
  check("  and forces act on them", std::abs(counted - 1.), 1e-12);
  parts.remove_tool();
  make_tool_evaluation(parts, bench.kind)->run(u);
  check("no node touches a tool that is removed",
        std::all_of(parts.states.begin(), parts.states.end(),
                    [](const auto &state) { return state.status == ContactStatus::open; }));
}

} // namespace

BILLET_MPI_TEST(tool_node) {
  for (const bool has_friction : {false, true})
    for (const bool has_inertia : {false, true}) {
      const Scheme scheme = has_inertia ? Scheme::implicit_dynamics : Scheme::quasi_static;
      const std::string name =
          std::string(has_friction ? "Coulomb" : "frictionless") + (has_inertia ? ", inertia" : ", statics");
      check_plane(name + ", exact", has_friction, scheme, ContactTangent::exact);
      check_plane(name + ", consistent", has_friction, scheme, ContactTangent::consistent);
      check_curvature(name, has_friction, scheme);
    }
  for (const bool has_friction : {false, true}) {
    const std::string name = has_friction ? "Coulomb" : "frictionless";
    check_rest(name, has_friction);
    check_edge(name, has_friction);
  }
  check_evaluation();
}

} // namespace tool_node_test
