// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/resumption.h"

#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"

#include <cmath>
#include <filesystem>
#include <sstream>
#include <utility>

namespace billet {

std::unique_ptr<Resumption> Resumption::open(const parameters::Scene &parameters,
                                             const MPI_Comm communicator) {
  if (!parameters.restart.is_wanted())
    return nullptr;
  const auto &[file, origin] = parameters.restart.file;
  return std::unique_ptr<Resumption>(new Resumption{CheckpointReader(communicator, file, origin), {}});
}

bool Resumption::is_from(const std::string &folder) const {
  const auto from = std::filesystem::path(reader.file_name()).parent_path();
  std::error_code error;
  return std::filesystem::equivalent(from.empty() ? "." : from, folder, error);
}

void Resumption::load(const Scene &scene, const Discretization &discretization,
                      const std::function<RestartReport()> &load) {
  std::vector<std::string> changed;
  reader.load("scene", [&] { changed = check_scene(reader, scene, discretization); });
  reader.load("solution", [&] { report = load(); });
  report.changed = std::move(changed);
  report.is_exact = report.is_exact && report.changed.empty();
  const parameters::Scene &parameters = scene.parameters();
  if (report.time < parameters.time_stepping.end_time)
    return;
  std::ostringstream message;
  constexpr double rounding = 1e-9;
  if (report.is_exact &&
      std::abs(report.time - parameters.time_stepping.end_time) <= rounding * std::abs(report.time)) {
    message << reader.file_name() << " is from the end of the scene, time " << report.time
            << ", so that nothing remains to be computed";
    throw AlreadyComplete{Diagnostic(diagnostic::already_complete, message.str())};
  }
  message << parameters.file_name << ": 'End time' is " << parameters.time_stepping.end_time
          << "; allowed is a time after that of the checkpoint, " << report.time;
  throw InputError(message.str());
}

Diagnostic Resumption::describe(const double force_tolerance) const {
  std::ostringstream text;
  text << "The run resumes from " << reader.file_name() << " at time " << report.time;
  for (const auto &part : report.gone)
    text << ", without " << part;
  for (const auto &parameter : report.changed)
    text << (&parameter == &report.changed.front() ? ". Parameters with other values: " : ", ") << parameter;
  if (report.kinetic_energy > 0.)
    text << ". The kinetic energy there, " << report.kinetic_energy << ", is discarded";
  if (report.imbalance > force_tolerance * report.force_scale)
    text << ". Unbalanced forces, " << 100. * report.imbalance / report.force_scale
         << " % of those in the scene, fade until time " << report.release_end;
  return Diagnostic(diagnostic::resumed, text.str());
}

} // namespace billet
