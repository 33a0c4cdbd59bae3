// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/explicit/explicit_reactions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace billet {

using dealii::Tensor;

namespace {

struct ExplicitReactionsLimits {
  /// Force by round-off of displacements over that by the last bit of a displacement of the scene's
  /// size.
  static constexpr double last_bits = 100.;
};

/// Returns the force by round-off of displacements.
double find_round_off_force(const ExplicitParts &parts) {
  double stiffest = 0.;
  for (const auto &body : parts.scene.bodies())
    stiffest = std::max(stiffest, body.max_modulus);
  const double last_bit = parts.settings().number_type == NumberType::float_precision
                              ? double{std::numeric_limits<float>::epsilon()}
                              : std::numeric_limits<double>::epsilon();
  return ExplicitReactionsLimits::last_bits * last_bit * stiffest * parts.discretization.radius() *
         parts.discretization.radius();
}

/// Returns the sum of the magnitudes of the components.
double l1_norm(const Tensor<1, 3> &v) { return std::abs(v[0]) + std::abs(v[1]) + std::abs(v[2]); }

} // namespace

ExplicitReactions::ExplicitReactions(const ExplicitParts &parts)
    : parts_(parts), supports_(parts.scene, parts.discretization, parts.motion.acting()),
      round_off_(find_round_off_force(parts)) {
  values_.of_supports.resize(named_supports(parts.scene).size());
  values_.of_tool_pairs.resize(parts.scene.pairs().size());
  values_.between_nodes.resize(parts.scene.pairs().size());
}

void ExplicitReactions::update() {
  const ExplicitMotion &motion = parts_.motion;
  supports_.follow(motion.acting());
  const SupportReactions::Forces forces =
      supports_.compute(parts_.nodes, motion.support_forces(), motion.displacements());
  values_.of_supports = forces.of_supports;
  values_.balance = {};
  values_.balance.round_off = round_off_;
  // Constraints act along their normals alone, so that the second is round-off.
  values_.balance.free = -forces.free;
  for (const Resultant &resultant : values_.of_supports)
    values_.balance.reactions += resultant.force;
  for (std::size_t i = 0; i < values_.of_tool_pairs.size(); ++i) {
    const ContactLoad load = sum_over_ranks(parts_.tools.pair_load(i), parts_.communicator());
    values_.of_tool_pairs[i] = about_origin(load, parts_.tools[parts_.scene.pairs()[i].tool].now());
    values_.between_nodes[i] = parts_.contacts.of_tools()[i].measures().penetration_between_nodes();
    values_.balance.contact += load.force;
  }
  values_.of_loads = parts_.forces.of_loads().results();
  sum_forces();
  add_fading_tools();
  if (motion.acting().may_change())
    add_fading_supports();
}

void ExplicitReactions::add_fading_tools() {
  const double t = parts_.clock.time();
  const NodalVectors &u = parts_.motion.displacements();
  for (std::size_t tool = 0; tool < parts_.tools.size(); ++tool)
    if (parts_.tools.is_fading(tool, t)) {
      const ContactLoad load = sum_over_ranks(parts_.tools.fading_load(tool, t, u), parts_.communicator());
      values_.balance.contact += load.force;
      values_.balance.loads -= load.force;
    }
  for (std::size_t i = 0; i < values_.of_tool_pairs.size(); ++i)
    if (const std::size_t tool = parts_.scene.pairs()[i].tool; parts_.tools.is_fading(tool, t))
      values_.of_tool_pairs[i] +=
          about_origin(sum_over_ranks(parts_.tools.fading_load(tool, t, u, i), parts_.communicator()),
                       parts_.tools[tool].now());
}

void ExplicitReactions::add_fading_supports() {
  std::vector<Resultant> fading(values_.of_supports.size());
  parts_.motion.add_fading(parts_.clock.time(), fading);
  sum_over_ranks(fading, parts_.communicator());
  for (std::size_t s = 0; s < fading.size(); ++s) {
    values_.of_supports[s].force += fading[s].force;
    values_.of_supports[s].moment += fading[s].moment;
    values_.balance.reactions += fading[s].force;
    values_.balance.loads -= fading[s].force;
  }
}

void ExplicitReactions::sum_forces() {
  const ExplicitMotion &motion = parts_.motion;
  const ExplicitClock &clock = parts_.clock;
  const double duration = clock.is_at_start() ? clock.step() : 0.5 * (clock.step_before() + clock.step());
  Tensor<1, 3> loads, inertia;
  double size = 0.;
  for (const unsigned int node : parts_.forces.loaded_nodes()) {
    const Tensor<1, 3> force = get_vector(parts_.forces.external().data(), node);
    loads += force;
    size += l1_norm(force);
  }
  for (unsigned int node = 0; node < parts_.nodes.size(); ++node) {
    if (!parts_.nodes.is_owned(node))
      continue;
    const Tensor<1, 3> v = get_vector(motion.velocities().data(), node),
                       v_before = get_vector(motion.velocities_before().data(), node);
    const double factor = parts_.masses.values()[node] / duration;
    inertia -= factor * (v - v_before);
    // The last bits of these are round-off of the accelerations.
    size += factor * (l1_norm(v) + l1_norm(v_before));
    size += l1_norm(get_vector(motion.support_forces().data(), node));
  }
  const std::array<double, 7> own{loads[0], loads[1], loads[2], inertia[0], inertia[1], inertia[2], size};
  std::array<double, 7> sums{};
  dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(own.data(), own.size()), parts_.communicator(),
                              dealii::ArrayView<double>(sums.data(), sums.size()));
  ForceBalance &balance = values_.balance;
  for (unsigned int i = 0; i < 3; ++i) {
    balance.loads[i] = sums[i];
    balance.inertia[i] = sums[3 + i];
  }
  balance.size = sums[6];
  for (const ContactLoad &load : values_.of_tool_pairs)
    balance.size += load.force.norm();
}

} // namespace billet
