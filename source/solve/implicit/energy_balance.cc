// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/energy_balance.h"

#include "billet/diagnostic_kinds.h"
#include "billet/solve/implicit/implicit_motion.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace billet {

std::optional<StepFailure> EnergyBalance::judge_accuracy(double /*t*/) {
  trial_energies_ = parts_.internal().compute_energies(problem_.step().ghosted, Beat::evaluated);
  return {};
}

EnergyBalance::ElementImbalance EnergyBalance::element_imbalance() const {
  const StepState &step = problem_.step();
  const EnergyLedger &energies = problem_.state().energies;
  Vector increment = step.trial.displacements, mean = step.trial.internal;
  increment -= step.start.displacements;
  mean += step.start.internal;
  const double dissipated = std::abs(trial_energies_.plastic - energies.plastic);
  const double missed = trial_energies_.total() - energies.of_elements() - 0.5 * (mean * increment);
  const double by_yielding = std::clamp(missed, -dissipated, dissipated);
  return {by_yielding, missed - by_yielding};
}

EnergyBalance::ContactLoss EnergyBalance::contact_loss(const double t, const double works) const {
  const StepState &step = problem_.step();
  const SolutionState &state = problem_.state();
  const ContactSet &contacts = parts_.contacts();
  const double before = parts_.scheme().contact().at_start();
  Vector mean = step.trial.contact, increment = step.trial.displacements;
  mean *= 1. - before;
  mean.add(before, step.start.contact);
  increment -= step.start.displacements;
  ContactLoss loss;
  loss.total = mean * increment + state.energies.contact;
  const auto &tools = parts_.scene().tools();
  const Contacts::Loads loads = contacts.compute_loads();
  for (std::size_t i = 0; i < loads.of_tools.size(); ++i) {
    if (parts_.removal().is_removed(i))
      continue;
    const ContactLoad &load = loads.of_tools[i], &load_n = state.tool_loads[i];
    const Placement to = parts_.tools().place(i, t, parts_.tools().offsets()[i]);
    loss.total += ((1. - before) * load.force + before * load_n.force) *
                      (to.translation - state.placements[i].translation) +
                  ((1. - before) * load.moment + before * load_n.moment) * tools[i].rotation_axis() *
                      (to.rotation_angle - state.placements[i].rotation_angle) -
                  load.stored_energy - load.dissipation;
    loss.friction += load.damping;
  }
  for (const ContactLoad &load : loads.of_body_pairs) {
    loss.total -= load.stored_energy + load.dissipation;
    loss.friction += load.damping;
  }
  loss.total += works;
  return loss;
}

bool EnergyBalance::contact_makes_energy() const {
  return !parts_.contacts().of_bodies().empty() &&
         -contact_balance_ > 0.5 * std::abs(problem_.state().energies.drift());
}

void EnergyBalance::update_max_energy() {
  const EnergyLedger &energies = problem_.state().energies;
  // As in the output: the present energy counts half, so that spurious energy does not hide itself.
  max_energy_ = std::max(
      {max_energy_, 0.5 * std::abs(energies.total()), std::abs(energies.initial + energies.external)});
}

void EnergyBalance::save(StateWriter &writer) const {
  writer.write("largest energy", {max_energy_});
  writer.write("contact balance", {contact_balance_});
}

void EnergyBalance::load(const StateReader &reader) {
  max_energy_ = reader.number("largest energy");
  contact_balance_ = reader.number("contact balance");
}

std::optional<StepFailure> StaticBalance::judge_contact(const double t, DiagnosticList &messages) {
  trial_contact_loss_ = 0.;
  if (parts_.contacts().empty())
    return {};
  const StepState &step = problem_.step();
  Vector increment = step.trial.displacements, mean = step.trial.internal;
  increment -= step.start.displacements;
  mean += step.start.internal;
  const double internal_work = 0.5 * (mean * increment);
  mean = step.trial.contact;
  mean += step.start.contact;
  const double contact_work = 0.5 * (mean * increment);
  const StepWorks springs = parts_.contacts().compute_step_works(1. - parts_.scheme().contact().at_start());
  trial_contact_loss_ = contact_loss(t, springs.ramp + springs.touching).total;
  const StepEnergy::Works works{trial_contact_loss_,
                                std::max(std::abs(internal_work), std::abs(contact_work)), max_energy_};
  const double floor = problem_.scales().round_off * parts_.discretization().radius();
  const double t_n = problem_.state().time;
  const StepEnergy::Verdict verdict = step_energy_.judge(t_n, t - t_n, works, floor);
  if (verdict == StepEnergy::Verdict::balanced)
    return {};
  const double percent = 100. * StepEnergy::part_of_all(works);
  std::ostringstream text;
  text.precision(3);
  text << "contact " << (works.imbalance > 0. ? "loses" : "creates") << " energy in the step to time " << t
       << ": " << percent << " % of all work so far";
  if (verdict == StepEnergy::Verdict::jump) {
    trial_contact_loss_ = 0.;
    messages.push_back(
        Diagnostic(diagnostic::energy_imbalance, text.str())
            .time(t)
            .measure("part of all work [%]", percent)
            .advice("Smaller steps do not change this. The solution jumps to another branch, as when one "
                    "body slips off another, or bodies pass through each other. Check the field output at "
                    "this time; 'Scheme = implicit dynamics' resolves jumps"));
    return {};
  }
  text << ", more than the allowed " << 100. * StepEnergy::max_part
       << " %. The solution jumps to another branch, or bodies pass through each other";
  return StepFailure{
      StepFailure::Kind::explained,
      {text.str(), "Reduce 'Maximum step' or the penalty, or use a finer mesh where they touch"}};
}

