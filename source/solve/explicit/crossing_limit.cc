// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/explicit/crossing_limit.h"

#include <algorithm>
#include <cmath>

namespace billet {

namespace {

struct CrossingLimits {
  /// Maximum error by nodes that come through surfaces in a step, as part of the energy, (E5).
  static constexpr double allowed = 0.0025;
};

} // namespace

double CrossingLimit::longest_step(const double step, const double springs, const double energy) {
  return step * std::sqrt(CrossingLimits::allowed * energy / (0.125 * springs));
}

CrossingLimit::Coming CrossingLimit::at_start(const double stable_step) const {
  // No node has moved yet.
  Coming coming{parts_.forces.crossings(), stable_step, false};
  const NodalVectors &v = parts_.motion.velocities();
  for (const auto &contact : parts_.contacts)
    contact.without_matrix().add_start_crossings(coming.crossings, v, coming.step);
  const bool tools_move = parts_.tools.move_within(coming.step);
  const bool moves = tools_move || std::any_of(v.begin(), v.end(), [](const double c) { return c != 0.; });
  const double near = parts_.forces.max_stiffness(); // bounds on what facets would do
  // Only the first step shows the speed of approaching facets or tools.
  coming.is_unknown = (!parts_.contacts.of_bodies().empty() || tools_move) &&
                      dealii::Utilities::MPI::max(near > 0. ? 1 : 0, parts_.communicator()) *
                              dealii::Utilities::MPI::max(moves ? 1 : 0, parts_.communicator()) >
                          0;
  return coming;
}

void CrossingLimit::update(const double stable_step, const double energy) {
  value_ = std::numeric_limits<double>::infinity();
  if (parts_.contacts.empty())
    return;
  const bool is_at_start = parts_.clock.is_at_start();
  const Coming coming =
      is_at_start ? at_start(stable_step) : Coming{parts_.forces.crossings(), parts_.clock.step(), false};
  if (coming.is_unknown) {
    value_ = 0.;
    return;
  }
  const double springs = dealii::Utilities::MPI::sum(coming.crossings.springs, parts_.communicator());
  if (!(springs > 0.))
    return;
  double fastest = coming.crossings.way / coming.step;
  if (is_at_start) // bodies that slide along a tool are not at rest, whatever the round-off of v n
    for (unsigned int node = 0; node < parts_.nodes.size(); ++node)
      fastest = std::max(fastest, get_vector(parts_.motion.velocities().data(), node).norm());
  const double speed = dealii::Utilities::MPI::max(fastest, parts_.communicator());
  const double mass = parts_.masses.of_bodies() + parts_.masses.added();
  const double scale = std::max(energy, 0.5 * mass * speed * speed);
  value_ = longest_step(coming.step, springs, scale);
}

} // namespace billet
