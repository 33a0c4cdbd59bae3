// SPDX-License-Identifier: LGPL-2.1-or-later
// Friction of a node on a plane tool, without a mesh: stick and slip relative to a tool that moves, entry
// within the step, augmented tractions, works of a node that leaves, and saved histories.
#include "billet/contact/tool_friction.h"
#include "billet/friction/coulomb.h"

#include "memory_state.h"

#include "../geometry/make_surface.h"
#include "../testing.h"

namespace tool_friction_test {

using namespace billet;
using namespace billet::testing;
using dealii::Tensor;

namespace {

constexpr double k_n = 1e3, k_t = 400., coefficient = 0.5, depth = 0.01, pressure = k_n * depth;
constexpr double round_off = 1e-13;

/// A node that is pressed into the plane z = 0 by `depth`.
class Node {
public:
  Node() : friction_(law_, true, 1, step_, pressures_), nodes_(1) {
    nodes_[0].stiffness = {k_n, k_t};
    nodes_[0].gap_n = -depth;
    step_.duration = 0.5;
    friction_.start(0, Tensor<1, 3>());
    friction_.commit();
  }

  template <bool is_exact = false>
  const ToolContactState &press(const Tensor<1, 3> &position, const EdgeFading *fading = nullptr) {
    state_ = ToolContactState();
    state_.position = position;
    state_.normal = step_.placement.rotation * Tensor<1, 3>({0., 0., 1.});
    state_.gap = step_.placement.to_tool(position)[2];
    friction_.press<is_exact>(0, nodes_[0], {}, fading, state_, friction_[0]);
    friction_[0].tool_position = step_.placement.to_tool(position);
    return state_;
  }
  const ToolContactState &lift(const Tensor<1, 3> &position) {
    state_ = ToolContactState();
    state_.position = position;
    friction_.release(0, nodes_[0], Tensor<1, 3>({0., 0., 1.}), state_, friction_[0]);
    return state_;
  }
  void commit() {
    pressures_.record({state_}, nodes_, step_.placement);
    step_.placement_n = step_.placement;
    friction_.commit();
  }
  double elastic_slip() const { return friction_.elastic_slip(0, nodes_[0], state_); }

