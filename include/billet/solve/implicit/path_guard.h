// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_PATH_GUARD_H
#define BILLET_SOLVE_IMPLICIT_PATH_GUARD_H

#include "billet/solve/implicit/implicit_problem.h"
#include "billet/solve/motion_watch.h"

namespace billet {

/// Rejects steps whose ends do not show the motion between them: nodes pass through tools or
/// bodies, tools rotate too far, or prescribed motions oscillate. All members are collective.
class PathGuard {
public:
  explicit PathGuard(ImplicitProblem &problem)
      : problem_(problem), motions_(parts_.scene(), parts_.supports(), parts_.discretization()) {}

  /// Whether steps to t may be cut.
  bool may_be_cut(double t) const;

  // Each returns a failure of the step in the case that it names.
  /// Nodes have passed through a tool that is thinner than their facets.
  std::optional<StepFailure> judge_thin_tools() const;
  /// Nodes pass through anything between the start of the step and the trial state.
  std::optional<StepFailure> judge_path(bool is_thorough);
  /// A tool in contact with friction rotates so far in the step that slip has no direction.
  std::optional<StepFailure> judge_turns(double t) const;
  /// A prescribed motion oscillates or turns within the step unseen, and the step can be cut.
  std::optional<StepFailure> judge_prescribed_motion(double t) const;
  /// In dynamics, nodes approach so far in the step of first contact that the motion after the
  /// contact is unknown.
  std::optional<StepFailure> judge_first_contact(double t) const;

  /// Returns messages about such prescribed motions if steps cannot be cut.
  DiagnosticList check_motion(double t) const;

private:
  struct Limits {
    /// Maximum rotation of a tool in a step [rad]. By the chord of an arc of 15 degrees the moment
    /// of friction is 0.9 % too small.
    static constexpr double max_turn = M_PI / 12.;
    /// Maximum approach of nodes in the step of first contact, as part of their facets.
    static constexpr double max_closing = 0.1;
    static constexpr double rounding = 1e-9;
  };

  ImplicitProblem &problem_;
  ImplicitParts &parts_ = problem_.parts();
  MotionWatch motions_;
};

} // namespace billet

#endif
