// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_STEP_DIAGNOSIS_H
#define BILLET_SOLVE_IMPLICIT_STEP_DIAGNOSIS_H

#include "billet/solve/implicit/implicit_problem.h"

#include <string>
#include <vector>

namespace billet {

/// Explains where and why a step failed, or stalled.
class StepDiagnosis {
public:
  explicit StepDiagnosis(ImplicitProblem &problem) : problem_(problem) {}

  /// At the end of a step: finds tools whose load friction bears, and that slip nearly all over. Collective.
  void commit();
  /// Reasons of a failed step: nodes that cycle, tools that slipped. Collective.
  std::string describe_contacts() const;
  /// Where the residual of a failed step is largest. Collective.
  std::string describe_residual();
  /// The warning about a step that was accepted although its iterations stalled.
  Diagnostic describe_stall(const NewtonReport &report) const;

private:
  struct Limits {
    /// Part of what touches that slips, and of the load that pressure bears.
    static constexpr double nearly_all = 0.9, by_pressure = 0.5;
  };
  std::string describe_slipping_tools() const;

  ImplicitProblem &problem_;
  std::vector<std::size_t> slipping_tools_; ///< at the end of the last accepted step
};

} // namespace billet

#endif
