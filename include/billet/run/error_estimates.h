// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_ERROR_ESTIMATES_H
#define BILLET_RUN_ERROR_ESTIMATES_H

#include "billet/output/error_report.h"
#include "billet/output/history_file.h"
#include "billet/run/run_output.h"
#include "billet/solve/energy_errors.h"
#include "billet/solve/error_watch.h"
#include "billet/solve/mesh_errors.h"
#include "billet/solve/run_review.h"

namespace billet {

/// Returns the estimate of a static run, with its costs.
ErrorReport make_report(const ErrorWatch &watch, const StepReport &report);

/// Returns the estimate of a dynamic run, without costs. `shorter_steps`: the advice that reduces
/// the errors of steps.
ErrorReport make_report(const EnergyErrors &errors, const std::string &shorter_steps);

/// Adds the errors of elements and soft contact, reports the estimate, and writes
/// error_estimate.csv. Collective.
void report_errors(ErrorReport report, const MeshErrors &mesh, const Discretization &discretization,
                   const parameters::Scene &parameters, const RunReview &review, RunOutput &output);

/// Returns the message on the errors of the mesh at the end of a run; none if nothing has deformed.
/// If the mesh does not resolve the contact, the message says that the error is unknown.
DiagnosticList describe_mesh_errors(const MeshErrors &mesh, const RunReview &review,
                                    const parameters::Scene &parameters);

} // namespace billet

#endif
