// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/explicit/explicit_dynamics.h"

#include "billet/fail_together.h"

namespace billet {

namespace {

/// Returns the scheme's name in checkpoints.
const std::string &name_of_scheme() {
  return parameters::name_of(parameters::TimeStepping::Scheme::explicit_dynamics);
}

} // namespace

ExplicitDynamics::ExplicitDynamics(const Scene &scene, const Discretization &discretization)
    : parts_(scene, discretization), ledger_(parts_), stable_step_(parts_.settings().safety_factor),
      start_gaps_(scene), crossing_limit_(parts_), penalties_(parts_), reactions_(parts_) {
  state_.body_pair_loads.resize(parts_.contacts.of_bodies().size());
  state_.tool_loads.resize(parts_.tools.size());
  state_.placements.resize(parts_.tools.size());
  state_.displacements = discretization.make_ghosted_vector();
  state_.velocities = discretization.make_ghosted_vector();
}

ExplicitDynamics::~ExplicitDynamics() = default;

void ExplicitDynamics::compute_forces() {
  const ExplicitForces::Failure failure = parts_.forces.compute(
      parts_.clock, parts_.motion, parts_.elements, parts_.contacts, parts_.tools, ledger_.works());
  const double resolution = parts_.settings().contact_resolution;
  if (!stable_step_.update(parts_.forces.bounds(parts_.masses.inverse()),
                           resolution * resolution * parts_.tools.max_frequency_square(),
                           parts_.communicator()))
    fail_together(parts_.communicator(), [&failure] {
      if (failure)
        std::rethrow_exception(failure);
    });
  if (const Explanation collapse = stable_step_.describe_collapse(); !collapse.empty())
    throw parts_.clock.failure(collapse);
  crossing_limit_.update(stable_step_.value(), ledger_.max_energy_when_due());
}

void ExplicitDynamics::prepare_step(const double event) {
  compute_forces();
  parts_.clock.plan(event, stable_step_.allowed(crossing_limit_.value()));
  parts_.motion.kick(parts_.clock, parts_.masses, parts_.forces.values());
  parts_.tools.kick(parts_.clock);
  if (!parts_.clock.is_at_start())
    add_works(parts_.motion.velocities_before(), 0.5 * parts_.clock.step_before());
}

void ExplicitDynamics::add_works(const NodalVectors &velocities, const double half) {
  ledger_.add_works(velocities, half);
  parts_.forces.of_loads().add_works(velocities, half);
}

double ExplicitDynamics::usual_step_at(const double t,
                                       const std::vector<dealii::Tensor<1, 3>> &translations) {
  NodalVectors displacements = parts_.nodes.make_vectors();
  for (std::size_t b = 0; b < translations.size(); ++b)
    for (const auto &element : parts_.nodes.elements(b))
      for (const unsigned int node : element)
        for (unsigned int i = 0; i < 3; ++i)
          displacements[std::size_t{nodal_stride} * node + i] = translations[b][i];
  std::vector<Placement> placements;
  for (const Tool &tool : parts_.scene.tools())
    placements.push_back(tool.placement(t));
  return stable_step_.usual_with(
      parts_.forces.frequency_square_at(displacements, placements, parts_.contacts, parts_.masses.inverse()),
      parts_.communicator());
}

void ExplicitDynamics::raise_penalties() {
  if (!penalties_.are_controlled() || !ledger_.is_due())
    return;
  update_ledger();
  penalties_.raise(*this, ledger_.works().external);
}

void ExplicitDynamics::finish_step() {
  raise_penalties(); // energy added to springs shows in the next ledger: this one is written
  parts_.motion.move(parts_.clock.step());
  parts_.tools.move(parts_.clock);
  add_works(parts_.motion.velocities(), 0.5 * parts_.clock.step());
  const double t_forces = time();
  parts_.clock.advance();
  parts_.motion.switch_supports(t_forces, time());
  parts_.tools.remove_due(time(), parts_.contacts, ledger_.works().external);
}

void ExplicitDynamics::update_ledger() {
  ledger_.update(state_);
  reactions_.update();
  start_gaps_.add(parts_.contacts, time(), parts_.communicator());
}

void ExplicitDynamics::update_state() {
  update_ledger();
  parts_.nodes.copy(parts_.motion.displacements(), state_.displacements);
  parts_.nodes.copy(parts_.motion.mean_velocities(), state_.velocities);
}

DiagnosticList ExplicitDynamics::check_steps() const {
  return stable_step_.check(time(), parts_.contacts, parts_.communicator());
}

std::array<std::size_t, 2> ExplicitDynamics::history_sizes() const {
  std::array<std::size_t, 2> sizes{parts_.elements.history_size(), parts_.contacts.history_size()};
  for (auto &size : sizes)
    size = dealii::Utilities::MPI::sum(size, parts_.communicator());
  return sizes;
}

std::string ExplicitDynamics::method() const {
  return parts_.settings().number_type == NumberType::float_precision
             ? "central differences, elements in float"
             : "central differences";
}

void ExplicitDynamics::save(StateWriter &writer) const {
  const NodalRows rows(parts_.nodes);
  writer.write_text("scheme", name_of_scheme());
  parts_.clock.save(writer);
  parts_.motion.save(writer, rows, parts_.clock.step());
  ledger_.save(writer, state_.energies);
  parts_.forces.of_loads().save(writer);
  penalties_.save(writer);
  start_gaps_.save(writer);
  parts_.elements.save(writer);
  parts_.tools.save(writer, rows, parts_.forces.loaded_nodes());
  for (const auto &contact : parts_.contacts)
    writer.in(group(contact.group_kind(), contact.group_index()), [&] {
      save_pair(writer, contact);
      contact.save(writer, rows.keys());
    });
}

RestartReport ExplicitDynamics::load(StateReader &reader) {
  const NodalRows rows(parts_.nodes);
  RestartReport report;
  // Other tools or pairs do not affect the restart of the rest.
  const bool is_exact =
      reader.read_text("scheme") == name_of_scheme() && parts_.elements.has_same_formulations(reader);
  report.is_exact = is_exact;
  compare_parts(reader, parts_.scene, report);
  if (is_exact) {
    parts_.clock.load(reader);
    parts_.motion.load(reader, rows);
    parts_.elements.load(reader, time(), parts_.motion.displacements_before(step_length()));
  } else {
    parts_.clock.begin(reader.number(reader.has("time before") ? "time before" : "time"));
    parts_.motion.load_foreign(reader, rows);
    parts_.nodes.copy(parts_.motion.displacements(), state_.displacements);
    parts_.elements.load_stresses(reader, parts_.motion.displacements(), state_.displacements, time());
  }
  parts_.motion.load_supports(reader, rows, time());
  parts_.tools.load(reader, rows, is_exact, time());
  load_contacts(reader, rows.keys());
  state_.energies = ledger_.load(reader, is_exact);
  // A refinement at this time saves the state before new forces.
  if (is_exact && dealii::Utilities::MPI::this_mpi_process(parts_.communicator()) == 0)
    parts_.elements.set_energies(state_.energies.elastic, state_.energies.hourglass);
  if (is_exact)
    parts_.forces.of_loads().load(reader);
  if (is_exact)
    penalties_.load(reader);
  start_gaps_.load(reader);
  report.time = time();
  return report;
}

void ExplicitDynamics::load_contacts(StateReader &reader, const NodeKeys &keys) {
  // Contact was committed with the last forces. The step is 0 if they are those of the present
  // time.
  const NodalVectors u_before = parts_.motion.displacements_before(step_length());
  const std::vector<Placement> placements = parts_.tools.placements_before();
  for (auto &contact : parts_.contacts) {
    // Contact keeps its initial state where the coarser mesh has no data.
    const bool begins = is_refined(reader, contact);
    if (begins)
      contact.without_matrix().begin({0., 0., 0., placements, placements}, u_before);
    if (!load_pair(reader, contact, [&] { contact.load(reader, keys); }) && !begins)
      contact.without_matrix().begin({0., 0., 0., placements, placements}, u_before);
    contact.fade_gaps(time(), end_of_fading(parts_.scene.parameters(), time()), begins);
  }
}

} // namespace billet
