// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_EQUILIBRIUM_SOLVER_H
#define BILLET_SOLVE_IMPLICIT_EQUILIBRIUM_SOLVER_H

#include "billet/solve/implicit/implicit_problem.h"

#include <vector>

namespace billet {

/// Newton's method from the first guess of a step. The scene, the required accuracy and the purpose
/// of the step determine its tolerances.
class EquilibriumSolver {
public:
  explicit EquilibriumSolver(ImplicitProblem &problem) : problem_(problem) {}

  /// Iterates from these displacements and offsets of the tools, and overwrites them. Collective.
  NewtonReport iterate(std::vector<double> &offsets, Vector &displacements);

  /// Continues from a solution with tolerances that are smaller by this factor, in a limited number
  /// of iterations. Collective.
  NewtonReport refine(double factor, std::vector<double> &offsets, Vector &displacements);

  /// Returns the factor of the tolerances of residuals and their work; in (0, 1].
  double accuracy() const { return accuracy_; }
  void set_accuracy(const double factor) { accuracy_ = factor; }
  /// Whether iterations that stall near balance converge.
  bool accepts_stalled() const { return accepts_stalled_; }
  void accept_stalled(const bool accepts) { accepts_stalled_ = accepts; }
  /// Whether the step is a probe, which is not accepted.
  bool is_probing() const { return is_probing_; }
  void set_probing(const bool is_probing) { is_probing_ = is_probing; }

private:
  /// Maximum number of iterations of a probe, which limits its cost.
  static constexpr unsigned int max_iterations_of_probe = 8;
  /// Maximum number of iterations of refine().
  static constexpr unsigned int max_iterations_of_refinement = 10;

  NewtonReport solve(const parameters::Solver &settings, bool accepts_stalled, double accuracy,
                     std::vector<double> &offsets, Vector &displacements);

  ImplicitProblem &problem_;
  ImplicitParts &parts_ = problem_.parts();
  double accuracy_ = 1.;
  bool accepts_stalled_ = false, is_probing_ = false;
};

} // namespace billet

#endif
