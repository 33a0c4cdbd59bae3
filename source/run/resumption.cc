// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/resumption.h"

#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"
#include "billet/times.h"

#include <cmath>
#include <filesystem>
#include <numeric>
#include <sstream>
#include <utility>

namespace billet {

Resumption::Resumption(const MPI_Comm communicator, const std::string &file_name, const std::string &origin)
    : file_(communicator, file_name, origin) {}

Resumption::Resumption(const std::string &file_name, const MPI_Comm communicator, MeshChange change)
    : file_(communicator, file_name, "state for the refined mesh"), change_(std::move(change)) {}

std::unique_ptr<Resumption> Resumption::open(const parameters::Scene &parameters,
                                             const MPI_Comm communicator) {
  if (!parameters.restart.is_wanted())
    return nullptr;
  const auto &[file, origin] = parameters.restart.file;
  return std::unique_ptr<Resumption>(new Resumption(communicator, file, origin));
}

MeshLevels Resumption::find_levels(const Scene &scene) {
  if (change_)
    return change_->levels;
  double time = 0.;
  in("solution", [&] { time = file_.number("time"); });
  MeshLevels levels;
  in("scene", [&] { levels = load_levels(file_, scene, time); });
  return levels;
}

bool Resumption::is_from(const std::string &folder) const {
  const auto from = std::filesystem::path(file_.file_name()).parent_path();
  std::error_code error;
  return std::filesystem::equivalent(from.empty() ? "." : from, folder, error);
}

void Resumption::in(const std::string &group, const std::function<void()> &load) { file_.load(group, load); }

void Resumption::load(const Scene &scene, const Discretization &discretization,
                      const std::function<RestartReport()> &load) {
  std::vector<std::string> changed;
  if (change_) {
    in("", [&] { refined_ = std::make_unique<RefinedReader>(file_, discretization, change_->is_refined); });
  } else
    in("scene", [&] { changed = check_scene(file_, scene, discretization); });
  in("solution", [&] { report_ = load(); });
  report_.changed = std::move(changed);
  report_.is_exact = report_.is_exact && report_.changed.empty();
  check_end(scene.parameters());
}

void Resumption::check_end(const parameters::Scene &parameters) const {
  if (report_.time < parameters.time_stepping.end_time)
    return;
  std::ostringstream message;
  if (report_.is_exact && !times::is_after(report_.time, parameters.time_stepping.end_time)) {
    message << file_.file_name() << " is from the end of the scene, time " << report_.time
            << ", so that nothing remains to be computed";
    throw AlreadyComplete{Diagnostic(diagnostic::already_complete, message.str())};
  }
  message << parameters.file_name << ": 'End time' is " << parameters.time_stepping.end_time
          << "; allowed is a time after that of the checkpoint, " << report_.time;
  throw InputError(message.str());
}

void MeshChange::check(const std::string &scene_name, const double energy_change,
                       const EnergyLedger &after) const {
  const double all = before.total(), gained = after.contact - before.contact;
  const auto refuse = [&](const std::string &what, const std::string &measure, const double energy,
                          const std::string &advice) {
    throw SolutionFailure(
        Diagnostic(diagnostic::solution_failed, scene_name + ": finer elements of " + text + " " + what)
            .time(time)
            .measure(measure + " / energy", all > 0. ? energy / all : 0.)
            .advice("Use 'Refinement times' " + advice + ", or finer elements from the start"));
  };
  std::ostringstream what;
  if (gained > max_gain * all) {
    what << "penetrate what they touch. Contact springs would gain an energy of " << gained << "; allowed is "
         << max_gain * all << ", " << 100. * max_gain
         << " % of all energy. New nodes lie on the chords of faces, inside a curved surface";
    refuse(what.str(), "gained", gained, "before the bodies touch curved surfaces, 'Passes = two'");
  }
  if (std::abs(energy_change) > max_change * all) {
    what << "resist strains that the coarse ones let pass. The energy would change by " << energy_change
         << "; allowed is " << max_change * all << ", all energy that there is";
    refuse(what.str(), "change", std::abs(energy_change), "of less deformation");
  }
}

Diagnostic MeshChange::describe(const RestartReport &report, const double force_tolerance) const {
  std::ostringstream what;
  what << "Each element is divided into eight: " << text;
  if (report.imbalance > force_tolerance * report.force_scale)
    what << ". Unbalanced forces, " << 100. * report.imbalance / report.force_scale
         << " % of those in the scene, fade until time " << report.release_end;
  what << ". The energy changes by " << report.energy_change;
  Diagnostic message(diagnostic::mesh_refined, what.str());
  // Each refinement is a message of its own.
  message.topic(std::to_string(1 + std::accumulate(levels.begin(), levels.end(), 0U)));
  message.time(time).value("energy change", report.energy_change);
  if (report.force_scale > 0.)
    message.value("imbalance", report.imbalance / report.force_scale);
  return message;
}

Diagnostic Resumption::describe(const double force_tolerance) const {
  if (change_)
    return change_->describe(report_, force_tolerance);
  std::ostringstream text;
  text << "The run resumes from " << file_.file_name() << " at time " << report_.time;
  for (const auto &part : report_.gone)
    text << ", without " << part;
  for (const auto &parameter : report_.changed)
    text << (&parameter == &report_.changed.front() ? ". Parameters with other values: " : ", ") << parameter;
  if (report_.kinetic_energy > 0.)
    text << ". The kinetic energy there, " << report_.kinetic_energy << ", is discarded";
  if (report_.imbalance > force_tolerance * report_.force_scale)
    text << ". Unbalanced forces, " << 100. * report_.imbalance / report_.force_scale
         << " % of those in the scene, fade until time " << report_.release_end;
  return Diagnostic(diagnostic::resumed, text.str());
}

} // namespace billet
