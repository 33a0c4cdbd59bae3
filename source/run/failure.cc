// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/failure.h"

#include "billet/output/energy_watch.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace billet {

namespace {

struct Limits {
  /// Poisson ratio above which few significant digits are left.
  static constexpr double incompressible = 0.49995;
  /// Norm of the elastic strain deviator above which a law without an exact dissipation unbalances energies.
  static constexpr double large_strain = 0.02;
};

/// Returns a hint if the ratio of bulk to shear modulus leaves Newton's method few significant digits.
std::string describe_incompressibility(const parameters::Scene &parameters) {
  const auto body = std::find_if(parameters.bodies.begin(), parameters.bodies.end(), [](const auto &b) {
    return b.material.law->elastic().poisson_ratio() > Limits::incompressible;
  });
  if (body == parameters.bodies.end())
    return "";
  std::ostringstream text;
  text << ". Body '" << body->name
       << "' is nearly incompressible ('Poisson ratio' = " << body->material.law->elastic().poisson_ratio()
       << "). A ratio of 0.4999 has a bulk modulus of 5000 times the shear modulus, and is easier to solve";
  return text.str();
}

/// Returns a statement of where the results so far are stored.
std::string describe_saved_results(const parameters::Scene &parameters) {
  return "Results until then are in '" + parameters.output.folder.value + "'.";
}

} // namespace

std::string describe_limit_load(const parameters::Scene &parameters) {
  using Control = parameters::Motion::Control;
  const auto is_given = [](const parameters::Tool &tool) {
    return tool.motion.control == Control::force || tool.motion.control == Control::moment;
  };
  const auto tool = std::find_if(parameters.tools.begin(), parameters.tools.end(), is_given);
  const auto body =
      std::find_if(parameters.bodies.begin(), parameters.bodies.end(), [](const parameters::Body &b) {
        const FlowStress *flow = b.material.law->flow_stress();
        return flow != nullptr && flow->is_bounded();
      });
  const bool has_tool = tool != parameters.tools.end();
  const bool has_loads = std::any_of(parameters.bodies.begin(), parameters.bodies.end(),
                                     [](const parameters::Body &b) { return !b.loads.empty(); });
  if (body == parameters.bodies.end() || !(has_tool || has_loads))
    return "";
  const bool turns = has_tool && tool->motion.control == Control::moment;
  return "Body '" + body->name + "' yields without hardening, and " +
         (has_tool ? "tool '" + tool->name + (turns ? "' applies a given moment" : "' applies a given force")
                   : "loads act on it") +
         (parameters.is_dynamic() ? ". Above the limit load, plastic flow is unbounded"
                                  : ". Above the limit load, no equilibrium exists") +
         ". If that is the cause, " +
         (!has_tool
              ? std::string()
              : std::string("move the tool by its '") + (turns ? "Rotation" : "Translation") + "', or ") +
         "let the material harden. ";
}

bool has_inexact_dissipation(const Scene &scene, const Discretization &discretization,
                             const Solution &solution) {
  double maximum = 0.;
  for (std::size_t b = 0; b < scene.bodies().size(); ++b) {
    const Body &body = scene.bodies()[b];
    if (!body.law->has_plasticity() || body.law->has_exact_dissipation())
      continue;
    for (const ElementSummary &summary : solution.summarize(b))
      if (summary.equivalent_plastic_strain > 0.)
        maximum = std::max(maximum,
                           dealii::deviator(summary.cauchy_stress).norm() / (2. * body.law->elastic().shear));
  }
  return dealii::Utilities::MPI::max(maximum, discretization.communicator()) > Limits::large_strain;
}

std::string explain_failed_step(const parameters::Scene &parameters, const StepReport &report,
                                const double from, const double to, const bool is_unstable) {
  std::ostringstream message;
  message << parameters.file_name << ": the step from time " << from << " to " << to << " failed after "
          << report.step << " accepted steps and " << report.total_cuts << " cuts: " << report.newton.failure;
  std::ostringstream computed;
  computed << ". Results until time " << from << " are in '" << parameters.output.folder.value << "'.";
  if (report.newton.is_lost_in_round_off || report.newton.is_explained)
    return message.str() + computed.str();
  message << (report.newton.criteria.empty() ? "" : "; ") << report.newton.criteria << ". "
          << describe_limit_load(parameters);
  const bool is_cycling = report.newton.is_cycling && !parameters.pairs.empty();
  if (is_cycling)
    message << "Likely cause: contact chatter (open/closed or stick/slip), as in snap-through or with strong "
               "friction. Try half or twice the normal or tangential penalty, or a 'Penetration tolerance'. ";
  if (parameters.time_stepping.control == parameters::TimeStepping::Control::fixed)
    message << "Steps are fixed. Try a smaller 'Initial step' or 'Step control = automatic'";
  else
    message << "The step cannot be cut below 'Minimum step' = " << parameters.time_stepping.min_step << ". "
            << (parameters.is_dynamic() ? "If accuracy cuts the step, increase 'Error tolerance'. " : "")
            << (report.newton.is_cycling   ? ""
                : parameters.pairs.empty() ? "Try a larger 'Maximum iterations'. "
                                           : "Try a lower penalty or a larger 'Maximum iterations'. ")
            << "Check the last field output for an unstable or distorted mesh";
  return message.str() + describe_incompressibility(parameters) +
         (is_unstable ? ". In addition, " + EnergyWatch::advise(EnergyWatch::Cause::unstable_law) : "") +
         computed.str();
}

std::string explain_imbalance(const parameters::Scene &parameters, const StepReport &report,
                              const double time, const std::string &imbalance) {
  std::ostringstream message;
  message << parameters.file_name << ": at time " << time << " after " << report.step << " steps "
          << imbalance << ". " << describe_limit_load(parameters) << describe_saved_results(parameters);
  return message.str();
}

std::string explain_drift(const Scene &scene, const ExplicitDynamics &problem, const std::string &advice) {
  const parameters::Scene &parameters = scene.parameters();
  std::ostringstream message;
  message << parameters.file_name << ": at time " << problem.time() << " after " << problem.n_steps()
          << " steps the energies ";
  if (std::isfinite(problem.relative_drift()))
    message << "are off balance by " << 100. * problem.relative_drift()
            << " % of the maximum energy so far; allowed are "
            << 100. * parameters.explicit_dynamics.max_drift << " % ('Maximum energy drift'): "
            << (!advice.empty()               ? advice
                : problem.has_low_penalties() ? "penalties are too low, and nodes with large penetration "
                                                "create energy. Increase 'Normal penalty'"
                : scene.capabilities().friction && !scene.body_pairs().empty()
                    ? "contact chatter with friction creates energy. Try a larger 'Normal penalty', such as "
                      "1000 E/h, else a smaller 'Safety factor' or more bulk viscosity"
                    : "steps may be too long, or a penalty too high. Try a smaller 'Safety factor', a lower "
                      "penalty or more bulk viscosity");
  else
    message << "are not finite. Check the units of velocities, loads and penalties";
  message << ". " << describe_limit_load(parameters) << describe_saved_results(parameters);
  return message.str();
}

std::string explain_failed_step(const parameters::Scene &parameters, const std::string &reason,
                                const bool is_unstable) {
  return reason + ". " +
         (is_unstable ? "In addition, " + EnergyWatch::advise(EnergyWatch::Cause::unstable_law) + ". " : "") +
         describe_limit_load(parameters) + describe_saved_results(parameters);
}

} // namespace billet
