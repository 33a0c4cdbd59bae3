// SPDX-License-Identifier: LGPL-2.1-or-later
// What users should know: penalties that are too soft for what presses, or too stiff for sixteen digits, and
// where a step failed.
#include "billet/diagnostic_kinds.h"
#include "billet/solve/quasi_static.h"

#include <Epetra_Vector.h>

#include <algorithm>
#include <array>
#include <sstream>

namespace billet {

DiagnosticList QuasiStatic::check_augmentation() const {
  constexpr double much = 5e-3, percent = 100.;
  DiagnosticList messages;
  const std::vector<double> unsettled = softness_.unsettled();
  const std::vector<std::string> names = of_contacts([](const auto &contact) { return contact.name(); });
  for (std::size_t i = 0; i < unsettled.size(); ++i) {
    if (!(unsettled[i] > much))
      continue;
    std::ostringstream text;
    text.precision(2);
    text << "Augmentation was given up while it still changed the force by " << percent * unsettled[i]
         << " % of the largest: facets of the two sides do not fit, or a sharp edge bears";
    messages.push_back(Diagnostic(diagnostic::contact_unsettled, text.str())
                           .pair(names[i])
                           .measure("change / force", unsettled[i]));
  }
  return messages;
}

DiagnosticList QuasiStatic::check_penalties() {
  DiagnosticList messages;
  const double displacement = u_n_.linfty_norm();
  const double work = state_.energies.total();
  const auto look = [&](const std::string &name, Penetration deepest, const double moved,
                        const double stored_energy) {
    const MPI_Comm communicator = discretization_.communicator();
    deepest = {dealii::Utilities::MPI::max(deepest.of_facet, communicator),
               dealii::Utilities::MPI::max(deepest.length, communicator)};
    append(messages,
           soft_penalties_.check(name, state_.time, deepest, moved, work > 0. ? stored_energy / work : 0.));
  };
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    auto &contact = contacts_[i];
    const std::size_t tool = contact.tool();
    const double tool_moved =
        largest_motion(scene_.tools()[tool].placement(0.), state_.placements[tool], discretization_.radius());
    look(scene_.pairs()[contact.pair()].name, contact.penetration(), std::max(displacement, tool_moved),
         tool_pair_energies_[i]);
    append(messages, contact.check_nodes_behind());
  }
  for (std::size_t i = 0; i < body_contacts_.size(); ++i)
    look(body_contacts_[i]->name(), body_contacts_[i]->penetration(), displacement,
         state_.body_pair_loads[i].stored_energy);
  return messages;
}

std::string QuasiStatic::stiffest_pairs() const {
  std::vector<double> springs = of_contacts([](const auto &contact) { return contact.largest_spring(); });
  dealii::Utilities::MPI::max(springs, discretization_.communicator(), springs);
  const double stiffest = *std::max_element(springs.begin(), springs.end());
  const std::vector<std::string> of_pairs = of_contacts([](const auto &contact) { return contact.name(); });
  constexpr double as_stiff = 0.1;
  std::string names;
  for (std::size_t i = 0; i < springs.size(); ++i)
    if (springs[i] >= as_stiff * stiffest)
      names += (names.empty() ? "'" : ", '") + of_pairs[i] + "'";
  return names;
}

std::string QuasiStatic::describe_round_off(const double part) const {
  std::ostringstream text;
  text.precision(2);
  text << "round-off leaves " << part << " of the forces, allowed is " << max_stalled_residual
       << ": the penalty of contact pair " << stiffest_pairs()
       << " is too stiff for such small displacements and sixteen digits. Try a softer penalty, with a "
          "'Penetration tolerance' where that is too soft, or bodies nearer to the origin";
  return text.str();
}

Diagnostic QuasiStatic::describe_stall(const NewtonReport &report) const {
  Diagnostic diagnostic(
      diagnostic::stalled_step,
      "A step was accepted although Newton's method no longer came nearer to equilibrium: " +
          report.criteria);
  return diagnostic.time(time_)
      .measure("residual", report.measures.force)
      .value("energy", report.measures.energy)
      .value("correction", report.measures.correction)
      .value("status changes", report.measures.n_status_changes)
      .value("force of status changes", report.measures.status);
}

DiagnosticList QuasiStatic::check_round_off(const double part) const {
  const double tolerance = scene_.parameters().solver.force_tolerance * std::max(1., accuracy_);
  // Bodies that nothing acts on yet have no other forces than round-off, nor have those in flight.
  const bool is_loaded = !motion_ && force_scale_ > 0.1 * round_off_force_;
  // That of contact is told at the end, see check_contact_round_off().
  const bool is_of_contact = contact_round_off_force() > tolerance * force_scale_;
  if (!is_loaded || is_of_contact || part <= std::max(tolerance, notable_round_off))
    return {};
  std::ostringstream text;
  text.precision(2);
  text << "Round-off of displacements leaves " << part << " of the forces, 'Force tolerance' is " << tolerance
       << ": the forces are that small beside the stiffness of the bodies";
  return {Diagnostic(diagnostic::round_off_limits_forces, text.str())
              .time(time_)
              .measure("part of the forces", part)
              .advice("Place bodies nearer to the origin, or choose moduli less far apart")};
}

