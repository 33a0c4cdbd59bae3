// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/penalty_raises.h"

#include "billet/diagnostic_kinds.h"

#include <algorithm>
#include <sstream>

namespace billet {

SpringBooks::SpringBooks(ImplicitProblem &problem)
    : problem_(problem), of_tools_(parts_.contacts().of_tools().size()),
      watch_(parts_.scheme().has_inertia() ? PenaltyWatch::Motion::sudden : PenaltyWatch::Motion::slow) {}

double &SpringBooks::energy(const std::size_t contact) {
  return contact < of_tools_.size()
             ? of_tools_[contact]
             : problem_.state().body_pair_loads[contact - of_tools_.size()].stored_energy;
}

void SpringBooks::add(const std::size_t contact, const double change) {
  problem_.state().energies.contact += change;
  energy(contact) += change;
}

void SpringBooks::change_at_start(const std::function<void()> &change) {
  ContactSet &contacts = parts_.contacts();
  problem_.evaluate_start();
  const std::vector<double> before = contacts.stored_energies();
  change();
  problem_.scales().spring_round_off = contacts.find_spring_round_off();
  problem_.evaluate_start();
  const std::vector<double> after = contacts.stored_energies();
  for (std::size_t i = 0; i < after.size(); ++i) {
    add(i, after[i] - before[i]);
    problem_.state().energies.external += after[i] - before[i];
  }
}

void SpringBooks::check_pair(const std::string &name, Penetration deepest, const double moved,
                             const double stored_energy, DiagnosticList &messages) {
  deepest = {dealii::Utilities::MPI::max(deepest.of_facet, parts_.communicator()),
             dealii::Utilities::MPI::max(deepest.length, parts_.communicator())};
  const double work = problem_.state().energies.total();
  append(messages,
         watch_.check(name, problem_.state().time, deepest, moved, work > 0. ? stored_energy / work : 0.));
}

DiagnosticList SpringBooks::check() {
  DiagnosticList messages;
  const SolutionState &state = problem_.state();
  const double displacement = problem_.step().start.displacements.linfty_norm();
  for (std::size_t i = 0; i < parts_.contacts().size(); ++i) {
    const ContactInterface &contact = parts_.contacts()[i];
    double moved = displacement;
    if (const auto &tool = contact.rigid_tool())
      moved = std::max(moved, max_motion(parts_.scene().tools()[*tool].placement(0.), state.placements[*tool],
                                         parts_.discretization().radius()));
    check_pair(contact.name(), contact.measures().penetration(), moved, energy(i), messages);
    append(messages, contact.checks().check_step());
  }
  return messages;
}

std::vector<double> PenaltyRaises::find_factors() const {
  const ContactSet &contacts = parts_.contacts();
  std::vector<double> factors =
      contacts.collect_max([](const auto &contact) { return contact.measures().excessive_penetration(); });
  const std::vector<double> room = contacts.stiffening_left();
  const auto &stepping = parts_.parameters().time_stepping;
  const bool is_short =
      stepping.control == parameters::TimeStepping::Control::automatic &&
      problem_.step().time - problem_.state().time < Limits::short_step * stepping.initial_step;
  for (std::size_t i = 0; i < factors.size(); ++i) {
    // A penalty of the scene is kept while possible; warnings report its softness. It has to rise
    // if nodes are about to go deeper than contact follows them.
    const PairSettings &pair = contacts[i].settings();
    const bool is_too_much =
        !pair.has_tolerance() && factors[i] > (pair.input->penalty.is_given && !is_short ? Limits::deep : 1.);
    const double raise =
        std::min(std::clamp(2. * factors[i], Limits::min_raise, Limits::max_raise), max_raise * room[i]);
    factors[i] = is_too_much && raise >= Limits::min_raise ? whole_octaves(raise) : 1.;
  }
  return factors;
}

std::optional<StepFailure> PenaltyRaises::judge() {
  factors_ = find_factors();
  if (std::none_of(factors_.begin(), factors_.end(), [](const double factor) { return factor > 1.; }))
    return {};
  return StepFailure{StepFailure::Kind::penetrates, {"the penetration of nodes is too large", ""}};
}

DiagnosticList PenaltyRaises::raise() {
  ContactSet &contacts = parts_.contacts();
  books_.change_at_start([&] {
    for (std::size_t i = 0; i < factors_.size(); ++i)
      if (factors_[i] > 1.)
        contacts[i].penalties().scale(factors_[i], factors_[i]);
  });
  SolutionState &state = problem_.state();
  for (std::size_t i = 0; i < factors_.size(); ++i) {
    if (const auto &tool = contacts[i].rigid_tool(); tool && !parts_.removal().is_removed(*tool))
      state.tool_loads[*tool] = contacts.compute_load(*tool);
  }
  StepState &step = problem_.step();
  step.start.supports = step.trial.supports;
  step.start.contact = step.trial.contact;
  return describe();
}

DiagnosticList PenaltyRaises::describe() const {
  DiagnosticList messages;
  for (std::size_t i = 0; i < factors_.size(); ++i) {
    if (!(factors_[i] > 1.))
      continue;
    const ContactInterface &contact = parts_.contacts()[i];
    const parameters::ContactPair &input = *contact.settings().input;
    const double penalty = input.penalty.normal * contact.penalties().stiffening();
    const bool is_factor = input.penalty.unit == parameters::ContactPair::PenaltyUnit::factor;
    std::ostringstream text;
    text.precision(3);
    text << "The penalty of the pair rises by a factor of " << factors_[i] << ", to " << penalty
         << (is_factor ? " E/h" : "") << ", since the penetration of nodes is too large";
    messages.push_back(Diagnostic(diagnostic::penalty_raised, text.str())
                           .pair(input.name)
                           .time(problem_.state().time)
                           .value("factor", factors_[i])
                           .measure(is_factor ? "penalty [E/h]" : "penalty", penalty));
  }
  return messages;
}

DiagnosticList DynamicPenalties::control(const Solution &solution) {
  if (!control_.is_used())
    return {};
  ContactSet &contacts = parts_.contacts();
  const MPI_Comm communicator = parts_.communicator();
  const PenaltyControl::Energies energies =
      control_.measure(solution, parts_.scene().bodies().size(), problem_.state().time, communicator);
  const auto room = contacts.collect(
      [&](const auto &contact) { return control_.room_of(contact.penalties(), communicator); });
  const std::vector<PenaltyControl::Factors> factors = control_.raises(energies, room);
  if (std::none_of(factors.begin(), factors.end(), [](const auto &factor) { return factor.raises(); }))
    return {};
  for (std::size_t i = 0; i < factors.size(); ++i) {
    if (!factors[i].raises())
      continue;
    const double normal = factors[i].normal, tangential = factors[i].tangential;
    contacts[i].penalties().scale_under_load(normal, tangential);
    // A stiffer spring with the same force stores less energy: the rest stays in the penetration
    // that is now allowed.
    const double lost =
        (1. - 1. / normal) * energies.of_pairs[i] + (1. - 1. / tangential) * energies.sticking[i].stored;
    books_.add(i, -lost);
    problem_.state().energies.numerical += lost;
  }
  problem_.scales().spring_round_off = contacts.find_spring_round_off();
  return control_.take_diagnostics();
}

} // namespace billet
