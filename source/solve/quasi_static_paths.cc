// SPDX-License-Identifier: LGPL-2.1-or-later
// Nodes that would go through tools or bodies: in a step's first guess, in a correction, in a whole step.
#include "billet/diagnostic_kinds.h"
#include "billet/solve/quasi_static.h"

#include <Epetra_Vector.h>

#include <algorithm>
#include <sstream>

namespace billet {

std::vector<Placement> QuasiStatic::placements_now() const {
  std::vector<Placement> placements;
  for (std::size_t tool = 0; tool < scene_.tools().size(); ++tool)
    placements.push_back(place(tool, time_, offsets_[tool]));
  return placements;
}

double QuasiStatic::find_free_part(const Vector &from, const std::vector<Placement> &tools_from,
                                   const Vector &to, const bool is_thorough) {
  const std::vector<Placement> tools_to = placements_now();
  std::vector<double> parts;
  for (const auto &contact : contacts_)
    parts.push_back(
        contact.find_free_part(from, tools_from[contact.tool()], to, tools_to[contact.tool()], is_thorough));
  if (!parts.empty())
    dealii::Utilities::MPI::min(parts, discretization_.communicator(), parts);
  for (const auto &contact : body_contacts_)
    parts.push_back(contact->find_free_part(from, to, is_thorough));
  const auto least = std::min_element(parts.begin(), parts.end());
  if (least == parts.end() || *least == 1.)
    return 1.;
  const auto which = static_cast<std::size_t>(least - parts.begin());
  if (which < contacts_.size())
    path_failure_ = "nodes of contact pair '" + scene_.pairs()[contacts_[which].pair()].name +
                    "' would go through tool '" + scene_.tools()[contacts_[which].tool()].name() + "'";
  else
    path_failure_ = "nodes of contact pair '" + body_contacts_[which - contacts_.size()]->name() +
                    "' would go through the other body";
  return *least;
}

double QuasiStatic::max_step_length(const Epetra_Vector &x, const Epetra_Vector &direction) {
  if (contacts_.empty() && body_contacts_.empty())
    return 1.;
  set_trial(x);
  const Vector from = trial_ghosted_;
  const std::vector<Placement> tools_from = placements_now();
  Epetra_Vector end(x);
  end.Update(1., direction, 1.);
  set_trial(end);
  const double part = find_free_part(from, tools_from, trial_ghosted_, false);
  constexpr double least = 1e-3; // so short a correction is none
  return part < least ? 0. : part;
}

bool QuasiStatic::goes_through(const bool is_thorough, NewtonReport &report) {
  trial_ghosted_ = trial_;
  if (find_free_part(state_.displacements, state_.placements, trial_ghosted_, is_thorough) == 1.)
    return false;
  report.converged = false;
  report.is_explained = true;
  report.failure = path_failure_ +
                   ", or deeper into it than contact follows them. Try a smaller 'Smallest step', a larger "
                   "'Normal penalty' or smaller facets";
  return true;
}

bool QuasiStatic::turns_too_far(const double t, NewtonReport &report) const {
  // By the chord of an arc of 15 degrees the moment of friction is 0.9 % too small.
  constexpr double largest = M_PI / 12., rounding = 1e-9;
  for (const auto &contact : contacts_) {
    const std::size_t tool = contact.tool();
    const double angle =
        std::abs(place(tool, t, offsets_[tool]).rotation_angle - state_.placements[tool].rotation_angle);
    if (fading_forces_[tool] || !scene_.pairs()[contact.pair()].has_friction() ||
        angle <= largest * (1. + rounding) ||
        !(state_.tool_loads[tool].area > 0. || !all_ranks(!contact.has_touching_nodes())))
      continue;
    std::ostringstream text;
    text.precision(3);
    text << "tool '" << scene_.tools()[tool].name() << "' turns by " << angle * 180. / M_PI
         << " degrees in the step, and friction needs steps of at most " << largest * 180. / M_PI
         << ". Try a smaller "
         << (scene_.parameters().time_stepping.control == parameters::TimeStepping::Control::fixed
                 ? "'Initial step'"
                 : "'Smallest step'");
    report.converged = false;
    report.is_explained = true;
    report.failure = text.str();
    return true;
  }
  return false;
}

namespace {

constexpr const char *goes_unseen = " goes to and fro, or around, within the step";

} // namespace

bool QuasiStatic::skips_motion(const double t, NewtonReport &report) const {
  if (!may_be_cut(t))
    return false;
  const std::string unseen = motions_.find_unseen(state_.time, t);
  if (unseen.empty())
    return false;
  report.converged = false;
  report.is_explained = true;
  report.failure = unseen + goes_unseen;
  return true;
}

DiagnosticList QuasiStatic::check_motion(const double t) const {
  if (may_be_cut(t)) // and was not
    return {};
  const std::string unseen = motions_.find_unseen(state_.time, t);
  if (unseen.empty())
    return {};
  return {Diagnostic(diagnostic::unseen_motion, unseen + goes_unseen).time(t)};
}

namespace {

bool raises_any(const std::vector<double> &factors) {
  return std::any_of(factors.begin(), factors.end(), [](const double factor) { return factor > 1.; });
}

} // namespace

std::vector<double> QuasiStatic::raises_of_penalties() const {
  constexpr double least_raise = 2., largest_raise = 8.;
  std::vector<double> factors =
      of_contacts([](const auto &contact) { return contact.excessive_penetration(); });
  dealii::Utilities::MPI::max(factors, discretization_.communicator(), factors);
  const std::vector<double> room = stiffening_left();
  const auto &stepping = scene_.parameters().time_stepping;
  constexpr double short_step = 0.01; // of the first one
  // Contact follows nodes to 0.4 of a facet, four times what default penalties allow.
  constexpr double deep = 3.6;
  const bool is_short = stepping.control == parameters::TimeStepping::Control::automatic &&
                        time_ - state_.time < short_step * stepping.initial_step;
  const std::vector<bool> has_tolerance = of_contacts(
                              [](const auto &contact) { return contact.settings().has_tolerance(); }),
                          has_own_penalty = of_contacts(
                              [](const auto &contact) { return contact.settings().input->has_own_penalty; });
  for (std::size_t i = 0; i < factors.size(); ++i) {
    // A penalty that the scene sets stays while it can; the warnings tell what it makes softer. It cannot
    // where nodes are about to go deeper than contact follows them.
    const bool is_too_much =
        !motion_ && !has_tolerance[i] && factors[i] > (has_own_penalty[i] && !is_short ? deep : 1.);
    const double raise =
        std::min(std::clamp(2. * factors[i], least_raise, largest_raise), most_raise * room[i]);
    factors[i] = is_too_much && raise >= least_raise ? whole_octaves(raise) : 1.;
  }
  return factors;
}

bool QuasiStatic::penetrates(NewtonReport &report) {
  if (is_probing_)
    return false;
  raises_ = raises_of_penalties();
  if (!raises_any(raises_))
    return false;
  report.converged = false;
  report.penetrates = true;
  report.failure = "nodes penetrate too deep";
  return true;
}

void QuasiStatic::evaluate_start() {
  const double t_n = state_.time;
  for (auto &contact : contacts_) {
    const Placement &now = state_.placements[contact.tool()];
    contact.start_step(now, now, 0.);
    contact.set_allowed_part(scene_.pairs()[contact.pair()].overlap.allowed_part(t_n));
    contact.restart();
  }
  for (auto &contact : body_contacts_) {
    contact->start_step(t_n, t_n);
    contact->restart();
  }
  duration_ = 0.;
  if (stabilisation_)
    stabilisation_->start_step(0.);
  time_ = t_n;
  offsets_ = offsets_n_;
  choose_unknown_tools({});
  Epetra_Vector x = unknowns(), ignored(x);
  compute_residual(x, ignored);
}

DiagnosticList QuasiStatic::describe_raises(const std::vector<double> &factors) const {
  DiagnosticList messages;
  for (std::size_t i = 0; i < factors.size(); ++i) {
    if (!(factors[i] > 1.))
      continue;
    const bool is_tool = i < contacts_.size();
    const std::size_t n_tools = contacts_.size();
    const parameters::ContactPair &input =
        is_tool ? *scene_.pairs()[contacts_[i].pair()].input : *scene_.body_pairs()[i - n_tools].input;
    const double penalty = input.normal_penalty *
                           (is_tool ? contacts_[i].stiffening() : body_contacts_[i - n_tools]->stiffening());
    const bool is_factor = input.penalty_unit == parameters::ContactPair::PenaltyUnit::factor;
    std::ostringstream text;
    text.precision(3);
    text << "The penalty of the pair was raised " << factors[i] << " times, to " << penalty
         << (is_factor ? " E/h" : "") << ", since nodes penetrated too deep with it";
    messages.push_back(Diagnostic(diagnostic::penalty_raised, text.str())
                           .pair(input.name)
                           .time(state_.time)
                           .value("factor", factors[i])
                           .measure(is_factor ? "penalty [E/h]" : "penalty", penalty));
  }
  return messages;
}

DiagnosticList QuasiStatic::control_penalties() {
  if (!motion_ || !penalties_.is_used())
    return {};
  const MPI_Comm communicator = discretization_.communicator();
  const PenaltyControl::Energies energies =
      penalties_.measure(*this, scene_.bodies().size(), state_.time, communicator);
  const auto room =
      of_contacts([&](const auto &contact) { return penalties_.room_of(contact, communicator); });
  const std::vector<PenaltyControl::Factors> factors = penalties_.raises(energies, room);
  if (std::none_of(factors.begin(), factors.end(), [](const auto &factor) { return factor.raises(); }))
    return {};
  for (std::size_t i = 0; i < factors.size(); ++i) {
    if (!factors[i].raises())
      continue;
    const auto [normal, tangential] = factors[i];
    if (i < contacts_.size())
      contacts_[i].stiffen_under_load(normal, tangential);
    else
      body_contacts_[i - contacts_.size()]->stiffen_under_load(normal, tangential);
    // With the same force a stiffer spring holds less: the rest stays in the penetration that is allowed now.
    const double lost =
        (1. - 1. / normal) * energies.of_pairs[i] + (1. - 1. / tangential) * energies.sticking[i].stored;
    book_in_springs(i, -lost);
    state_.energies.numerical += lost;
  }
  spring_round_off_ = find_spring_round_off();
  return penalties_.take_diagnostics();
}

void QuasiStatic::book_in_springs(const std::size_t contact, const double energy) {
  state_.energies.contact += energy;
  if (contact < contacts_.size())
    tool_pair_energies_[contact] += energy;
  else
    state_.body_pair_loads[contact - contacts_.size()].stored_energy += energy;
}

void QuasiStatic::raise_penalties(const std::vector<double> &factors) {
  const auto stored_energies = [&] {
    std::vector<double> energies;
    for (auto &contact : contacts_)
      energies.push_back(contact.compute_load().stored_energy);
    for (auto &contact : body_contacts_)
      energies.push_back(contact->compute_load().stored_energy);
    return energies;
  };
  evaluate_start();
  const std::vector<double> before = stored_energies();
  for (std::size_t i = 0; i < factors.size(); ++i)
    if (factors[i] > 1.)
      stiffen(i, factors[i]);
  spring_round_off_ = find_spring_round_off();
  evaluate_start();
  const std::vector<double> after = stored_energies();
  for (std::size_t i = 0; i < factors.size(); ++i) {
    const double given = after[i] - before[i];
    book_in_springs(i, given);
    state_.energies.external += given;
    if (i < contacts_.size()) {
      const std::size_t tool = contacts_[i].tool();
      state_.tool_loads[tool] = ContactLoad();
      for (const auto &contact : contacts_)
        if (contact.tool() == tool)
          state_.tool_loads[tool] += contact.compute_load();
    }
  }
  support_forces_n_ = support_forces_;
  contact_forces_n_ = contact_forces_;
  probe_.reset();
}

} // namespace billet