DiagnosticList QuasiStatic::check_contact_round_off() const {
  return round_off_.finish(scene_.parameters().solver.force_tolerance, motion_ != nullptr);
}

bool QuasiStatic::is_lost_in_round_off(const double t, NewtonReport &report) {
  // Where loads begin, and nodes lie on a tool but for their last bit, forces are small, and grow soon.
  constexpr unsigned int most_steps = 3;
  const bool is_last = t >= scene_.parameters().time_stepping.end_time;
  if (!report.is_lost_in_round_off || (n_in_round_off_ < most_steps && !is_last))
    return false;
  report.converged = false;
  return true;
}

bool QuasiStatic::goes_through_tool(NewtonReport &report) const {
  for (const auto &contact : contacts_)
    if (contact.has_thin_tool() && dealii::Utilities::MPI::max(contact.lets_nodes_through() ? 1 : 0,
                                                               discretization_.communicator()) > 0) {
      report.converged = false;
      report.failure = contact.describe_thin_tool();
      report.is_explained = true;
      return true;
    }
  return false;
}

bool QuasiStatic::may_be_round_off(const NewtonReport &report) const {
  if (motion_ || report.iterations.empty() || !(report.force > 0.)) // or it has not come to a residual
    return false;
  constexpr double by_much = 10.; // as solve_newton() has it
  return spring_round_off_ > most_round_off * force_scale_ &&
         report.force * force_scale_ <= by_much * spring_round_off_;
}

void QuasiStatic::find_slipping_tools() {
  slipping_tools_.clear();
  for (const std::size_t tool : unknown_tools_) {
    const Tool &which = scene_.tools()[tool];
    std::vector<double> sums(3);
    for (const auto &contact : contacts_)
      if (contact.tool() == tool && scene_.pairs()[contact.pair()].has_friction()) {
        const RigidContact::Grip grip = contact.grip(
            which.control() == Tool::Control::moment ? RigidContact::ToolRate{{}, which.rotation_axis()}
                                                     : RigidContact::ToolRate{which.force_direction(), {}});
        sums[0] += grip.touching;
        sums[1] += grip.slipping;
        sums[2] += grip.power_of_pressure;
      }
    dealii::Utilities::MPI::sum(sums, discretization_.communicator(), sums);
    constexpr double nearly_all = 0.9, part_of_friction = 0.5;
    if (sums[0] > 0. && sums[1] >= nearly_all * sums[0] &&
        std::abs(sums[2]) <= part_of_friction * std::abs(which.load(time_)))
      slipping_tools_.push_back(tool);
  }
}

std::string QuasiStatic::describe_slipping_tools() const {
  std::ostringstream text;
  for (const std::size_t tool : slipping_tools_) {
    const Tool &which = scene_.tools()[tool];
    const bool turns = which.control() == Tool::Control::moment;
    text << "; at the end of the last step tool '" << which.name()
         << "' slips on nearly all that it touches: friction has reached its limit, and cannot bear a "
         << (turns ? "moment" : "force") << " of " << which.load(time_)
         << ". Try a smaller one, more pressure or friction, or move the tool by its "
         << (turns ? "'Rotation angle'" : "'Translation'");
  }
  return text.str();
}

std::string QuasiStatic::describe_residual() {
  const Epetra_Vector x = pack(trial_, offsets_);
  Epetra_Vector residual(x);
  if (!compute_residual(x, residual))
    return "";
  const MPI_Comm communicator = discretization_.communicator();
  // The largest nodal force that is out of balance, where, and of which body.
  std::array<double, 5> mine{};
  for (std::size_t body = 0; body < discretization_.n_bodies(); ++body)
    for (const auto &element : discretization_.elements(body))
      for (const unsigned int v : element.cell->vertex_indices()) {
        double square = 0.;
        std::array<double, 3> position{};
        for (unsigned int i = 0; i < 3; ++i) {
          const DofIndex dof = element.dofs[3 * v + i];
          position[i] = element.cell->vertex(v)[i] + trial_ghosted_(dof);
          const int place = residual.Map().LID(static_cast<int>(dof));
          square += place >= 0 ? residual[place] * residual[place] : 0.;
        }
        if (square > mine[0])
          mine = {square, position[0], position[1], position[2], static_cast<double>(body)};
      }
  std::array<double, 5> worst{};
  for (const auto &of_rank : dealii::Utilities::MPI::all_gather(communicator, mine))
    if (of_rank[0] > worst[0])
      worst = of_rank;
  if (!(worst[0] > 0.))
    return "";
  std::ostringstream text;
  text << "; the largest residual is in body '" << scene_.bodies()[static_cast<std::size_t>(worst[4])].name
       << "' at (" << worst[1] << ", " << worst[2] << ", " << worst[3] << ")";
  const dealii::Tensor<1, 3> position({worst[1], worst[2], worst[3]});
  for (const auto &contact : contacts_)
    if (!all_ranks(!contact.has_node_on_border(position))) {
      text << ", which lies on the edge of tool '" << scene_.tools()[contact.tool()].name()
           << "', where contact comes and goes with each correction: draw the tool larger or smaller by a "
              "part of a facet, or give its edge a fillet";
      break;
    }
  return text.str();
}

} // namespace billet
