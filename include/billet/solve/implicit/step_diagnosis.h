// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_STEP_DIAGNOSIS_H
#define BILLET_SOLVE_IMPLICIT_STEP_DIAGNOSIS_H

#include "billet/solve/implicit/implicit_problem.h"

#include <string>
#include <vector>

namespace billet {

/// Explains failed and stalled steps.
class StepDiagnosis {
public:
  explicit StepDiagnosis(ImplicitProblem &problem) : problem_(problem) {}

  /// Finds tools whose load friction bears and that slip on nearly their whole contact, at the end
  /// of a step. Collective.
  void commit();
  /// Returns reasons of a failed step: nodes that cycle, now or in an earlier attempt since the
  /// last accepted step, and tools in full sliding. Collective.
  Explanation describe_contacts();
  /// Returns the location of the largest residual of a failed step. Collective.
  Explanation describe_residual();
  /// Returns the warning about a step that was accepted although its iterations stalled.
  Diagnostic describe_stall(const NewtonReport &report) const;

private:
  struct Limits {
    /// Slipping part of the contact, and part of the load that pressure bears.
    static constexpr double nearly_all = 0.9, by_pressure = 0.5;
  };
  Explanation describe_slipping_tools() const;

  ImplicitProblem &problem_;
  ImplicitParts &parts_ = problem_.parts();
  std::vector<std::size_t> slipping_tools_; ///< at the end of the last accepted step
  Explanation restless_;                    ///< nodes that cycled in the last attempt that had some
};

} // namespace billet

#endif
