// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_ALGEBRA_NEWTON_H
#define BILLET_ALGEBRA_NEWTON_H

#include "billet/algebra/vector.h"

#include <functional>

namespace billet {

/// Nonlinear system R(x) = 0 with its tangent K = ∂R/∂x. All members are collective and return the
/// same on all ranks; false means that the state is not admissible. Residuals and corrections are
/// written in place: they have the layout of x, and keep it.
class NonlinearSystem {
public:
  virtual ~NonlinearSystem() = default;
  virtual bool compute_residual(const Vector &x, Vector &residual) = 0;
  virtual bool compute_tangent(const Vector &x) = 0;
  /// Computes dx = K⁻¹ residual, so that |residual − K dx| <= relative_tolerance |residual| if the
  /// solver is iterative.
  virtual bool solve_tangent(const Vector &residual, Vector &dx, double relative_tolerance) = 0;
  /// Returns the largest part of a correction that may be taken from x; 0 if it must not be taken
  /// at all.
  virtual double max_step_length(const Vector & /*x*/, const Vector & /*direction*/) { return 1.; }
  /// Returns the reference value of the residual at the last x.
  virtual double residual_scale() const = 0;
};

/// State of Newton's method, and the residual there.
struct NewtonState {
  const Vector &x, &residual;
  double norm;  ///< |R|
  double scale; ///< reference value of R
};

/// Last correction of Newton's method.
struct NewtonCorrection {
  NewtonState from;
  const Vector &full; ///< −K⁻¹ R, of which the line search may have taken a part
};

enum class NewtonVerdict { unconverged, converged, failed };

/// Judges the iterations by the number of corrections so far, the present state, and the last
/// correction, which is null at the start. Collective.
using NewtonJudge =
    std::function<NewtonVerdict(unsigned int n, const NewtonState &now, const NewtonCorrection *last)>;

struct NewtonOptions {
  /// Part of the scale; no linear solution is more accurate than half of that.
  double residual_tolerance;
  /// Tolerance of linear solutions; with `adapts_tolerance` the smallest one.
  double linear_tolerance;
  double max_linear_tolerance = 1e-2; ///< the loosest, with `adapts_tolerance`
  /// Whether linear tolerances follow the convergence of the iterations, after Eisenstat and
  /// Walker.
  bool adapts_tolerance = false;
  /// Line search: whether it shortens corrections at whose end the residual does more work.
  bool searches_lines = false;
};

enum class NewtonEnd {
  converged,
  failed, ///< as judged, or no admissible correction was found
  not_admissible_at_start
};

/// Solves by Newton's method, from x, and overwrites x by the last state; x is unchanged if no
/// correction was found. Collective.
NewtonEnd solve_by_newton(NonlinearSystem &system, const NewtonOptions &options, const NewtonJudge &judge,
                          Vector &x);

} // namespace billet

#endif
