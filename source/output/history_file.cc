// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/history_file.h"

#include "billet/errors.h"
#include "billet/solve/mesh_errors.h"

#include <filesystem>
#include <iomanip>
#include <sstream>

namespace billet {

namespace {

std::vector<HistoryQuantity> quantities_of(const Scene &scene) {
  std::vector<HistoryQuantity> quantities;
  for (const HistoryQuantity &quantity : history_quantities())
    if (!quantity.columns(scene).empty())
      quantities.push_back(quantity);
  return quantities;
}

/// Returns the first line of the file.
std::string columns_of(const Scene &scene, const std::vector<HistoryQuantity> &quantities) {
  std::string columns;
  for (const HistoryQuantity &quantity : quantities)
    for (const std::string &column : quantity.columns(scene))
      columns += (columns.empty() ? "" : ",") + column;
  return columns;
}

double mesh_error_of(const Solution &solution) {
  return solution.mesh_errors() != nullptr ? solution.mesh_errors()->error() : 0.;
}

double geometry_error_of(const Solution &solution) {
  return solution.mesh_errors() != nullptr ? solution.mesh_errors()->geometry_error() : 0.;
}

} // namespace

HistoryFile::HistoryFile(const Scene &scene, const std::string &folder)
    : name_(folder + "/history.csv"), quantities_(quantities_of(scene)),
      columns_(columns_of(scene, quantities_)), whole_(scene.whole_section()) {
  begin(scene);
}

HistoryFile::HistoryFile(const Scene &scene, const std::string &folder, const Mark &mark, const double time)
    : name_(folder + "/history.csv"), quantities_(quantities_of(scene)),
      columns_(columns_of(scene, quantities_)), whole_(scene.whole_section()) {
  namespace fs = std::filesystem;
  std::error_code error;
  std::string first_line;
  std::ifstream in(name_);
  std::getline(in, first_line);
  in.close();
  if (mark.columns == columns_ && first_line == columns_ && fs::file_size(name_, error) >= mark.n_bytes &&
      !error) {
    fs::resize_file(name_, mark.n_bytes, error);
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

HistoryFile::Mark HistoryFile::mark() { return {columns_, static_cast<std::uintmax_t>(stream_.tellp())}; }

void HistoryFile::write(const StepReport &report, const Solution &solution,
                        const std::vector<double> &probes) {
  write({solution.state(), report.step, report.length, &report, solution.reactions(), probes, whole_,
         mesh_error_of(solution), geometry_error_of(solution)});
}

void HistoryFile::write(const unsigned int step, const double length, const Solution &solution,
                        const std::vector<double> &probes) {
  write({solution.state(), step, length, nullptr, solution.reactions(), probes, whole_,
         mesh_error_of(solution), geometry_error_of(solution)});
}

void HistoryFile::write(const HistorySample &sample) {
  const char *separator = "";
  for (const HistoryQuantity &quantity : quantities_)
    for (const double value : quantity.evaluate(sample)) {
      stream_ << separator << value;
      separator = ",";
    }
  stream_ << std::endl;
  if (!stream_)
    throw file_lost(name_);
}

} // namespace billet
