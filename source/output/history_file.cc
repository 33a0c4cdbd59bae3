// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/history_file.h"

#include "billet/errors.h"

#include <algorithm>
#include <iomanip>

namespace billet {

namespace {

/// A tool's name as part of a column's name.
std::string column_name(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](const char c) { return c == ',' || c == '"'; }, '_');
  return name;
}

} // namespace

HistoryFile::HistoryFile(const Scene &scene, const std::string &folder)
    : name_(folder + "/history.csv"), stream_(name_) {
  if (!stream_)
    throw InputError(scene.parameters().output.folder.origin + ": '" + name_ + "' cannot be written");
  const bool is_explicit = scene.parameters().is_explicit(), is_dynamic = scene.parameters().is_dynamic();
  stream_ << "step,time,step_length"
          << (is_explicit ? "" : ",iterations,residual,total_iterations,total_cuts,linear_iterations");
  for (const auto &tool : scene.tools())
    for (const char *quantity :
         {"force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z", "contact_area",
          "deepest_penetration", "travel_x", "travel_y", "travel_z", "turn"})
      stream_ << "," << column_name(tool.name()) << "." << quantity;
  for (const auto &pair : scene.body_pairs())
    for (const char *quantity : {"force_x", "force_y", "force_z", "contact_area", "deepest_penetration"})
      stream_ << "," << column_name(pair.name) << "." << quantity;
  stream_ << (is_dynamic ? ",kinetic_energy" : "")
          << ",elastic_energy,plastic_work,contact_energy,friction_dissipation"
          << (is_explicit  ? ",viscous_dissipation,hourglass_energy"
              : is_dynamic ? ",numerical_dissipation"
                           : "")
          << ",external_work,energy_drift"
          << (is_dynamic ? ",momentum_x,momentum_y,momentum_z,angular_momentum_x,angular_momentum_y,"
                           "angular_momentum_z"
                         : "")
          << "\n"
          << std::setprecision(15);
}

void HistoryFile::write(const StepReport &report, const SolutionState &state) {
  stream_ << report.step << "," << state.time << "," << report.length << ","
          << report.newton.iterations.size() << "," << report.newton.force << "," << report.total_iterations
          << "," << report.total_cuts << "," << report.newton.linear_iterations;
  write_loads(state);
  const EnergyLedger &energies = state.energies;
  const bool is_dynamic = state.velocities.size() > 0;
  if (is_dynamic)
    stream_ << "," << energies.kinetic;
  stream_ << "," << energies.elastic << "," << energies.plastic << "," << energies.contact << ","
          << energies.friction;
  if (is_dynamic)
    stream_ << "," << energies.numerical;
  stream_ << "," << energies.external << "," << energies.drift();
  if (is_dynamic)
    write_momenta(state);
  end_line();
}

void HistoryFile::write(const unsigned int step, const double length, const SolutionState &state) {
  stream_ << step << "," << state.time << "," << length;
  write_loads(state);
  const EnergyLedger &energies = state.energies;
  stream_ << "," << energies.kinetic << "," << energies.elastic << "," << energies.plastic << ","
          << energies.contact << "," << energies.friction << "," << energies.viscous << ","
          << energies.hourglass << "," << energies.external << "," << energies.drift();
  write_momenta(state);
  end_line();
}

void HistoryFile::write_momenta(const SolutionState &state) {
  for (unsigned int i = 0; i < 3; ++i)
    stream_ << "," << state.momentum[i];
  for (unsigned int i = 0; i < 3; ++i)
    stream_ << "," << state.angular_momentum[i];
}

void HistoryFile::write_loads(const SolutionState &state) {
  for (std::size_t i = 0; i < state.tool_loads.size(); ++i) {
    const ContactLoad &load = state.tool_loads[i];
    const Placement &placement = state.placements[i];
    for (unsigned int c = 0; c < 3; ++c)
      stream_ << "," << load.force[c];
    for (unsigned int c = 0; c < 3; ++c)
      stream_ << "," << load.moment[c];
    stream_ << "," << load.area << "," << load.deepest;
    for (unsigned int c = 0; c < 3; ++c)
      stream_ << "," << placement.translation[c];
    stream_ << "," << placement.rotation_angle;
  }
  for (const auto &load : state.body_pair_loads)
    stream_ << "," << load.force[0] << "," << load.force[1] << "," << load.force[2] << "," << load.area << ","
            << load.deepest;
}

void HistoryFile::end_line() {
  stream_ << std::endl;
  if (!stream_)
    throw SolutionFailure(name_ + " cannot be written: is the disk full?");
}

} // namespace billet