void StaticBalance::commit(double /*t*/) {
  contact_balance_ += trial_contact_loss_;
  problem_.state().energies.external += element_imbalance().by_yielding; // (A3)
}

DiagnosticList StaticBalance::finish() const {
  const double floor = problem_.scales().round_off * parts_.discretization().radius();
  if (!(std::abs(contact_balance_) > std::max(Limits::doubtful * max_energy_, floor)))
    return {};
  const double percent = 100. * contact_balance_ / max_energy_;
  std::ostringstream text;
  text.precision(3);
  text << "Over the whole run contact " << (percent > 0. ? "loses " : "creates ") << std::abs(percent)
       << " % of all work";
  return {Diagnostic(diagnostic::energy_imbalance, text.str())
              .time(problem_.state().time)
              .measure("part of all work [%]", percent)
              .advice("Contact forces do not match the motion. Reduce 'Maximum step', or use a finer mesh "
                      "where bodies touch; check the contact in the field output")};
}

void StaticBalance::save(StateWriter &writer) const {
  EnergyBalance::save(writer);
  writer.write("rejected step", step_energy_.save());
}

void StaticBalance::load(const StateReader &reader) {
  EnergyBalance::load(reader);
  step_energy_.load(reader.read("rejected step", 2));
}

double DynamicBalance::max_energy_of_trial() const {
  return std::max(max_energy_, std::abs(trial_energies_.total()));
}

double DynamicBalance::energy_error(const double imbalance) const {
  const double maximum = std::max(max_energy_of_trial(), 0.5 * std::abs(problem_.state().energies.total()));
  const double allowed = std::max(Limits::always * maximum,
                                  Limits::of_rest * (Limits::of_run * maximum - std::abs(element_balance_)));
  return allowed > 0. ? std::abs(imbalance) / allowed : 0.;
}

std::optional<StepFailure> DynamicBalance::judge_accuracy(const double t) {
  EnergyBalance::judge_accuracy(t);
  motion_.contact().finish(problem_.step().trial.contact);
  time_error_ = motion_.step_error(problem_.step().trial.displacements);
  std::ostringstream message;
  message.precision(3);
  message << "the time integration error of the step is " << time_error_ << " times the 'Error tolerance'";
  std::string advice =
      "If a tool, support or load starts or stops at once, use an amplitude with 'Interpolation "
      "= smooth'. Try a smaller 'Minimum step' or a larger 'Error tolerance'";
  trial_imbalance_ = element_imbalance().unexplained;
  if (paths_.may_be_cut(t)) {
    const double error = energy_error(trial_imbalance_);
    if (error > std::max(1., time_error_)) {
      message.str("");
      message << "the work of the internal forces in the step differs from their energy by " << error
              << " times the allowed error";
      advice = "Try a smaller 'Minimum step'";
    }
    time_error_ = std::max(time_error_, error);
  }
  if (time_error_ <= 1.)
    return {};
  return StepFailure{StepFailure::Kind::explained, {message.str(), advice}};
}

EnergyBalance::ContactLoss DynamicBalance::dynamic_loss(const double t) const {
  return contact_loss(t, parts_.contacts().compute_step_works(1. - motion_.contact().at_start()).ramp);
}

double DynamicBalance::taken_by_contact(const ContactLoss &loss) const {
  return std::max(0., motion_.contact().is_on()
                          ? loss.total
                          : contact_balance_ + loss.total - Limits::may_make * max_energy_of_trial());
}

std::optional<StepFailure> DynamicBalance::judge_contact(const double t, DiagnosticList & /*messages*/) {
  update_max_energy();
  const double maximum = max_energy_of_trial(); // in the first step there has been none before
  const ContactLoss loss = dynamic_loss(t);
  if (!motion_.contact().is_on() && contact_balance_ + loss.total < -Limits::may_make * maximum)
    return StepFailure{StepFailure::Kind::makes_energy, {"contact creates energy in the step", ""}};
  // The step is so long that bodies meet within it rather than at its end.
  if (taken_by_contact(loss) - loss.friction > Limits::may_take * maximum && paths_.may_be_cut(t))
    return StepFailure{StepFailure::Kind::explained, {"contact removes energy in the step", ""}};
  return {};
}

void DynamicBalance::commit(const double t) {
  const ContactLoss loss = dynamic_loss(t);
  EnergyLedger &energies = problem_.state().energies;
  const double taken = taken_by_contact(loss);
  if (motion_.contact().is_on()) {
    const double by_friction = std::min(taken, loss.friction);
    contact_losses_.add(ContactLosses::friction, by_friction);
    contact_losses_.add(ContactLosses::impacts, taken - by_friction);
  } else
    contact_losses_.add(ContactLosses::crossings, taken);
  contact_balance_ += loss.total - taken;
  energies.numerical += taken;
  // Areas that change take energy at one time and return it at another.
  const double returned = contact_losses_.give_back(std::max(0., -contact_balance_));
  contact_balance_ += returned;
  energies.numerical -= returned;
  element_balance_ += trial_imbalance_;
}

DiagnosticList DynamicBalance::check() { return contact_losses_.watch(max_energy_, problem_.state().time); }

void DynamicBalance::save(StateWriter &writer) const {
  EnergyBalance::save(writer);
  writer.write("element balance", {element_balance_});
  writer.write("contact losses", contact_losses_.save());
}

void DynamicBalance::load(const StateReader &reader) {
  EnergyBalance::load(reader);
  element_balance_ = reader.number("element balance");
  contact_losses_.load(reader.read("contact losses"));
}

} // namespace billet
