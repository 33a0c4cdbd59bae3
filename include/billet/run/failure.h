// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_FAILURE_H
#define BILLET_RUN_FAILURE_H

#include "billet/output/history_file.h"
#include "billet/solve/explicit/explicit_dynamics.h"

namespace billet {

/// Returns sentences, without the last full stop, if a prescribed force or moment may exceed the
/// limit load of a body without hardening. Otherwise returns an empty text.
std::string describe_limit_load(const parameters::Scene &parameters);

/// Whether a yielding body has elastic strains so large that its law, unlike Hencky's, computes the
/// dissipation inexactly. Collective.
bool has_inexact_dissipation(const Scene &scene, const Discretization &discretization,
                             const Solution &solution);

/// Explains why an implicit run fails in the step between these times. `is_unstable`: a body is
/// strained beyond the stability of its law.
Diagnostic explain_failed_step(const Scene &scene, const StepReport &report, double from, double to,
                               bool is_unstable);

/// Explains why an implicit run ends because of this energy imbalance.
Diagnostic explain_imbalance(const parameters::Scene &parameters, const StepReport &report, double time,
                             const Explanation &imbalance);

/// Explains why an explicit run ends with energies that fail to balance or are not finite. `advice`
/// replaces the usual advice unless it is empty.
Diagnostic explain_drift(const Scene &scene, const ExplicitDynamics &problem, const std::string &advice);

/// Explains why an explicit run ends with a step that failed for this reason.
Diagnostic explain_failed_step(const Scene &scene, const ExplicitDynamics &problem, const Diagnostic &reason,
                               bool is_unstable);

} // namespace billet

#endif
