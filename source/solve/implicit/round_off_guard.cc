// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/round_off_guard.h"

#include "billet/diagnostic_kinds.h"

#include <algorithm>
#include <sstream>

namespace billet {

std::optional<StepFailure> RoundOffGuard::judge(const double t, const NewtonReport &report) const {
  const bool is_last = t >= parts_.parameters().time_stepping.end_time;
  if (!report.is_lost_in_round_off || (n_lost_ < Limits::max_lost_steps && !is_last))
    return {};
  return StepFailure{StepFailure::Kind::round_off, {report.failure, report.advice}};
}

void RoundOffGuard::commit(const double t, const NewtonReport &report) {
  n_lost_ = report.is_lost_in_round_off ? n_lost_ + 1 : 0;
  watch_.add(t, problem_.contact_round_off_force(), problem_.force_scale());
}

Explanation RoundOffGuard::describe(const double part) const {
  std::ostringstream text;
  text.precision(2);
  text << "round-off limits the residual to " << part << " of the forces; allowed is "
       << NewtonLimits::max_stalled_residual << ". The penalty of contact pair "
       << parts_.contacts().stiffest_pairs()
       << " is too high for such small displacements and sixteen digits";
  return {text.str(), "Try a lower penalty, with a 'Penetration tolerance' if penetration is then too large, "
                      "or bodies nearer to the origin"};
}

bool RoundOffGuard::may_explain(const NewtonReport &report) const {
  if (is_balanced_by_inertia_ || report.iterations.empty() ||
      !(report.force > 0.)) // there may be no residual
    return false;
  const double springs = problem_.scales().spring_round_off, forces = problem_.force_scale();
  return springs > NewtonLimits::max_round_off * forces &&
         report.force * forces <= NewtonLimits::near_round_off * springs;
}

DiagnosticList RoundOffGuard::check(const double part, const double accuracy) const {
  const double tolerance = parts_.parameters().solver.force_tolerance * std::max(1., accuracy);
  // Bodies without loads, or in free flight, have no forces except round-off.
  const bool is_loaded =
      !is_balanced_by_inertia_ && problem_.force_scale() > Limits::unloaded * problem_.scales().round_off;
  // Round-off of contact is reported at the end; see finish().
  const bool is_of_contact = problem_.contact_round_off_force() > tolerance * problem_.force_scale();
  if (!is_loaded || is_of_contact || part <= std::max(tolerance, notable_round_off))
    return {};
  std::ostringstream text;
  text.precision(2);
  text << "Round-off in the displacements limits the residual to " << part
       << " of the forces; 'Force tolerance' is " << tolerance
       << ". The forces are small relative to the stiffness of the bodies";
  return {Diagnostic(diagnostic::round_off_limits_forces, text.str())
              .time(problem_.step().time)
              .measure("part of the forces", part)
              .advice("Place bodies nearer to the origin, or choose moduli less far apart")};
}

DiagnosticList RoundOffGuard::finish() const {
  return watch_.finish(parts_.parameters().solver.force_tolerance, is_balanced_by_inertia_);
}

} // namespace billet
