// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_NEWTON_H
#define BILLET_SOLVE_NEWTON_H

#include "billet/algebra/newton.h"
#include "billet/contact/status_changes.h"
#include "billet/diagnostics.h"
#include "billet/parameters/control.h"
#include "billet/solve/step_failure.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace billet {

/// Balance of forces as a nonlinear system, with the reference values of its residuals.
class NonlinearProblem : public NonlinearSystem {
public:
  double residual_scale() const final { return force_scale(); }
  /// Returns the reference value of the residual at the last x [force].
  virtual double force_scale() const = 0;
  /// Returns the residual of an exact solution that round-off of displacements alone causes
  /// [force].
  virtual double round_off_force() const = 0;
  /// Returns the additional residual by round-off of positions where penalties bear [force].
  virtual double contact_round_off_force() const = 0;
  /// Returns the changes of contact status from the last tangent to the last residual.
  virtual StatusChanges status_changes() const { return {}; }
};

/// Four measures of convergence, eq. (Q1) of doc/theory.md, after an iteration. Each is relative.
struct ConvergenceMeasures {
  double force = 0.;            ///< |R| / F
  double energy = 0.;           ///< |R · δu| / (F |Δu|)
  double correction = 0.;       ///< max |δu| / max |Δu|
  double status = 0.;           ///< part of the contact force at nodes whose contact status changes
  double n_status_changes = 0.; ///< since the last tangent
  bool has_correction = false;  ///< false before the first iteration: then only `force` is known

  /// Returns a text such as "residual 0.03 of the forces (tolerance 0.005), ...". It lists the
  /// residual, the measures above their tolerances, and changes of contact status. `accuracy`:
  /// factor of the tolerances of the residual, its work and the correction.
  std::string describe(const parameters::Solver &tolerances, double accuracy = 1.) const;
};

/// One Newton iteration: the residual it starts from and the correction it makes.
struct NewtonIteration {
  double force;       ///< |R| / force scale
  double energy;      ///< |R · dx| of the full correction [energy]
  double step_length; ///< part of the correction that the line search took
};

struct NewtonReport {
  bool converged = false;
  std::vector<NewtonIteration> iterations;
  double force = 0.;            ///< |R| / force scale at the end
  ConvergenceMeasures measures; ///< at the end
  std::string failure;          ///< why it did not converge
  std::string advice;           ///< against this failure; empty if there is none
  std::string criteria;         ///< measures in words, if the last iteration did not converge
  /// The residual no longer falls, but is small enough for the step to be accepted with a warning.
  bool is_stalled = false;
  /// Round-off of contact exceeds its permitted part of the forces: residuals come no nearer to
  /// their tolerance.
  bool is_lost_in_round_off = false;
  bool is_cycling = false; ///< it did not converge: is_cycling()
  bool is_slow = false;    ///< it did not converge: it would need too many iterations
  /// Reason to reject the step; none: it is accepted, or the iterations are the cause of `failure`.
  std::optional<StepFailure::Kind> rejection;
  unsigned int linear_iterations = 0;
  DiagnosticList diagnostics; ///< messages for the user
  /// Maximum number of iterations of the solutions that were appended. It controls the step length:
  /// each of many augmentations may be easy.
  std::size_t hardest = 0;

  /// Whether the iterations are not the cause of `failure`, so that others do not help.
  bool is_explained() const { return rejection == StepFailure::Kind::explained; }
  /// Makes this the report of a step that is rejected.
  void reject(const StepFailure &because) {
    converged = false;
    rejection = because.kind;
    failure = because.why.what;
    advice = because.why.advice;
  }
  /// Appends the report of a later solution, whose results count; its iterations are added.
  void append(const NewtonReport &next) {
    converged = next.converged;
    failure = next.failure;
    advice = next.advice;
    is_lost_in_round_off = next.is_lost_in_round_off;
    is_cycling = next.is_cycling;
    is_slow = next.is_slow;
    rejection = next.rejection;
    is_stalled = next.is_stalled;
    criteria = next.criteria;
    measures = next.measures;
    force = next.force;
    linear_iterations += next.linear_iterations;
    billet::append(diagnostics, next.diagnostics);
    iterations.insert(iterations.end(), next.iterations.begin(), next.iterations.end());
    hardest = std::max(hardest, next.hardest);
  }
  /// Appends the report of a repetition of the step, whose `hardest` replaces the present one.
  void append_anew(const NewtonReport &next) {
    append(next);
    hardest = next.hardest;
  }
};

/// Whether the last residuals rise and fall and repeat those of two to four iterations before:
/// Newton's method cycles between the same states.
bool is_cycling(const std::vector<NewtonIteration> &iterations);

/// Limits of the iterations that other classes know.
struct NewtonLimits {
  /// Maximum part of the force scale that round-off of contact penalties may leave as residual.
  /// Below it forces are as exact as contact by penalties permits, and two digits better than
  /// noise. Above it they no longer represent the scene.
  static constexpr double max_round_off = 0.005;
  /// Maximum residual over the estimate of round-off of contact penalties that is still due to it.
  static constexpr double near_round_off = 10.;
  /// Maximum residual, as part of the forces, up to which a stalled step is accepted with a
  /// warning, ...
  static constexpr double max_stalled_residual = 0.02;
  /// ... if the last correction is at most this part of the step's increment. A larger correction
  /// indicates an unconstrained motion.
  static constexpr double max_stalled_correction = 0.03;
  /// Residual, as part of the forces, below which neither a small correction nor an unchanged
  /// contact status is required. Newton's method would change the state by about this part, and
  /// contact is already in balance.
  static constexpr double exact_residual = 5e-6;
};

/// Whether the smallest of the last residuals is hardly smaller than the smallest of those before.
bool is_stagnant(const std::vector<NewtonIteration> &iterations, double last_force, std::size_t window);

/// Solves by Newton's method. Starts from, and overwrites, `x`; the step's increment is x − x_n. If
/// the iterations stall close to balance, they converge if `accepts_stalled`, else they fail;
/// `is_stalled` is set in both cases. `accuracy`: factor of the tolerances of the residual, its
/// work and the correction.
NewtonReport solve_newton(NonlinearProblem &problem, const parameters::Solver &settings, const Vector &x_n,
                          Vector &x, bool accepts_stalled = true, double accuracy = 1.);

} // namespace billet

#endif
