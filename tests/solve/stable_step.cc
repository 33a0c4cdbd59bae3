// SPDX-License-Identifier: LGPL-2.1-or-later
// Stable steps of oscillators with springs and dashpots against closed forms, and what is taken of them.
#include "billet/solve/explicit/stable_step.h"

#include "../testing.h"

#include <deal.II/base/mpi.h>

#include <cmath>

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

int main(int argc, char **argv) {
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
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
    check("but not much", std::abs(step.allowed(0.) - 0.05), tolerance);
    check("elements that keep their shape", step.describe_collapse().empty());
    step.update({4e-6, 0., 0.}, 0., MPI_COMM_SELF);
    check("flat elements", !step.describe_collapse().empty());
    check("a rank that has failed", !step.update({-1., 0., 0.}, 0., MPI_COMM_SELF));
  }
  return billet::testing::exit_code();
}
