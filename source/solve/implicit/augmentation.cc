// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/augmentation.h"

#include "billet/contact/sheet_penalty.h"
#include "billet/diagnostic_kinds.h"
#include "billet/solve/implicit/penalty_raises.h"
#include "billet/solve/penalty_control.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <sstream>

namespace billet {

namespace {

/// Record of the errors after successive augmentations, over the tolerance.
class Pace {
public:
  void add(const double error) { errors_.push_back(error); }

  /// Returns the mean ratio of the errors after and before each of the last augmentations.
  double ratio() const {
    return std::pow(errors_.back() / errors_[errors_.size() - 1 - window], 1. / window);
  }
  /// Whether, at this rate, the error will be above 1 after `maximum` augmentations.
  bool is_hopeless(const unsigned int maximum) const {
    const auto n = static_cast<unsigned int>(errors_.size()) - 1;
    return n >= 2 * window && std::log(errors_.back()) + (maximum - n) * std::log(ratio()) > 0.;
  }
  /// Returns the number of further augmentations until convergence; the error has to fall.
  double to_go() const { return std::ceil(-std::log(errors_.back()) / std::log(ratio())); }

private:
  static constexpr unsigned int window = 5;
  std::vector<double> errors_;
};

} // namespace

/// Limits of augmentation, as factors unless they say otherwise.
struct Augmentation::Limits {
  /// Maximum number of augmentations for softness alone. Remaining softness fails no step, but is
  /// reported at the end.
  static constexpr unsigned int max_for_softness = 6;
  /// If an augmentation leaves more than `slow_error` of the error, residuals may cause the gaps:
  /// their tolerance is reduced by `accuracy`, down to `min_accuracy`.
  static constexpr double slow_error = 0.5, accuracy = 0.1, min_accuracy = 0.01;
  /// The same for sheets, unless the residual is below this part of the largest force of a pair: it
  /// cannot change forces then.
  static constexpr double noise = 2e-3;
  /// An augmentation leaves K/(K + k) of the gap, K the stiffness of the bodies there and k the
  /// penalty's. A contact that leaves more than `slow` becomes stiffer, so that `wanted` is left
  /// (Bertsekas, Constrained Optimization, 1982, sec. 2.2.5).
  static constexpr double slow = 0.25, wanted = 0.1;
  /// Limits for softness. Stiff springs between facets that do not fit carry more force than their
  /// mean gaps. Therefore pairs of bodies become that stiff only in confined bodies: the error is
  /// above `much`, and an augmentation adds `nearly_all` of the spring force.
  static constexpr double nearly_all = 0.98, much = 100., more_of_tools = 100., more_of_confined = 1e4;
  /// If bodies hardly yield, springs keep the part `kept` of their force, and as much is added to
  /// the contact force. Without extrapolation, `nearly_all` implies `kept`. An augmentation that
  /// MultiplierOffsets extrapolates by the secant adds up to four times as much: `kept` excludes
  /// those of bodies that yield. If springs hold less than `min_held` of the force, this is not
  /// significant: friction may be augmented instead.
  static constexpr double min_held = 0.05, kept = 0.9;
  /// The same for the stiffness of sheets, whose forces change little beside the residual.
  static constexpr double min_held_of_sheet = 0.01;
  /// Change of the force, as part of the largest, up to which a pair is settled.
  static constexpr double settled = 5e-3;
  /// Room that a penalty needs to rise, which it does by whole octaves.
  static constexpr double octave = 2.;
  /// Number of steps with restless nodes after which the penalty of a sheet falls. Nodes may be
  /// restless in the step in which they first touch.
  static constexpr double restless_steps = 2.;
  /// Penalty above which a note about a raise is printed [E/h].
  static constexpr double notable_penalty = 1000.;
};

struct Augmentation::Series {
  explicit Series(const std::size_t n_contacts)
      : stiffer(n_contacts, 1.), added(n_contacts, 0.), granted(n_contacts, 1.) {}

