// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_UNNEEDED_COSTS_H
#define BILLET_RUN_UNNEEDED_COSTS_H

#include "billet/diagnostics.h"
#include "billet/solve/run_review.h"

namespace billet {

/// Costs of a run, and those of them that the scene has used.
struct RunCosts {
  double all = 0.; ///< wall-clock time [s], as those below
  double unsymmetric_matrix = 0., self_contact = 0., fields = 0., error_control = 0., limited_steps = 0.;
  bool slides = false;               ///< whether friction has dissipated energy
  bool self_contact_touches = false; ///< whether any surface has touched itself
  /// Estimated error of the steps, and the target for all errors.
  double steps_error = 0., target = 0.;
};

/// Whether a symmetrised contact tangent makes the matrix symmetric. It does if friction makes it
/// unsymmetric, and neither a load, such as a following pressure, nor an exact material tangent
/// does.
bool helps_symmetrised_contact(const Scene &scene);

/// Returns the costs of this process so far, without error and target. An unsymmetric matrix counts
/// only if a symmetrised contact tangent helps.
RunCosts collect_costs(const Scene &scene, const Solution &solution, const RunReview &review);

/// Returns a note that lists, in seconds, what the scene paid for and did not need. Returns nothing
/// if that is no more than a tenth of the time and a second. Such costs are:
/// - an unsymmetric matrix where nothing slides, of whose factorisation a symmetric one takes half;
/// - self-contact of surfaces that never touch;
/// - output of fields;
/// - steps whose error is a tenth of what a target error allows: comparing them, and half of those
///   of the scene's own 'Maximum step'.
DiagnosticList find_unneeded_costs(const RunCosts &costs);

} // namespace billet

#endif
