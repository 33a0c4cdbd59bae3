// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_NEWTON_H
#define BILLET_SOLVE_NEWTON_H

#include "billet/algebra/newton.h"
#include "billet/contact/status_changes.h"
#include "billet/diagnostics.h"
#include "billet/parameters/control.h"

#include <algorithm>
#include <string>
#include <vector>

namespace billet {

/// Balance of forces as a nonlinear system, and what its residuals are small against.
class NonlinearProblem : public NonlinearSystem {
public:
  double residual_scale() const final { return force_scale(); }
  /// What a residual is small against, at the last x [force].
  virtual double force_scale() const = 0;
  /// The residual of an exact solution, from round-off of displacements alone [force].
  virtual double round_off_force() const = 0;
  /// What round-off of positions makes of it besides, where penalties bear [force].
  virtual double contact_round_off_force() const = 0;
  /// Changes of contact status from the last tangent to the last residual.
  virtual StatusChanges status_changes() const { return {}; }
};

/// The four measures of convergence, eq. (Q1) of doc/theory.md, after an iteration. Each is relative.
struct ConvergenceMeasures {
  double force = 0.;            ///< |R| / F
  double energy = 0.;           ///< |R · δu| / (F |Δu|)
  double correction = 0.;       ///< max |δu| / max |Δu|
  double status = 0.;           ///< part of the contact force that changes of contact status carry
  double n_status_changes = 0.; ///< since the last tangent
  bool has_correction = false;  ///< false before the first iteration: then only `force` is known

  /// "residual 0.03 of the forces (tolerance 0.005), ...": those that are above their tolerances, or all.
  std::string describe(const parameters::Solver &tolerances) const;
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
  std::string criteria; ///< after an iteration that was the last without convergence: measures, in words
  /// The residual no longer falls, but is small enough for the step to be accepted with a warning.
  bool is_stalled = false;
  bool makes_energy = false; ///< of the step: it converged, but contact makes energy in it
  bool penetrates = false;   ///< of the step: it converged, but penalties let nodes in too deep
  /// Contact's round-off leaves more of the forces than it may: residuals come no nearer to their tolerance.
  bool is_lost_in_round_off = false;
  bool goes_round = false;   ///< it did not converge: go_round()
  bool is_explained = false; ///< `failure` says what to do, too, and it is not the iterations' fault
  unsigned int linear_iterations = 0;
  DiagnosticList diagnostics; ///< messages for the user
  /// Iterations of the hardest of the solutions that were appended: what the length of a step is ruled by.
  /// Each of many augmentations may be easy.
  std::size_t hardest = 0;

  /// What came after it counts; its iterations are added.
  void append(const NewtonReport &next) {
    converged = next.converged;
    failure = next.failure;
    makes_energy = next.makes_energy;
    penetrates = next.penetrates;
    is_lost_in_round_off = next.is_lost_in_round_off;
    goes_round = next.goes_round;
    is_explained = next.is_explained;
    is_stalled = next.is_stalled;
    criteria = next.criteria;
    measures = next.measures;
    force = next.force;
    linear_iterations += next.linear_iterations;
    billet::append(diagnostics, next.diagnostics);
    iterations.insert(iterations.end(), next.iterations.begin(), next.iterations.end());
    hardest = std::max(hardest, next.hardest);
  }
  /// The same of a step that was begun anew.
  void append_anew(const NewtonReport &next) {
    append(next);
    hardest = next.hardest;
  }
};

/// Whether the last residuals rise and fall, and are those of two to four iterations before, again and again:
/// Newton's method goes to and fro between the same states.
bool go_round(const std::vector<NewtonIteration> &iterations);

/// Part of the force scale that round-off of contact's penalties may leave as residual: forces are then as
/// exact as users of contact by penalties may hope for, and two digits better than noise. Above that they are
/// not what the scene asks for.
constexpr double most_round_off = 0.005;

/// A step whose residual no longer falls is accepted with a warning up to this part of the forces, ...
constexpr double max_stalled_residual = 0.02;
/// ... if the last correction is at most this part of the step's increment: what still moves by more is
/// not held.
constexpr double max_stalled_correction = 0.03;

/// A residual below this part of the forces needs neither a small correction nor an unchanged contact
/// status: Newton's method would change the state by about this part, and the contact is in balance as it
/// is.
constexpr double exact_residual = 5e-6;

/// Whether the best of the last residuals is hardly better than the best of those before.
bool is_stagnant(const std::vector<NewtonIteration> &iterations, double last_force, std::size_t window);

/// The loosest relative tolerance of a linear system.
constexpr double largest_forcing_term = 1e-2;

/// Newton's method. Starts from, and overwrites, `x`; the step's increment is x − x_n. Where the
/// iterations stall near enough to balance, they converge if `accepts_stalled`, and fail if not; `is_stalled`
/// says so in both cases.
NewtonReport solve_newton(NonlinearProblem &problem, const parameters::Solver &settings, const Vector &x_n,
                          Vector &x, bool accepts_stalled = true);

} // namespace billet

#endif
