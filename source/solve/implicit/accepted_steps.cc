// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/accepted_steps.h"

#include <algorithm>

namespace billet {

AcceptedStep AcceptedSteps::describe(const double t) const {
  const StepState &step = p_.problem.step();
  const SolutionState &state = p_.problem.state();
  const double contact_at_start = parts_.scheme().contact().at_start();
  return {state.time,
          t,
          step.start,
          step.trial,
          step.last_increment,
          contact_at_start,
          parts_.contacts().compute_step_works(1. - contact_at_start),
          state.tool_loads,
          state.placements};
}

void AcceptedSteps::commit(const double t) {
  StepState &state = p_.problem.step();
  state.last_increment = state.trial.displacements;
  state.last_increment -= state.start.displacements;
  parts_.tools().commit();
  const AcceptedStep step = describe(t);
  add_works(step);
  p_.diagnosis.commit();
  set_contact_loads(step);
  move_tools(step);
  advance(step);
}

void AcceptedSteps::add_works(const AcceptedStep &step) {
  EnergyLedger &energies = p_.problem.state().energies;
  // Work of the supports and of the tools, by the trapezoidal rule, but with (I4) that of contact
  // by its forces at the end.
  energies.external -= parts_.removal().work(step.start_time, step.end_time, step.increment);
  if (!parts_.released().are_of_refinement())
    energies.external += parts_.released().work(step.start_time, step.end_time, step.increment);
  energies.external += parts_.switched_supports().work(step.start_time, step.end_time, step.increment);
  p_.rules.commit(step.end_time);
  Vector mean_forces = step.trial.supports;
  mean_forces += step.start.supports;
  mean_forces *= 0.5;
  mean_forces.add(0.5 - step.contact_at_start, step.trial.contact, step.contact_at_start - 0.5,
                  step.start.contact);
  p_.reactions.set_loads(parts_.scheme().commit(step.trial.displacements, step.increment, mean_forces,
                                                step.of_contact.touching, energies));
  energies.external += step.of_contact.ramp;
}

void AcceptedSteps::set_contact_loads(const AcceptedStep &step) {
  SolutionState &state = p_.problem.state();
  const ContactSet &contacts = parts_.contacts();
  std::fill(state.tool_loads.begin(), state.tool_loads.end(), ContactLoad());
  state.energies.contact = 0.;
  auto body_pair_load = state.body_pair_loads.begin();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactLoad load = contacts[i].measures().compute_load();
    if (const auto &tool = contacts[i].rigid_tool()) {
      state.tool_loads[*tool] += load;
      p_.books.set(i, load.stored_energy);
      p_.reactions.set_pair(contacts[i].group_index(), load,
                            contacts[i].measures().penetration_between_nodes(),
                            parts_.tools().place(*tool, step.end_time, parts_.tools().offsets()[*tool]));
    } else {
      *body_pair_load++ = load;
      state.energies.contact += load.stored_energy;
      state.energies.friction += load.dissipation;
    }
  }
  parts_.removal().visit_fading(step.end_time, [&](const RemovedForces &removed, const double left) {
    const Placement placement =
        parts_.tools().place(removed.tool, step.end_time, parts_.tools().offsets()[removed.tool]);
    const Resultant resultant = removed.forces.resultant(step.trial.displacements);
    ContactLoad load;
    load.force = left * resultant.force;
    load.moment = left * resultant.moment - dealii::cross_product_3d(placement.moved_centre(), load.force);
    state.tool_loads[removed.tool] += load;
    p_.reactions.add_removed(removed.pair, load, placement);
  });
}

void AcceptedSteps::move_tools(const AcceptedStep &step) {
  SolutionState &state = p_.problem.state();
  const auto &tools = parts_.scene().tools();
  for (std::size_t i = 0; i < tools.size(); ++i) {
    const ContactLoad &load = state.tool_loads[i], &load_n = step.tool_loads[i];
    const Placement &placement_n = step.placements[i];
    Placement &placement = state.placements[i];
    placement = parts_.tools().place(i, step.end_time, parts_.tools().offsets()[i]);
    if (parts_.removal().is_removed(i)) // it does no work
      continue;
    const double turn = placement.rotation_angle - placement_n.rotation_angle;
    state.energies.external +=
        step.mean_of_contact(load_n.force, load.force) * (placement.translation - placement_n.translation) +
        step.mean_of_contact(load_n.moment, load.moment) * tools[i].rotation_axis() * turn;
    state.energies.contact += load.stored_energy;
    state.energies.friction += load.dissipation;
    if (parts_.scheme().tools().has_mass(i))
      parts_.scheme().tools().commit(i, parts_.tools().offsets()[i], parts_.tools().exerted_load(i),
                                     tools[i].load(step.end_time), state.energies);
  }
}

void AcceptedSteps::advance(const AcceptedStep &step) {
  parts_.internal().commit();
  for (auto &contact : parts_.contacts())
    contact.commit();
  StepState &state = p_.problem.step();
  state.start = state.trial;
  SolutionState &solution = p_.problem.state();
  solution.time = step.end_time;
  solution.displacements = state.start.displacements;
}

} // namespace billet
