// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/explicit/explicit_penalties.h"

#include <algorithm>

namespace billet {

ExplicitPenalties::ExplicitPenalties(ExplicitParts &parts)
    : parts_(parts), control_(parts.scene, parts.discretization, PenaltyControl::in_explicit_scenes) {}

void ExplicitPenalties::raise(const Solution &solution, double &external_work) {
  const MPI_Comm communicator = parts_.communicator();
  const PenaltyControl::Energies energies =
      control_.measure(solution, parts_.scene.bodies().size(), parts_.clock.time(), communicator);
  const auto room = parts_.contacts.collect(
      [&](const auto &contact) { return control_.room_of(contact.penalties(), communicator); });
  const std::vector<PenaltyControl::Factors> factors = control_.raises(energies, room);
  for (std::size_t p = 0; p < factors.size(); ++p) {
    if (!factors[p].raises())
      continue;
    const auto [normal, tangential] = factors[p];
    parts_.contacts[p].penalties().scale(normal, tangential);
    // Compressed springs receive the energy that stiffer ones store. The force of friction stays,
    // and its springs store less.
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      external_work +=
          (normal - 1.) * energies.of_pairs[p] - (1. - 1. / tangential) * energies.sticking[p].stored;
  }
}

DiagnosticList ExplicitPenalties::check(const EnergyLedger &energies) {
  DiagnosticList messages = control_.take_diagnostics();
  // Maxima over all ranks: the displacement, and for each pair the penetration, in facet sizes and
  // as length.
  std::vector<double> maxima{parts_.motion.max_displacement()};
  for (const auto &contact : parts_.contacts) {
    const Penetration deepest = contact.measures().penetration();
    maxima.insert(maxima.end(), {deepest.of_facet, deepest.length});
  }
  dealii::Utilities::MPI::max(maxima, parts_.communicator(), maxima);

  // Part of the energy in the springs of all pairs.
  const double part = energies.total() > 0. ? energies.contact / energies.total() : 0.;
  const double time = parts_.clock.time();
  auto next = maxima.begin() + 1;
  for (const auto &contact : parts_.contacts) {
    double moved = maxima[0];
    if (const auto &tool = contact.rigid_tool())
      moved = std::max(moved, max_motion(parts_.scene.tools()[*tool].placement(0.), parts_.tools[*tool].now(),
                                         parts_.discretization.radius()));
    append(messages, watch_.check(contact.name(), time, {next[0], next[1]}, moved, part));
    next += 2;
    append(messages, contact.checks().check_step());
  }
  return messages;
}

void ExplicitPenalties::save(StateWriter &writer) const {
  watch_.save(writer);
  control_.save(writer);
}

void ExplicitPenalties::load(const StateReader &reader) {
  watch_.load(reader);
  control_.load(reader);
}

} // namespace billet
