// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/history_file.h"

#include "billet/errors.h"

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <sstream>

namespace billet {

namespace {

/// A tool's name as part of a column's name.
std::string column_name(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](const char c) { return c == ',' || c == '"'; }, '_');
  return name;
}

/// Whether viscous forces hold bodies of a static scene until contact does.
bool has_stabilised_bodies(const Scene &scene) {
  const auto &bodies = scene.parameters().bodies;
  return std::any_of(bodies.begin(), bodies.end(),
                     [](const parameters::Body &body) { return body.is_stabilised.value; });
}

} // namespace

HistoryFile::HistoryFile(const Scene &scene, const std::string &folder)
    : name_(folder + "/history.csv"), columns_(columns(scene)),
      has_stabilisation_(scene.capabilities().stabilisation),
      has_viscous_forces_(has_stabilised_bodies(scene)) {
  begin(scene);
}

HistoryFile::HistoryFile(const Scene &scene, const std::string &folder, const Mark &mark, const double time)
    : name_(folder + "/history.csv"), columns_(columns(scene)),
      has_stabilisation_(scene.capabilities().stabilisation),
      has_viscous_forces_(has_stabilised_bodies(scene)) {
  namespace fs = std::filesystem;
  std::error_code error;
  std::string first_line;
  std::ifstream in(name_);
  std::getline(in, first_line);
  in.close();
  const auto n_bytes = static_cast<std::uintmax_t>(mark.n_bytes);
  if (mark.columns == columns_ && first_line == columns_ && fs::file_size(name_, error) >= n_bytes &&
      !error) {
    fs::resize_file(name_, n_bytes, error);
    stream_.open(name_, std::ios::app | std::ios::ate);
    if (error || !stream_)
      throw InputError(scene.parameters().output.folder.origin + ": '" + name_ + "' cannot be written");
    stream_ << std::setprecision(15);
    return;
  }
  if (fs::exists(name_, error)) {
    std::ostringstream kept;
    kept << folder << "/history_until_" << time << ".csv";
    fs::rename(name_, kept.str(), error);
    if (error)
      throw InputError(scene.parameters().output.folder.origin + ": '" + name_ + "' cannot be renamed to '" +
                       kept.str() + "'");
  }
  begin(scene);
}

void HistoryFile::begin(const Scene &scene) {
  stream_.open(name_);
  if (!stream_)
    throw InputError(scene.parameters().output.folder.origin + ": '" + name_ + "' cannot be written");
  stream_ << columns_ << "\n" << std::setprecision(15) << std::flush;
}

HistoryFile::Mark HistoryFile::mark() { return {columns_, static_cast<double>(stream_.tellp())}; }

std::string HistoryFile::columns(const Scene &scene) {
  std::ostringstream stream;
  const bool is_explicit = scene.parameters().is_explicit(), is_dynamic = scene.parameters().is_dynamic();
  stream << "step,time,step_length"
         << (is_explicit ? "" : ",iterations,residual,total_iterations,total_cuts,linear_iterations");
  for (const auto &tool : scene.tools())
    for (const char *quantity :
         {"force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z", "contact_area",
          "deepest_penetration", "travel_x", "travel_y", "travel_z", "turn"})
      stream << "," << column_name(tool.name()) << "." << quantity;
  for (const auto &pair : scene.body_pairs())
    for (const char *quantity : {"force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z",
                                 "contact_area", "deepest_penetration"})
      stream << "," << column_name(pair.name) << "." << quantity;
  stream << (is_dynamic ? ",kinetic_energy" : "")
         << ",elastic_energy,plastic_work,contact_energy,friction_dissipation"
         << (is_explicit  ? ",viscous_dissipation,hourglass_energy"
             : is_dynamic ? ",numerical_dissipation"
                          : "")
         << (!is_explicit && scene.capabilities().stabilisation ? ",hourglass_energy" : "")
         << (has_stabilised_bodies(scene) ? ",viscous_dissipation" : "") << ",external_work,energy_drift"
         << (is_dynamic ? ",momentum_x,momentum_y,momentum_z,angular_momentum_x,angular_momentum_y,"
                          "angular_momentum_z"
                        : "");
  return stream.str();
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
  if (has_stabilisation_)
    stream_ << "," << energies.hourglass;
  if (has_viscous_forces_)
    stream_ << "," << energies.viscous;
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
  for (const auto &load : state.body_pair_loads) {
    for (unsigned int c = 0; c < 3; ++c)
      stream_ << "," << load.force[c];
    for (unsigned int c = 0; c < 3; ++c)
      stream_ << "," << load.moment[c];
    stream_ << "," << load.area << "," << load.deepest;
  }
}

void HistoryFile::end_line() {
  stream_ << std::endl;
  if (!stream_)
    throw SolutionFailure(name_ + " cannot be written: is the disk full?");
}

} // namespace billet