  Pace pace;
  std::vector<ContactSprings> springs;
  std::vector<double> before; ///< demands before the last augmentation
  /// Factors of stiffness by all augmentations, and parts of the forces added by the last.
  std::vector<double> stiffer, added;
  /// Change of the normal force of a sheet by the last augmentation, over the force that springs
  /// held; 1 for others
  std::vector<double> granted;
  std::unique_ptr<Vector> soft; ///< the state from which augmentations are for softness alone
  std::vector<double> soft_offsets;
  std::size_t hardest = 0; ///< of the report before
};

namespace {

/// Whether the pair is with a driven tool that has neither a load nor a mass. Such a tool gives way
/// to bodies, and any force is an error of the iterations.
bool bears_nothing(const ImplicitProblem &problem, const std::optional<std::size_t> &tool) {
  if (!tool)
    return false;
  const ImplicitParts &parts = problem.parts();
  const std::vector<std::size_t> &driven = parts.tools().unknown();
  return std::find(driven.begin(), driven.end(), *tool) != driven.end() &&
         parts.scene().tools()[*tool].load(problem.step().time) == 0. &&
         !parts.scheme().tools().has_mass(*tool);
}

/// Returns the factor, in whole octaves, by which a penalty falls to at most `wanted` [E/h]; 1 or
/// more if it need not. `room` is that by which it may rise.
template <class Contact> double fall_to(const double wanted, const double room, const Contact &contact) {
  if (wanted > enough_penalty || !contact.settings().is_augmented())
    return 1.;
  constexpr double round_off = 1e-9; // no sheet's penalty falls for its last bit
  const double left = wanted / enough_penalty * room;
  return whole_octaves(contact.penalties().is_of_sheet() ? (1. + round_off) * left : left);
}

double max_force(const std::vector<ContactSprings> &springs) {
  double maximum = 0.;
  for (const ContactSprings &of_pair : springs)
    maximum = std::max(maximum, of_pair.normal.force);
  return maximum;
}

} // namespace

Augmentation::Augmentation(ImplicitProblem &problem, EquilibriumSolver &solver,
                           PenetrationMeasurement &measurement)
    : problem_(problem), solver_(solver), measurement_(measurement),
      softness_(softness_rules(parts_.contacts())),
      has_sheets_(std::any_of(parts_.contacts().begin(), parts_.contacts().end(),
                              [](const auto &contact) { return contact.penalties().is_of_sheet(); })) {}

std::vector<SoftnessLimit::Rule> Augmentation::softness_rules(const ContactSet &contacts) {
  return contacts.collect([](const auto &contact) {
    using Rule = SoftnessLimit::Rule;
    return !contact.settings().limits_softness()    ? Rule::none
           : contact.penalties().is_of_soft_sheet() ? Rule::sheet
                                                    : Rule::general;
  });
}

std::vector<double> Augmentation::stiffen_slow_contacts(const std::vector<double> &errors,
                                                        const Series &series) {
  ContactSet &contacts = parts_.contacts();
  std::vector<double> room = contacts.stiffening_left(), factors(errors.size(), 1.);
  bool is_stiffer = false;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double left = std::min(errors[i] / series.before[i], series.granted[i]);
    if (contacts[i].settings().limits_softness() && may_be_raised(i))
      room[i] *= series.added[i] > Limits::nearly_all && errors[i] > Limits::much ? Limits::more_of_confined
                 : contacts[i].rigid_tool()                                       ? Limits::more_of_tools
                                                                                  : 1.;
    if (!(errors[i] > 1. && left > Limits::slow && room[i] >= Limits::octave))
      continue;
    factors[i] = whole_octaves(
        left < 1. ? std::min(room[i], left / (1. - left) * (1. - Limits::wanted) / Limits::wanted) : room[i]);
    is_stiffer = true;
    contacts[i].penalties().scale(factors[i], factors[i]);
  }
  if (is_stiffer)
    problem_.scales().spring_round_off = contacts.find_spring_round_off();
  return factors;
}

bool Augmentation::may_be_raised(const std::size_t contact) const {
  return bounded_.empty() || bounded_[contact] == 0.;
}

void Augmentation::bound_penalty(const std::size_t contact) {
  bounded_.resize(parts_.contacts().size(), 0.);
  bounded_[contact] = 1.;
}

std::vector<bool> Augmentation::restless_sheets() const {
  const ContactSet &contacts = parts_.contacts();
  std::vector<double> restless(contacts.size(), 0.);
  if (!has_sheets_)
    return std::vector<bool>(restless.size());
  for (std::size_t i = 0; i < contacts.of_tools().size(); ++i)
    if (contacts[i].penalties().is_of_sheet() && contacts.of_tools()[i].checks().has_restless())
      restless[i] = 1.;
  dealii::Utilities::MPI::max(restless, parts_.communicator(), restless);
  return {restless.begin(), restless.end()};
}

