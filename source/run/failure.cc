// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/failure.h"

#include "billet/contact/traction.h"
#include "billet/diagnostic_kinds.h"
#include "billet/output/energy_watch.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

namespace billet {

namespace {

struct FailureLimits {
  /// Poisson ratio above which few significant digits are left.
  static constexpr double incompressible = 0.49995;
  /// Part of its value at the end with which a load begins, above which it is sudden.
  static constexpr double sudden = 0.5;
  /// Norm of the elastic strain deviator above which a law without an exact dissipation unbalances
  /// energies.
  static constexpr double large_strain = 0.02;
};

/// Returns a sentence if the ratio of bulk to shear modulus leaves Newton's method few significant
/// digits.
std::string describe_incompressibility(const parameters::Scene &parameters) {
  const auto body = std::find_if(parameters.bodies.begin(), parameters.bodies.end(), [](const auto &b) {
    return b.material.law->elastic().poisson_ratio() > FailureLimits::incompressible;
  });
  if (body == parameters.bodies.end())
    return "";
  std::ostringstream text;
  text << "Body '" << body->name
       << "' is nearly incompressible ('Poisson ratio' = " << body->material.law->elastic().poisson_ratio()
       << "). A ratio of 0.4999 has a bulk modulus of 5000 times the shear modulus, and is easier to solve";
  return text.str();
}

/// Returns a sentence on where the results so far are stored.
std::string describe_saved_results(const parameters::Scene &parameters) {
  return "Results until then are in '" + parameters.output.folder.value + "'";
}

/// Returns the sentences that are not empty as one advice.
std::string join_sentences(const std::vector<std::string> &sentences) {
  std::string advice;
  for (const std::string &sentence : sentences)
    append_sentences(advice, sentence);
  return advice;
}

std::string describe_unstable_law(const bool is_unstable) {
  return is_unstable ? EnergyWatch::advise(EnergyWatch::Cause::unstable_law) : "";
}

/// Whether a load has most of its final value right after time t, where it begins.
bool is_sudden_at(const double t, const double end, const AppliedLoad &load) {
  const bool begins = load.times.from > 0. ? load.times.changes_at(t) && load.times.acts_after(t) : !(t > 0.);
  const dealii::Point<3> somewhere(1., 1., 1.); // an expression may be 0 at the origin
  return begins && !load.load.is_spring() &&
         std::any_of(load.expressions.begin(), load.expressions.end(), [&](const Expression &expression) {
           const double first = std::abs(expression.value(t, somewhere));
           return first > 0. && first >= FailureLimits::sudden * std::abs(expression.value(end, somewhere));
         });
}

/// Returns advice if a static step fails at whose start a load is applied as a whole: a shorter
/// step has no smaller load.
std::string advise_on_sudden_load(const Scene &scene, const double from) {
  const parameters::Scene &parameters = scene.parameters();
  if (parameters.scheme().has_inertia)
    return "";
  const double end = parameters.time_stepping.end_time;
  for (const Body &body : scene.bodies())
    for (const AppliedLoad &load : body.loads)
      if (is_sudden_at(from, end, load)) {
        std::ostringstream text;
        text << "Load '" << load.name << "' of body '" << body.name << "' acts in full from time " << from
             << " on, so that shorter steps have no smaller load. Let it grow: multiply it by 'min(1, "
             << (from > 0. ? "(t - " : "t");
        if (from > 0.)
          text << from << ")";
        text << "/" << 0.5 * (end - from) << ")', for example";
        return text.str();
      }
  return "";
}

/// Returns advice on contact if Newton's method cycles between its states.
std::string advise_on_cycling(const parameters::Scene &parameters, const NewtonReport &newton) {
  if (!newton.is_cycling || parameters.pairs.empty())
    return "";
  return "Likely cause: contact chatter (open/closed or stick/slip), as in snap-through or with strong "
         "friction. Try half or twice the normal or tangential penalty, or a 'Penetration tolerance'";
}

/// Returns advice on the parameters that limit the steps and the iterations.
std::string advise_on_steps(const parameters::Scene &parameters, const NewtonReport &newton) {
  if (parameters.time_stepping.control == parameters::TimeStepping::Control::fixed)
    return "Steps are fixed. Try a smaller 'Initial step' or 'Step control = automatic'";
  std::ostringstream text;
  const bool has_advice = newton.is_cycling || !newton.advice.empty();
  text << "The step cannot be cut below 'Minimum step' = " << parameters.time_stepping.min_step << ". "
       << (parameters.scheme().has_inertia ? "If accuracy cuts the step, increase 'Error tolerance'. "
                                           : "If a body snaps or buckles there, no equilibrium is near: "
                                             "'Scheme = implicit dynamics' follows "
                                             "it. ")
       << (has_advice                 ? ""
           : parameters.pairs.empty() ? "Try a larger 'Maximum iterations'. "
                                      : "Try a lower penalty or a larger 'Maximum iterations'. ")
       << "Check the last field output for an unstable or distorted mesh";
  return text.str();
}

/// Returns the pair of bodies whose springs hold most energy now, or the first one.
const BodyPair &most_loaded_pair(const Scene &scene, const ExplicitDynamics &problem) {
  const auto &loads = problem.state().body_pair_loads;
  const auto most = std::max_element(loads.begin(), loads.end(), [](const auto &a, const auto &b) {
    return a.stored_energy < b.stored_energy;
  });
  return scene.body_pairs()[static_cast<std::size_t>(most - loads.begin())];
}

/// Returns what to change of a pair of bodies and of the steps, in order. It leaves out what the
/// scene has.
std::vector<std::string> list_changes(const parameters::ExplicitDynamics &steps, const BodyPair &pair) {
  std::vector<std::string> changes;
  const auto add = [&changes](const bool is_new, const std::string &text) {
    if (is_new)
      changes.push_back(text);
  };
  const auto number = [](const double value) {
    std::ostringstream text;
    text << value;
    return text.str();
  };
  const bool by_nodes = pair.facets != FacetMethod::overlap;
  const bool is_stiff = pair.penalty_is_factor && pair.normal_penalty > enough_penalty;
  constexpr double for_chatter = 1000.; // E/h
  add(is_stiff && !pair.has_friction(), "'Normal penalty = " + number(enough_penalty) + "'");
  add(by_nodes && pair.two_passes && !pair.is_self_contact,
      "'Passes = one', with the finer or softer body as 'Body'");
  add(by_nodes && pair.facets != FacetMethod::bilinear, "'Facets = bilinear'");
  add(true, "a 'Safety factor' below " + number(steps.safety_factor));
  add(true, "a 'Contact resolution' above " + number(steps.contact_resolution));
  add(pair.has_friction() && pair.penalty_is_factor && pair.normal_penalty < for_chatter,
      "for bodies that bounce with strong friction, 'Normal penalty = " + number(for_chatter) + "'");
  return changes;
}

/// Returns advice on energies that fail to balance in an explicit run.
std::string advise_on_drift(const Scene &scene, const ExplicitDynamics &problem) {
  if (problem.has_low_penalties())
    return "Penalties are too low, and nodes with large penetration create energy. Increase 'Normal penalty'";
  if (scene.body_pairs().empty())
    return "Steps may be too long, or a penalty too high. Try a smaller 'Safety factor', a lower penalty or "
           "more bulk viscosity";
  const BodyPair &pair = most_loaded_pair(scene, problem);
  std::string list;
  for (const std::string &change : list_changes(scene.parameters().explicit_dynamics, pair))
    list += (list.empty() ? "" : "; ") + change;
  return "The likely cause is contact of pair '" + pair.name + "'. Try, in this order: " + list;
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
         (parameters.scheme().has_inertia ? ". Above the limit load, plastic flow is unbounded"
                                          : ". Above the limit load, no equilibrium exists") +
         ". If that is the cause, " +
         (!has_tool
              ? std::string()
              : std::string("move the tool by its '") + (turns ? "Rotation" : "Translation") + "', or ") +
         "let the material harden";
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
  return dealii::Utilities::MPI::max(maximum, discretization.communicator()) > FailureLimits::large_strain;
}

Diagnostic explain_failed_step(const Scene &scene, const StepReport &report, const double from,
                               const double to, const bool is_unstable) {
  const parameters::Scene &parameters = scene.parameters();
  const NewtonReport &newton = report.newton;
  // Whether there is a cause other than the iterations.
  const bool has_cause = newton.is_lost_in_round_off || newton.is_explained();
  std::ostringstream what, results;
  what << parameters.file_name << ": the step from time " << from << " to " << to << " failed after "
       << report.step << " accepted steps and " << report.total_cuts << " cuts: " << newton.failure
       << (has_cause || newton.criteria.empty() ? "" : "; ") << (has_cause ? "" : newton.criteria);
  results << "Results until time " << from << " are in '" << parameters.output.folder.value << "'";
  Diagnostic diagnostic(diagnostic::solution_failed, what.str());
  diagnostic.time(from)
      .value("steps", report.step)
      .value("Newton iterations", report.total_iterations)
      .advice(has_cause ? join_sentences({newton.advice, results.str()})
                        : join_sentences(
                              {newton.advice, advise_on_sudden_load(scene, from),
                               describe_limit_load(parameters), advise_on_cycling(parameters, newton),
                               advise_on_steps(parameters, newton), describe_incompressibility(parameters),
                               describe_unstable_law(is_unstable), results.str()}));
  return diagnostic;
}

Diagnostic explain_imbalance(const parameters::Scene &parameters, const StepReport &report, const double time,
                             const Explanation &imbalance) {
  Diagnostic diagnostic(diagnostic::energy_drift, parameters.file_name + ": after " +
                                                      std::to_string(report.step) + " steps " +
                                                      imbalance.what);
  diagnostic.time(time)
      .value("steps", report.step)
      .value("Newton iterations", report.total_iterations)
      .advice(join_sentences(
          {imbalance.advice, describe_limit_load(parameters), describe_saved_results(parameters)}));
  return diagnostic;
}

Diagnostic explain_drift(const Scene &scene, const ExplicitDynamics &problem, const std::string &advice) {
  const parameters::Scene &parameters = scene.parameters();
  const bool is_finite = std::isfinite(problem.relative_drift());
  std::ostringstream what;
  what << parameters.file_name << ": after " << problem.n_steps() << " steps the energies are ";
  if (is_finite)
    what << "off balance by " << 100. * problem.relative_drift()
         << " % of the maximum energy so far; allowed are " << 100. * parameters.explicit_dynamics.max_drift
         << " % ('Maximum energy drift')";
  else
    what << "not finite";
  Diagnostic diagnostic(is_finite ? diagnostic::energy_drift : diagnostic::solution_failed, what.str());
  diagnostic.time(problem.time())
      .value("steps", problem.n_steps())
      .advice(join_sentences({!is_finite        ? "Check the units of velocities, loads and penalties"
                              : !advice.empty() ? advice
                                                : advise_on_drift(scene, problem),
                              describe_limit_load(parameters), describe_saved_results(parameters)}));
  return diagnostic;
}

Diagnostic explain_failed_step(const Scene &scene, const ExplicitDynamics &problem, const Diagnostic &reason,
                               const bool is_unstable) {
  const parameters::Scene &parameters = scene.parameters();
  Diagnostic diagnostic = reason;
  diagnostic.time(reason.time().value_or(problem.time()))
      .value("steps", problem.n_steps())
      .advice(join_sentences({reason.advice(), describe_unstable_law(is_unstable),
                              describe_limit_load(parameters), describe_saved_results(parameters)}));
  return diagnostic;
}

} // namespace billet
