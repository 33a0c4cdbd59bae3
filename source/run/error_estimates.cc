// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/error_estimates.h"

#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"
#include "billet/run/stopwatch.h"

#include <algorithm>
#include <sstream>

namespace billet {

ErrorReport make_report(const ErrorWatch &watch, const StepReport &report) {
  const ErrorWatch::EstimatedError estimated_error = watch.estimated_error();
  const ErrorControl::Estimate &estimate = estimated_error.estimate;
  ErrorReport result;
  result.of_what = estimated_error.of_what;
  result.since = estimated_error.since;
  result.is_known = estimated_error.has_results;
  result.sources = {
      {"steps", estimate.steps,
       "Reduce 'Maximum step' or 'Initial step': the run rejects no step for its error, and the estimate is "
       "conservative where contacts open and close",
       !watch.measures_steps() || watch.n_measurements() > 0},
      {"penetrations", estimate.penetration,
       watch.controls_penetration()
           ? "Reduce 'Initial step', or set a 'Penetration tolerance' in every pair: penetration at first "
             "contact is measured after the step"
           : "Increase 'Normal penalty', or let 'Target error' set 'Penetration tolerance' in all pairs",
       !watch.measures_penetration() || estimated_error.knows_penetration},
      {"iterations", estimate.iterations, "Reduce 'Force tolerance'"}};
  result.costs = {{"steps taken", report.step},
                  {"Newton iterations", report.total_iterations},
                  {"of them for estimates", watch.n_iterations()}};
  return result;
}

ErrorReport make_report(const EnergyErrors &errors, const std::string &shorter_steps) {
  ErrorReport result;
  result.of_what = "energies";
  result.since = errors.start();
  result.is_known = errors.has_energies();
  result.sources = {{"steps", errors.steps(), shorter_steps},
                    {"penetrations", errors.penetration(), "Increase 'Normal penalty'"}};
  return result;
}

void report_errors(ErrorReport report, const MeshErrors &mesh, const Discretization &discretization,
                   const parameters::Scene &parameters, const RunReview &review, RunOutput &output) {
  report.target = parameters.target_error;
  if (review.element_error() > 0.)
    report.sources.push_back(
        {"elements", review.element_error(), "Choose the element that the warnings name"});
  if (review.penalty_error() > 0.)
    report.sources.push_back(
        {"soft contact", review.penalty_error(), "Increase the penalties that the warnings name"});
  report.mesh = mesh.error();
  report.is_mesh_known = mesh.sees_variation() && review.describe_unresolved().empty();
  report.mesh_target = parameters.mesh_target.error;
  report.costs.emplace_back("CPU seconds",
                            dealii::Utilities::MPI::sum(processor_time(), discretization.communicator()));
  output.report(report.diagnostics());
  output.write_estimate(report);
}

DiagnosticList describe_mesh_errors(const MeshErrors &mesh, const RunReview &review,
                                    const parameters::Scene &parameters) {
  constexpr double rounding = 1e-6;
  if (!(mesh.error() > rounding) && mesh.sees_variation())
    return {};
  std::ostringstream text;
  text.precision(2);
  text << "By the jumps of stress between elements, their size makes an error of about "
       << 100. * mesh.error() << " % of the forces";
  const std::vector<double> parts = mesh.of_bodies();
  for (std::size_t body = 0; parts.size() > 1 && body < parts.size(); ++body)
    text << (body == 0 ? ": " : ", ") << "body '" << parameters.bodies[body].name << "' "
         << 100. * parts[body] << " %";
  const double geometry = mesh.geometry_error();
  if (geometry > rounding)
    text << ". Flat facets in place of curved surfaces may make another " << 100. * geometry << " %";
  text << ". Contact between nodes, folds and plastic hinges are not in it";
  if (!mesh.sees_variation())
    text << ". The whole error is unknown, since parts with a single element across bend, bars of two by two "
            "are twisted or bent, or supports hold all nodes of elements: it may be far larger";
  else if (const std::string why = review.describe_unresolved(); !why.empty())
    text << ". The whole error is unknown, since " << why;
  Diagnostic message(diagnostic::mesh_error, text.str());
  message.value("error", mesh.error()).value("geometry", geometry);
  return {message};
}

} // namespace billet
