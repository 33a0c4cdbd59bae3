// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/initial_motion.h"

#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"
#include "billet/solve/implicit/implicit_motion.h"

#include <sstream>

namespace billet {

void InitialMotion::start() {
  check_before_start([&] {
    Vector x = problem_.unknowns(), ignored(x);
    if (!problem_.compute_residual(x, ignored))
      throw SolutionFailure(parts_.parameters().file_name +
                            ": the displacements that supports prescribe at time 0 invert an element; "
                            "allowed are small ones, since the rest of the body starts undeformed");
  });
  StepState &step = problem_.step();
  SolutionState &state = problem_.state();
  const Contacts::Loads loads = problem_.start_from_trial();
  motion_.follow_loads(state.time, true, step.start.supports);
  check_before_start([&] { accelerate(); });

  const auto energies = parts_.internal().compute_energies(state.displacements);
  state.energies.elastic = energies.elastic;
  state.energies.hourglass = energies.hourglass;
  for (const auto *of : {&loads.of_tools, &loads.of_body_pairs})
    for (const ContactLoad &load : *of)
      state.energies.contact += load.stored_energy;
  motion_.update_state(state);
  state.energies.initial = state.energies.total();
}

void InitialMotion::accelerate() {
  TangentMatrix &tangent = parts_.tangent();
  tangent.matrix() = 0.;
  motion_.add_mass({parts_.supports().homogeneous(), tangent.matrix()});
  tangent.matrix().compress(dealii::VectorOperation::add);
  Vector rhs = motion_.driving_forces(problem_.step().start.supports),
         accelerations = parts_.discretization().make_owned_vector();
  parts_.supports().condense(rhs);
  if (tangent.solver().is_iterative()) {
    tangent.solver().start_contact({}); // the mass matrix has no contact
    tangent.set_geometry(problem_.step().trial.displacements);
  }
  if (!tangent.solver().factorize() || !tangent.solve(rhs, tolerance, accelerations)) {
    std::ostringstream message;
    message << parts_.parameters().file_name
            << ": the mass matrix cannot be solved for the accelerations: " << tangent.solver().failure();
    throw SolutionFailure(Diagnostic(diagnostic::solution_failed, message.str())
                              .time(problem_.state().time)
                              .advice("Check the units of the densities"));
  }
  motion_.set_accelerations(accelerations);
  const auto &tools = parts_.scene().tools();
  for (std::size_t tool = 0; tool < tools.size(); ++tool)
    if (motion_.tools().has_mass(tool))
      motion_.tools().start(tool, parts_.tools().exerted_load(tool), tools[tool].load(problem_.state().time));
}

void InitialMotion::load(StateReader &reader, RestartReport &report) {
  const OwnedNodes nodes(parts_.discretization(), NodeKeys(parts_.discretization()));
  SolutionState &state = problem_.state();
  if (report.is_exact) {
    motion_.load(reader, nodes);
  } else {
    report.imbalance = 0.; // it accelerates the bodies
    motion_.begin(reader, nodes, state.time);
  }
  const auto &tools = parts_.scene().tools();
  for (std::size_t i = 0; i < tools.size(); ++i)
    if (const auto found = find_group(reader, "tool", tools[i].name()))
      reader.in(group("tool", *found), [&] { motion_.tools().load(i, reader, report.is_exact); });
  if (report.is_exact) {
    motion_.update_state(state);
    return;
  }
  motion_.follow_loads(state.time, true, problem_.step().start.supports);
  accelerate();
  const double drift = state.energies.drift();
  motion_.update_state(state);
  const double change = drift - state.energies.drift();
  report.energy_change += change;
  state.energies.initial += change; // energy of initial velocities is not drift
}

} // namespace billet
