// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/equilibrium_solver.h"

#include "billet/forces/law_refusals.h"

#include <algorithm>

namespace billet {

NewtonReport EquilibriumSolver::iterate(std::vector<double> &offsets, Vector &displacements) {
  parameters::Solver settings = parts_.parameters().solver;
  if (is_probing_)
    settings.max_iterations = std::min(settings.max_iterations, max_iterations_of_probe);
  return solve(settings, accepts_stalled_, accuracy_, offsets, displacements);
}

NewtonReport EquilibriumSolver::refine(const double factor, std::vector<double> &offsets,
                                       Vector &displacements) {
  parameters::Solver settings = parts_.parameters().solver;
  settings.max_iterations = std::min(settings.max_iterations, max_iterations_of_refinement);
  constexpr bool accepts_stalled = false;
  return solve(settings, accepts_stalled, factor * accuracy_, offsets, displacements);
}

NewtonReport EquilibriumSolver::solve(const parameters::Solver &settings, const bool accepts_stalled,
                                      const double accuracy, std::vector<double> &offsets,
                                      Vector &displacements) {
  const Vector x_n = problem_.unknowns();
  Vector x = parts_.tools().pack(displacements, offsets);
  NewtonReport report =
      solve_newton(problem_, settings, x_n, x, accepts_stalled, accuracy * parts_.scheme().wanted_accuracy());
  if (!parts_.tools().failure().empty() && !report.converged)
    report.failure = parts_.tools().failure();
  else if (!problem_.obstacle().empty() && !report.converged && report.failure.empty())
    report.failure = "the correction is not admissible: " + problem_.obstacle();
  if (!report.converged)
    if (const std::string refusal = find_law_refusal(parts_.parameters(), parts_.communicator());
        !refusal.empty())
      report.failure = refusal;
  problem_.set_trial(x);
  displacements = problem_.step().trial.displacements;
  offsets = parts_.tools().offsets();
  return report;
}

} // namespace billet
