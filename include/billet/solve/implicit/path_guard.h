// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_PATH_GUARD_H
#define BILLET_SOLVE_IMPLICIT_PATH_GUARD_H

#include "billet/solve/implicit/implicit_problem.h"
#include "billet/solve/motion_watch.h"

namespace billet {

/// Rejects steps whose ends do not show what happens on the way: nodes that would go through tools or bodies,
/// tools that turn too far, prescribed motions to and fro. All members are collective.
class PathGuard {
public:
  explicit PathGuard(ImplicitProblem &problem)
      : problem_(problem), motions_(problem.scene(), problem.supports(), problem.discretization()) {}

  /// Whether steps to t may become smaller.
  bool may_be_cut(double t) const;

  // Each fails the step where it is true:
  /// Nodes have gone through a tool that is thinner than their facets.
  bool goes_through_thin_tool(NewtonReport &report) const;
  /// Nodes go through anything on their ways from the start of the step to the trial state.
  bool goes_through(bool is_thorough, NewtonReport &report);
  /// A tool that touches with friction turns by so much from the start of the step to its end that slip has
  /// no direction.
  bool turns_too_far(double t, NewtonReport &report) const;
  /// A prescribed motion does in the step what its ends do not show, and the step can be cut.
  bool skips_motion(double t, NewtonReport &report) const;
  /// In dynamics: nodes close by so much, in the step in which they begin to press, that what happens after
  /// the touch is unknown.
  bool meets_too_early(double t, NewtonReport &report) const;

  /// Messages about prescribed motions where steps cannot be cut.
  DiagnosticList check_motion(double t) const;

private:
  struct Limits {
    /// Turn of a tool in a step [rad]: by the chord of an arc of 15 degrees the moment of friction is 0.9 %
    /// too small.
    static constexpr double max_turn = M_PI / 12.;
    /// By which nodes may close in the step in which they touch, as part of their facets.
    static constexpr double max_closing = 0.1;
    static constexpr double rounding = 1e-9;
  };

  ImplicitProblem &problem_;
  MotionWatch motions_;
};

} // namespace billet

#endif