std::vector<bool> Augmentation::stacked_sheets() const {
  const auto &pairs = parts_.scene().pairs();
  const auto &of_bodies = parts_.scene().body_pairs();
  std::vector<bool> stacked(parts_.contacts().size());
  for (std::size_t i = 0; i < pairs.size(); ++i)
    stacked[i] = parts_.contacts()[i].penalties().is_of_sheet() &&
                 std::any_of(of_bodies.begin(), of_bodies.end(), [&](const BodyPair &pair) {
                   return !pair.is_self_contact &&
                          (pair.bodies[0] == pairs[i].body || pair.bodies[1] == pairs[i].body);
                 });
  return stacked;
}

bool Augmentation::lower_penalties(const std::vector<Fall> &falls, const std::string &reason,
                                   SpringBooks &books, DiagnosticList &messages) {
  ContactSet &contacts = parts_.contacts();
  const std::vector<double> room = contacts.stiffening_left();
  std::vector<double> of_sheets(room.size(), 1.); // factors
  bool has_lowered = false;
  for (std::size_t i = 0; i < room.size(); ++i) {
    const double factor = fall_to(falls[i].to, room[i], contacts[i]);
    if (!(factor < 1.))
      continue;
    has_lowered = true;
    if (falls[i].keeps_tractions)
      of_sheets[i] = factor;
    else
      contacts[i].penalties().scale(factor, factor);
    const double before = enough_penalty / room[i];
    if (before > enough_penalty && contacts[i].penalties().is_of_sheet())
      bound_penalty(i);
    std::ostringstream text;
    text << "The penalty is reduced from " << before << " to " << before * factor << " E/h, since " << reason
         << "; augmentation enforces the constraint";
    messages.push_back(Diagnostic(diagnostic::penalty_reduced, text.str())
                           .pair(contacts[i].name())
                           .time(problem_.step().time)
                           .value("penalty [E/h]", before * factor));
  }
  if (std::any_of(of_sheets.begin(), of_sheets.end(), [](const double factor) { return factor < 1.; }))
    books.change_at_start([&] {
      for (std::size_t i = 0; i < contacts.of_tools().size(); ++i)
        if (of_sheets[i] < 1.) {
          contacts.of_tools()[i].penalties().lower_under_load(
              of_sheets[i], contacts[i].settings().input->penalty.is_tangential_given ? 1. : of_sheets[i]);
          softness_.forget(i);
        }
    });
  else if (has_lowered)
    problem_.scales().spring_round_off = contacts.find_spring_round_off();
  return has_lowered;
}

bool Augmentation::soften_contacts(const NewtonReport &failed, SpringBooks &books, DiagnosticList &messages) {
  const ContactSet &contacts = parts_.contacts();
  std::vector<Fall> falls(contacts.size(), {enough_penalty, false});
  const std::vector<double> room = contacts.stiffening_left();
  bool is_raised = false; // by augmentation: that falls first
  for (std::size_t i = 0; i < room.size(); ++i)
    is_raised = is_raised || fall_to(enough_penalty, room[i], contacts[i]) < 1.;
  const std::vector<bool> restless = restless_sheets();
  for (std::size_t i = 0; !is_raised && i < falls.size(); ++i)
    if (restless[i] || (!failed.is_slow && contacts[i].penalties().is_of_sheet()))
      falls[i] = {sheet_penalty, true};
  return lower_penalties(falls, "Newton's method failed", books, messages);
}

void Augmentation::lower_sheets(const std::vector<bool> &chosen, const std::string &reason,
                                SpringBooks &books, DiagnosticList &messages) {
  if (std::none_of(chosen.begin(), chosen.end(), [](const bool is_chosen) { return is_chosen; }))
    return;
  const ContactSet &contacts = parts_.contacts();
  const std::vector<double> room = contacts.stiffening_left();
  std::vector<Fall> falls(chosen.size());
  for (std::size_t i = 0; i < falls.size(); ++i)
    if (chosen[i]) // what augmentation has raised falls first
      falls[i] = {fall_to(enough_penalty, room[i], contacts[i]) < 1. ? enough_penalty : sheet_penalty, true};
  lower_penalties(falls, reason, books, messages);
}

void Augmentation::soften_sheets(SpringBooks &books, DiagnosticList &messages) {
  if (!has_sheets_)
    return;
  if (restless_steps_.empty()) { // before the first step
    restless_steps_.assign(parts_.contacts().size(), 0.);
    lower_sheets(stacked_sheets(), "the body is a thin sheet that other bodies may touch", books, messages);
  }
  std::vector<bool> restless(restless_steps_.size());
  for (std::size_t i = 0; i < restless.size(); ++i)
    if (restless_steps_[i] >= Limits::restless_steps) {
      restless[i] = true;
      restless_steps_[i] = 0.;
    }
  lower_sheets(restless, "nodes of a thin sheet open and close in turn", books, messages);
}