  SharedSurface surface_ = make_surface("plane", "");
  Coulomb law_{coefficient};
  ToolStep step_{*surface_, Placement()};
  PressureRecord pressures_;
  ToolFriction friction_;
  std::vector<ContactPoint> nodes_;
  ToolContactState state_;
};

Tensor<1, 3> at(const double x) { return Tensor<1, 3>({x, 0., -depth}); }

double error(const ToolContactState &state, const double friction) {
  return (state.traction - Tensor<1, 3>({-friction, 0., pressure})).norm() / pressure;
}

void check_stick_and_slip() {
  Node node;
  check("stick", error(node.press(at(0.01)), k_t * 0.01), round_off);
  check("  its status, slip and energy", node.state_.status == ContactStatus::stick &&
                                             node.state_.slip_increment == 0. &&
                                             near(node.state_.tangential_energy, 0.5 * k_t * 1e-4, 1e-12));
  check("  elastic slip counts only from the second step", node.elastic_slip() == 0.);
  node.commit();
  check("a spring keeps its traction", error(node.press(at(0.01)), k_t * 0.01), round_off);
  check("  and stretches further", error(node.press(at(0.011)), k_t * 0.011), round_off);
  check("  by the elastic slip of the step", std::abs(node.elastic_slip() - 0.001), 1e-15);
  node.nodes_[0].is_fixed = true;
  check("  except at a fixed node", node.elastic_slip() == 0.);
  node.nodes_[0].is_fixed = false;

  const double limit = coefficient * pressure, slip = 0.03 - limit / k_t;
  check("slip", error(node.press(at(0.03)), limit), round_off);
  check("  its status and length", node.state_.status == ContactStatus::slip &&
                                       near(node.state_.slip_increment, slip, 1e-12) &&
                                       near(node.friction_[0].slip, slip, 1e-12) &&
                                       near(node.friction_[0].slip_rate, slip / 0.5, 1e-12));
  check("  a step back from there sticks again",
        (node.commit(), error(node.press(at(0.029)), limit - k_t * 0.001)), round_off);
  node.friction_.clear();
  check("cleared histories", !node.friction_[0].is_active && node.friction_[0].slip == 0.);
}

void check_moving_tool() {
  Node node;
  node.press(at(0.01));
  node.commit();
  Random random;
  Placement &placement = node.step_.placement;
  placement.rotation = random.rotation();
  placement.translation = random.vector(1.);
  const ToolContactState &state = node.press(placement.to_space(at(0.01)));
  const Tensor<1, 3> expected = placement.rotation * Tensor<1, 3>({-k_t * 0.01, 0., pressure});
  check("a node that moves with the tool takes its traction along",
        (state.traction - expected).norm() / pressure, 1e-12);
}

void check_entry() {
  Node node;
  node.nodes_[0].gap_n = 3. * depth; // a quarter of the step in contact
  check("a node that enters slides on the tool for a part of the step",
        error(node.press(at(0.01)), 0.25 * k_t * 0.01), round_off);
  WorstError of_tangent;
  const double h = 1e-7;
  const Tensor<2, 3> tangent = node.press<true>(at(0.01)).tangent;
  for (unsigned int j = 0; j < 3; ++j)
    for (unsigned int i = 0; i < 3; ++i)
      of_tangent.add(std::abs(tangent[i][j] + central_difference(
                                                  [&](const double d) {
                                                    Tensor<1, 3> x = at(0.01);
                                                    x[j] += d;
                                                    return node.press(x).traction[i];
                                                  },
                                                  h)) /
                     k_n);
  check("  with an exact tangent", of_tangent.value(), 1e-7);
}

void check_augmentation() {
  Node node;
  node.press(at(0.01));
  node.commit();
  node.press(at(0.011));
  node.friction_.augment(node.nodes_);
  check("an augmented spring starts from its last traction",
        error(node.press(at(0.011)), k_t * (0.011 + 0.001)), round_off);
  check("  from which its elastic slip counts", std::abs(node.elastic_slip() - 0.001), 1e-15);
  node.friction_.restart();
  check("  and a restart takes that back", error(node.press(at(0.011)), k_t * 0.011), round_off);
  node.friction_.augment(node.nodes_);
  node.commit();
  check("  as the end of the step does", error(node.press(at(0.011)), k_t * 0.011), round_off);
  node.nodes_[0].is_fixed = true;
  node.press(at(0.012));
  node.friction_.augment(node.nodes_);
  check("a fixed node is not augmented", error(node.press(at(0.012)), k_t * 0.012), round_off);
}

void check_release() {
  for (const bool is_static : {false, true}) {
    Node node;
    node.friction_.set_account(is_static ? 0. : 0.5,
                               is_static ? FrictionAccounting::of_equilibria : FrictionAccounting::of_motion);
    node.press(at(0.01));
    node.commit();
    // It rises to three times its penetration: φ = 1/4.
    const ToolContactState &state = node.lift(Tensor<1, 3>({0.012, 0., 3. * depth}));
    const double t_n = -k_t * 0.01, stored = 0.5 * k_t * 1e-4;
    const double expected =
        is_static ? std::max(0., stored - 0.5 * 0.25 * t_n * 0.002) : stored - 0.5 * t_n * 0.002;
    const std::string name = is_static ? "statics: " : "dynamics: ";
    check(name + "energy of a spring that is released",
          std::abs(state.friction.dissipated(1., 0.) - expected) / stored, 1e-12);
    check(name + "  its history ends", !node.friction_[0].is_active && node.friction_[0].tangential[0] == 0.);
    node.commit();
    check(name + "  and costs nothing later",
          node.lift(Tensor<1, 3>({0.5, 0., 1.})).friction.dissipated(1., 1.) == 0.);
  }
}

void check_fading() {
  Node node;
  EdgeFading fading{};
  fading.pressure_slope[1] = 2.;
  node.press(at(0.03));
  const Tensor<2, 3> inside = node.state_.tangent;
  node.press(at(0.03), &fading);
  Tensor<2, 3> difference = node.state_.tangent - inside;
  // ∂t/∂p ∂p/∂x: slip along −x, whose limit falls with the pressure beyond the edge.
  difference[0][1] -= coefficient * 2.;
  check("slip beyond an edge: the limit fades with the pressure", difference.norm(), 1e-12);
}

void check_checkpoint() {
  Node node, other;
  node.press(at(0.03));
  node.commit();
  MemoryState saved;
  MemoryWriter writer(saved);
  node.friction_.save(writer, {"", 0, 1, {9}});
  MemoryState empty;
  other.friction_.load(MemoryReader(empty), {"", 0, 1, {9}});
  other.friction_.commit();
  check("a new law begins without traction", !other.friction_[0].is_active);
  other.friction_.load(MemoryReader(saved), {"", 0, 1, {9}});
  other.commit();
  const ToolContactState expected = node.press(at(0.031));
  other.press(at(0.031));
  check("a saved history continues to the last bit",
        other.state_.traction == expected.traction && other.friction_[0].slip == node.friction_[0].slip);
}

} // namespace

BILLET_TEST(tool_friction) {
  check_stick_and_slip();
  check_moving_tool();
  check_entry();
  check_augmentation();
  check_release();
  check_fading();
  check_checkpoint();
}

} // namespace tool_friction_test
