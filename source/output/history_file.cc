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
  stream_ << "step,time,step_length,iterations,residual,total_iterations,total_cuts";
  for (const auto &tool : scene.tools())
    for (const char *quantity :
         {"force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z", "contact_area",
          "deepest_penetration", "travel_x", "travel_y", "travel_z", "turn"})
      stream_ << "," << column_name(tool.name()) << "." << quantity;
  stream_ << ",elastic_energy,plastic_work,contact_energy,friction_dissipation,external_work,energy_drift\n";
  stream_ << std::setprecision(15);
}

void HistoryFile::write(const StepReport &report, const SolutionState &state) {
  stream_ << report.step << "," << state.time << "," << report.length << ","
          << report.newton.iterations.size() << "," << report.newton.force << "," << report.total_iterations
          << "," << report.total_cuts;
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
  const EnergyLedger &energies = state.energies;
  stream_ << "," << energies.elastic << "," << energies.plastic << "," << energies.contact << ","
          << energies.friction << "," << energies.external << "," << energies.drift() << std::endl;
  if (!stream_)
    throw SolutionFailure(name_ + " cannot be written: is the disk full?");
}

} // namespace billet