void Augmentation::commit() {
  softness_.commit(contact_springs(), parts_.parameters().solver.force_tolerance);
  const std::vector<bool> restless = restless_sheets();
  for (std::size_t i = 0; i < restless_steps_.size(); ++i)
    if (restless[i] && !parts_.contacts()[i].penalties().is_of_soft_sheet())
      restless_steps_[i] += 1.;
}

Augmentation::Demands Augmentation::find_demands(const std::vector<ContactSprings> &springs,
                                                 const unsigned int n) const {
  Demands demands;
  demands.of_contacts = parts_.contacts().augmentation_errors();
  for (std::size_t i = 0; i < demands.of_contacts.size(); ++i) {
    double &demand = demands.of_contacts[i];
    demand = bears_nothing(problem_, parts_.contacts()[i].rigid_tool()) ? 0. : demand / penetration_allowed_;
    demands.by_tolerances = std::max(demands.by_tolerances, demand);
  }
  demands.maximum = demands.by_tolerances;
  if (springs.empty())
    return demands;
  // Equilibrium within its tolerance leaves friction this uncertain: further augmentations would
  // only follow the iterations, and raise penalties for that.
  const double resolved = n > 0 ? parts_.parameters().solver.force_tolerance * solver_.accuracy() : 0.;
  const std::vector<double> excess = softness_.excess(springs, resolved);
  for (std::size_t i = 0; i < excess.size(); ++i) {
    demands.of_contacts[i] = std::max(demands.of_contacts[i], excess[i]);
    demands.maximum = std::max(demands.maximum, excess[i]);
  }
  return demands;
}

std::vector<ContactSprings> Augmentation::contact_springs() const {
  if (!softness_.is_used())
    return {};
  auto springs = parts_.contacts().collect([this](const auto &contact) {
    return bears_nothing(problem_, contact.rigid_tool()) ? ContactSprings()
                                                         : contact.penalties().compute_springs();
  });
  std::vector<double> sums;
  for (const auto &[normal, tangential] : springs)
    sums.insert(sums.end(), {normal.force, normal.held, tangential.force, tangential.held});
  dealii::Utilities::MPI::sum(sums, parts_.communicator(), sums);
  for (std::size_t i = 0; i < springs.size(); ++i) {
    springs[i].normal.force = sums[4 * i];
    springs[i].normal.held = sums[4 * i + 1];
    springs[i].tangential.force = sums[4 * i + 2];
    springs[i].tangential.held = sums[4 * i + 3];
  }
  return springs;
}

std::vector<std::array<SoftnessLimit::Change, 2>>
Augmentation::changes_of(const std::vector<ContactSprings> &before,
                         const std::vector<ContactSprings> &after) const {
  constexpr std::size_t n_sums = 4;
  std::vector<double> sums;
  std::vector<std::array<SoftnessLimit::Change, 2>> changes(after.size());
  for (std::size_t i = 0; i < after.size(); ++i)
    for (const auto direction : {&ContactSprings::normal, &ContactSprings::tangential}) {
      const auto &then = (before[i].*direction).of_nodes, &now = (after[i].*direction).of_nodes;
      double of_nodes = 0.;
      dealii::Tensor<1, 3> in_all;
      for (std::size_t n = 0; n < now.size(); ++n) {
        of_nodes += (now[n] - then[n]).norm();
        in_all += now[n] - then[n];
      }
      sums.insert(sums.end(), {of_nodes, in_all[0], in_all[1], in_all[2]});
    }
  dealii::Utilities::MPI::sum(sums, parts_.communicator(), sums);
  for (std::size_t i = 0; i < after.size(); ++i)
    for (std::size_t d = 0; d < 2; ++d) {
      const double *sum = sums.data() + n_sums * (2 * i + d);
      const double scalar = d == 0 ? after[i].normal.force - before[i].normal.force
                                   : after[i].tangential.force - before[i].tangential.force;
      changes[i][d] = {sum[0], std::max(std::abs(scalar), std::hypot(sum[1], sum[2], sum[3]))};
    }
  return changes;
}

