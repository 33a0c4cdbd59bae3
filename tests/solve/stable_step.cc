// SPDX-License-Identifier: LGPL-2.1-or-later
// Stable steps of oscillators with springs and dashpots against closed forms, and what is taken of them.
#include "billet/solve/explicit/stable_step.h"
#include "billet/solve/explicit/crossing_limit.h"

#include "../testing.h"

#include <deal.II/base/mpi.h>

#include <cmath>

namespace stable_step_test {

using billet::CrossingLimit;
using billet::StableStep;
using billet::StepBounds;
using billet::testing::check;

namespace {

/// Returns the stable step of bounds.
double stable_step(const StepBounds &bounds, const double of_tools = 0.) {
  StableStep step(1.);
  step.update(bounds, of_tools, MPI_COMM_SELF);
  return step.value();
}

} // namespace

BILLET_MPI_TEST(stable_step) {
  constexpr double tolerance = 1e-14;
  check("elements alone", std::abs(stable_step({0.5, 0., 0.}) - 0.5), tolerance);
  // Elements with ω = 2/Δt = 4, springs with ω² = 9: ω = 5 together.
  check("springs beside elements", std::abs(stable_step({0.5, 9., 0.}) - 2. / 5.), tolerance);
  check("tools count as springs", std::abs(stable_step({0.5, 4., 0.}, 5.) - 2. / 5.), tolerance);
  {
    // ω² Δt²/4 + Δt c/(2 m) = 1.
    const double rate = 3., step = stable_step({0.5, 0., rate});
    check("dashpots", std::abs(4. * step * step + 0.5 * step * rate - 1.), tolerance);
  }
  {
    StableStep step(0.8);
    check("a sound rank", step.update({0.5, 0., 0.}, 0., MPI_COMM_SELF));
    check("the safety factor", std::abs(step.usual() - 0.4), tolerance);
    step.shorten(0.5);
    check("steps may be shortened", std::abs(step.usual() - 0.2), tolerance);
    check("nodes that come through surfaces", std::abs(step.allowed(0.2) - 0.1), tolerance);
    check("but not to nothing", step.allowed(0.) > 0. && step.allowed(0.) < 0.1);
    check("elements that keep their shape", step.describe_collapse().empty());
    step.update({1e-3, 0., 0.}, 0., MPI_COMM_SELF);
    check("flat elements, but the run may end", step.describe_collapse().empty());
    step.update({1e-9, 0., 0.}, 0., MPI_COMM_SELF);
    check("flat elements", !step.describe_collapse().empty());
    check("a rank that has failed", !step.update({-1., 0., 0.}, 0., MPI_COMM_SELF));
  }
  {
    const auto warns = [](const double part) {
      StableStep step(1.);
      step.update({0.5, 0., 0.}, 0., MPI_COMM_SELF);
      step.update({0.5 * part, 0., 0.}, 0., MPI_COMM_SELF);
      return !step.check_elements(1.).empty();
    };
    check("a small part of the first step shows a flat element", warns(1e-4) && !warns(0.3));
    // Elements with ω = 4, springs that leave a part of their step.
    const auto is_set_by_contact = [](const double part) {
      StableStep step(1.);
      step.update({0.5, 16. / (part * part) - 16., 0.}, 0., MPI_COMM_SELF);
      return step.is_set_by_contact();
    };
    check("contact may make steps much shorter", is_set_by_contact(0.01) && !is_set_by_contact(0.7));
  }
  // Springs k A over which nodes come by d in a step hold ⅛ k A d² of error, (E5), of which the energy
  // allows a part.
  const double step = 0.3, energy = 5.;
  const double all = CrossingLimit::longest_step(step, 8. * energy, energy);
  check("nodes that come through surfaces with all energy shorten the step", all < step);
  check("with four times as much to half of it",
        std::abs(CrossingLimit::longest_step(step, 32. * energy, energy) - 0.5 * all), tolerance);
}

} // namespace stable_step_test