void Augmentation::give_up(const Series &series, const unsigned int n, const Demands &demands,
                           NewtonReport &report) const {
  const auto &errors = demands.of_contacts;
  const auto worst =
      static_cast<std::size_t>(std::max_element(errors.begin(), errors.end()) - errors.begin());
  std::ostringstream message;
  message << "after " << n << " augmentations the penetration or elastic slip of contact pair '"
          << parts_.contacts()[worst].name() << "' is still " << demands.maximum
          << " times the 'Penetration tolerance' from its target";
  const unsigned int maximum = parts_.parameters().solver.max_augmentations;
  if (n < maximum && series.pace.ratio() < 1.)
    message << ". At the present rate of " << series.pace.ratio() << " for each augmentation, it would take "
            << series.pace.to_go() << " more";
  else if (n < maximum)
    message << ", and no longer falls";
  report.converged = false;
  report.failure = message.str();
  report.advice = std::string("Try a larger penalty or 'Penetration tolerance', ") +
                  (parts_.scheme().has_inertia()
                       ? "or no tolerance: in dynamics it requires penetrating nodes to stop within a step"
                       : "or a larger 'Maximum augmentations'");
}

void Augmentation::augment(NewtonReport &report, std::vector<double> &offsets, Vector &displacements) {
  const unsigned int maximum = parts_.parameters().solver.max_augmentations;
  const double accuracy = solver_.accuracy();
  double last_error = std::numeric_limits<double>::infinity();
  Series series(parts_.contacts().size());
  series.hardest = report.hardest;
  const std::vector<SoftnessLimit::Rule> rules = softness_rules(parts_.contacts());
  const bool has_soft_sheets = std::count(rules.begin(), rules.end(), SoftnessLimit::Rule::sheet) > 0;
  softness_.set_rules(rules);
  softness_.begin();
  series.springs = contact_springs();
  for (unsigned int n = 0; report.converged; ++n) {
    const Demands demands = find_demands(series.springs, n);
    const double error = demands.maximum;
    const bool is_of_softness = demands.by_tolerances <= 1.;
    if (error <= 1.)
      break;
    const bool is_resolved =
        has_soft_sheets && is_of_softness &&
        report.force * problem_.scales().force <= Limits::noise * max_force(series.springs);
    if (error > Limits::slow_error * last_error && !is_resolved)
      solver_.set_accuracy(std::max(Limits::accuracy * solver_.accuracy(), Limits::min_accuracy * accuracy));
    last_error = error;
    series.pace.add(error);
    if (is_of_softness &&
        (n >= Limits::max_for_softness || series.pace.is_hopeless(Limits::max_for_softness)))
      break;
    if (n == maximum || series.pace.is_hopeless(maximum)) {
      if (!may_leave_penetration_)
        give_up(series, n, demands, report);
      break;
    }
    if (!solver_.is_probing())
      measurement_.begin_with_augmentation();
    if (is_of_softness && n == 0) {
      series.soft = std::make_unique<Vector>(displacements);
      series.soft_offsets = offsets;
    }
    if (!augment_once(series, demands, is_of_softness, report, offsets, displacements))
      break;
  }
  solver_.set_accuracy(accuracy);
}

bool Augmentation::augment_once(Series &series, const Demands &demands, const bool is_of_softness,
                                NewtonReport &report, std::vector<double> &offsets, Vector &displacements) {
  ContactSet &contacts = parts_.contacts();
  for (auto &contact : contacts)
    if (contact.settings().is_augmented())
      contact.penalties().augment();
  if (!series.before.empty()) {
    const std::vector<double> factors = stiffen_slow_contacts(demands.of_contacts, series);
    for (std::size_t i = 0; i < factors.size(); ++i)
      series.stiffer[i] *= factors[i];
  }
  series.before = demands.of_contacts;
  report.append(solver_.iterate(offsets, displacements));
  if (!report.converged && series.soft && is_of_softness) {
    restore_soft_state(series, report, offsets, displacements);
    return false;
  }
  if (report.converged) {
    learn(series);
    if (!solver_.is_probing())
      note_stiff_contacts(series, report.diagnostics);
  }
  return true;
}

void Augmentation::restore_soft_state(Series &series, NewtonReport &report, std::vector<double> &offsets,
                                      Vector &displacements) {
  ContactSet &contacts = parts_.contacts();
  for (std::size_t i = 0; i < series.stiffer.size(); ++i)
    if (series.stiffer[i] != 1.)
      contacts[i].penalties().scale(1. / series.stiffer[i], 1. / series.stiffer[i]);
  contacts.take_back_augmentation();
  displacements = *series.soft;
  offsets = series.soft_offsets;
  const NewtonReport again = solver_.iterate(offsets, displacements);
  report.append(again);
  // If this does not converge, a shorter step does not help either.
  report.hardest = std::max(series.hardest, again.hardest);
  if (!solver_.is_probing())
    has_failed_ = true;
}

void Augmentation::note_stiff_contacts(const Series &series, DiagnosticList &messages) {
  ContactSet &contacts = parts_.contacts();
  const std::vector<double> room = contacts.stiffening_left();
  is_noted_.resize(room.size(), false);
  for (std::size_t i = 0; i < room.size(); ++i) {
    const double penalty = enough_penalty / room[i];
    if (is_noted_[i] || !(series.stiffer[i] > 1.) || !(penalty > Limits::notable_penalty))
      continue;
    is_noted_[i] = true;
    std::ostringstream text;
    text << "Augmentation raises the penalty of the pair to " << penalty
         << " E/h, since the forces rise by little each time";
    messages.push_back(
        Diagnostic(diagnostic::penalty_raised, text.str())
            .pair(contacts[i].name())
            .time(problem_.step().time)
            .value("penalty [E/h]", penalty)
            .advice("If steps are short from now on, 'Normal penalty = 10' keeps the penalty"));
  }
}

void Augmentation::learn(Series &series) {
  const std::vector<ContactSprings> after = contact_springs();
  if (after.empty())
    return;
  const auto changes = changes_of(series.springs, after);
  softness_.learn(series.springs, changes);
  const ContactSet &contacts = parts_.contacts();
  for (std::size_t i = 0; i < series.added.size(); ++i) {
    const ContactSprings::Direction &then = series.springs[i].normal, &now = after[i].normal;
    series.added[i] = then.held > Limits::min_held * then.force && now.held > Limits::kept * then.held
                          ? changes[i][0].in_all / then.held
                          : 0.;
    if (contacts[i].penalties().is_of_soft_sheet())
      series.granted[i] = then.held > Limits::min_held_of_sheet * then.force
                              ? std::min(1., changes[i][0].in_all / then.held)
                              : 0.;
  }
  series.springs = after;
}

DiagnosticList Augmentation::finish() const {
  constexpr double percent = 100.;
  DiagnosticList messages;
  const std::vector<double> unsettled = softness_.unsettled();
  for (std::size_t i = 0; i < unsettled.size(); ++i) {
    if (!(unsettled[i] > Limits::settled))
      continue;
    const bool is_with_tool = i < parts_.scene().pairs().size();
    std::ostringstream text;
    text.precision(2);
    text << "Augmentation stops while it still changes the force by " << percent * unsettled[i]
         << " % of the maximum. "
         << (has_failed_ ? "Newton's method fails with more of it in some steps, where the force is too small"
             : is_with_tool
                 ? "Facets are coarse for the tool's fillets, or a sharp edge of it carries the force"
                 : "Facets of the two sides do not match, or a sharp edge carries the force");
    Diagnostic message(diagnostic::contact_unsettled, text.str());
    message.pair(parts_.contacts()[i].name()).measure("change / force", unsettled[i]);
    if (has_failed_)
      message.advice("Compare with a run with 'Normal penalty = 1000', or with finer facets that match");
    else if (is_with_tool)
      message.advice(
          "Reduce 'Force tolerance', add a fillet to a sharp edge, or use a finer mesh where the tool "
          "presses. 'Penetration tolerance = 1e-3' augments until convergence; it takes many more "
          "iterations");
    messages.push_back(message);
  }
  return messages;
}

void Augmentation::save(StateWriter &writer) const {
  if (softness_.is_used())
    writer.write("softness", softness_.save());
  if (!has_sheets_)
    return;
  writer.write("steps with restless sheets", restless_steps_);
  writer.write("bounded penalties", bounded_);
}

void Augmentation::load(StateReader &reader) {
  if (softness_.is_used() && reader.has("softness"))
    softness_.load(reader.read("softness"));
  if (has_sheets_ && reader.has("steps with restless sheets")) {
    restless_steps_ = reader.read("steps with restless sheets");
    restless_steps_.resize(parts_.contacts().size(), 0.); // saved for other pairs
  }
  if (has_sheets_ && reader.has("bounded penalties")) {
    bounded_ = reader.read("bounded penalties");
    if (!bounded_.empty())
      bounded_.resize(parts_.contacts().size(), 0.);
  }
}

} // namespace billet
