// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/target_mesh.h"

#include "billet/diagnostic_kinds.h"
#include "billet/fail_together.h"
#include "billet/output/console_log.h"
#include "billet/output/error_report.h"
#include "billet/output/history_comparison.h"
#include "billet/run/body_levels.h"
#include "billet/run/mesh_levels.h"
#include "billet/run/mesh_sizes.h"
#include "billet/run/output_folder.h"
#include "billet/run/run.h"
#include "billet/run/stopwatch.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <regex>
#include <sstream>

#include <sys/resource.h>
#include <unistd.h>

namespace billet {

namespace {

namespace fs = std::filesystem;

/// Run on one level of the meshes.
struct Level {
  int level = 0;           ///< of the bodies that rose
  std::vector<int> bodies; ///< level of each
  double seconds = 0.;     ///< of all processors
  double difference = 0.;  ///< from the level before; 0: there is none
  std::string of_what{};   ///< results that differ most
  MeshLevelError error{};  ///< of this level, if there is one before it
};

struct Memory {
  double held; ///< the largest that all processes have held [bytes]
  double part; ///< over that of their machine
};

Memory measure_memory(const MPI_Comm communicator) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const double held = 1024. * static_cast<double>(usage.ru_maxrss);
  const double all =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  const double of_all_ranks = dealii::Utilities::MPI::sum(held, communicator);
  return {of_all_ranks, of_all_ranks / all};
}

std::string percent(const double part) {
  std::ostringstream text;
  text.precision(2);
  text << 100. * part << " %";
  return text.str();
}

/// Returns the results in a folder, without the copy of the scene if that is 'scene.prm'.
std::vector<fs::path> results_in(const fs::path &folder) {
  std::vector<fs::path> results;
  for (const fs::directory_entry &entry : fs::directory_iterator(folder))
    if (is_name_of_result(entry.path().filename().string()))
      results.push_back(entry.path());
  return results;
}

/// Climbs from level to level.
class MeshLadder {
public:
  MeshLadder(const parameters::Scene &given, const MPI_Comm communicator, const RunOptions &options)
      : given_(given), communicator_(communicator), options_(options),
        is_first_(dealii::Utilities::MPI::this_mpi_process(communicator) == 0),
        folder_(given.output.folder.value),
        bodies_(given.bodies.size(), -static_cast<int>(count_coarser_levels(given, coarsest)),
                given.mesh_target.error) {}

  ExitCode climb() {
    check_given();
    begin();
    for (;;) {
      const ExitCode code = run();
      if (code == ExitCode::stopped)
        return code;
      if (is_last_) {
        finish();
        return code;
      }
    }
  }

private:
  /// Levels below the given one: three of them show an order.
  static constexpr unsigned int coarsest = 3;

  std::string folder_of(const int level) const { return folder_ + "/mesh_level_" + std::to_string(level); }

  /// Refuses the given scene before there is a folder.
  void check_given() const {
    const std::unique_ptr<const Scene> scene = build_scene(given_, communicator_);
    fail_together(communicator_, [&] {
      dealii::Triangulation<3> mesh;
      if (is_first_)
        scene->build_mesh(MeshDetail::full, mesh);
    });
  }

  void begin() {
    fail_together(communicator_, [&] {
      if (given_.restart.is_wanted())
        throw InputError(given_.restart.file.origin +
                         ": a run with 'Target error of = everything' cannot be "
                         "resumed; allowed is 'Target error of = mesh given', with the "
                         "mesh of the checkpoint");
    });
    const EarlierResults earlier =
        options_.replaces_results ? EarlierResults::replaced : EarlierResults::moved_aside;
    fail_together(communicator_, [&] { check_output_folder(given_, earlier); });
    fail_together(communicator_, [&] {
      if (!is_first_)
        return;
      const bool are_replaced = options_.replaces_results && has_results(folder_);
      prepare_output_folder(given_, earlier);
      clear_levels(are_replaced);
      if (options_.log != nullptr)
        options_.log->open(folder_ + "/" + log_file, false);
    });
  }

  /// Removes the results of levels of an earlier run. Throws InputError if they are not to be
  /// replaced: then another program has left them.
  void clear_levels(const bool are_replaced) const {
    const std::regex level("mesh_level_-?[0-9]+");
    std::vector<fs::path> folders;
    for (const fs::directory_entry &entry : fs::directory_iterator(folder_))
      if (std::regex_match(entry.path().filename().string(), level) && has_results(entry.path().string()))
        folders.push_back(entry.path());
    for (const fs::path &folder : folders) {
      if (!are_replaced)
        throw InputError(given_.output.folder.origin + " is '" + folder_ + "', where '" +
                         folder.filename().string() +
                         "' has results of another run; allowed is a folder without them");
      fs::remove(left_copy(folder.string()));
      for (const fs::path &file : results_in(folder))
        fs::remove(file);
      std::error_code error;
      fs::remove(folder, error); // unless it has files of the user
    }
  }

  /// Runs on the next levels. Returns the exit code, also of a coarse level that fails.
  ExitCode run() {
    if (!levels_.empty())
      bodies_.rise();
    const int level = bodies_.level();
    parameters::Scene scene = at_mesh_levels(given_, bodies_.levels());
    raise_penalties(scene);
    scene.output.folder.value = folder_of(level);
    RunOptions options = options_;
    options.log = nullptr;
    options.replaces_results = true;
    if (options_.is_quiet && options_.log != nullptr)
      options.steps = &options_.log->file();
    if (is_first_ && !options_.is_quiet)
      std::cout << "Mesh level " << level
                << (level == 0  ? ", the meshes as given"
                    : level < 0 ? ", coarser than given"
                                : ", finer than given")
                << bodies_behind(level, bodies_.levels()) << std::endl;
    const double start = processor_time();
    options.judge = [&](const std::vector<BodyMesh> &bodies, const ErrorReport &others) {
      return judge(bodies, others, processor_time() - start);
    };
    try {
      return run_simulation(scene, communicator_, options);
    } catch (const SolutionFailure &failure) { // on all ranks
      if (level >= 0)
        throw;
      leave_out(failure.diagnostic());
    } catch (const InputError &error) {
      // This occurs on all ranks: coarse faces may miss what boundary ids select.
      if (level >= 0)
        throw;
      leave_out(error.diagnostic());
    }
    return ExitCode::failed_solution;
  }

  /// Raises the penalties that the target has chosen before any error was known: in explicit scenes
  /// they stay as they are during a run.
  void raise_penalties(parameters::Scene &scene) const {
    for (parameters::ContactPair &pair : scene.pairs)
      if (std::any_of(scene.presets.begin(), scene.presets.end(), [&](const parameters::Preset &preset) {
            return preset.key == "Normal penalty" && preset.path.back() == pair.name;
          })) {
        pair.penalty.normal *= penalty_raise_;
        pair.penalty.tangential *= pair.penalty.is_tangential_given ? 1. : penalty_raise_;
      }
  }

  /// Learns from the errors of a run by how much the next one must raise penalties.
  void learn_penalties(const ErrorReport &others) {
    const auto found = std::find_if(others.sources.begin(), others.sources.end(),
                                    [](const auto &source) { return source.name == "penetrations"; });
    if (found == others.sources.end() || !found->is_known)
      return;
    constexpr double part = 0.3, most = 8.; // of the target; raise from level to level
    penalty_raise_ *= std::clamp(found->error / (part * others.target), 1., most);
  }

  /// Begins again with the next finer level.
  void leave_out(const Diagnostic &why) {
    levels_.clear();
    messages_.push_back(
        Diagnostic(diagnostic::mesh_level_failed,
                   "Mesh level " + std::to_string(bodies_.level()) + " is left out: " + why.what()));
    bodies_.restart();
  }

  /// Adds a level whose run has reached its end, in `seconds` of this rank, and decides whether it
  /// is the last one. Then it returns the messages for the user. What its `others` errors leave of
  /// their target is for the mesh.
  Verdict judge(const std::vector<BodyMesh> &bodies, const ErrorReport &others, const double seconds) {
    const double spare = others.knows_all() ? std::max(0., others.target - others.total()) : 0.;
    bodies_.allow(given_.mesh_target.error + spare);
    learn_penalties(others);
    Level level{bodies_.level(), bodies_.levels()};
    level.seconds = dealii::Utilities::MPI::sum(seconds, communicator_);
    if (!levels_.empty()) {
      double reach = 0.;
      for (const BodyMesh &body : bodies)
        reach = std::max(reach, body.reach);
      compare(level, reach);
    }
    bodies_.add(level.difference, bodies);
    level.error = bodies_.error();
    levels_.push_back(level);
    const bool is_met = bodies_.is_met() && shows_given_bodies();
    const int finest = static_cast<int>(given_.mesh_target.finest_level);
    constexpr double fill = 9. / 8.; // factors of matrices grow by more than elements
    const Memory memory = measure_memory(communicator_);
    const std::string limit = is_met                  ? ""
                              : level.level >= finest ? "'Finest mesh level' is " + std::to_string(finest)
                              : level.level >= 0 && fill * bodies_.growth() * memory.part > 1.
                                  ? "the next level does not fit in memory"
                                  : "";
    is_last_ = is_met || !limit.empty();
    if (!is_last_)
      return {};
    messages_.push_back(describe(others));
    if (!limit.empty())
      messages_.push_back(describe_miss(limit, memory.held));
    append(messages_, others.missed(is_met ? bodies_.error().error : 0.));
    return {messages_, folder_};
  }

  /// Whether the meshes of the last level have the bodies of the given ones, as far as sizes tell.
  bool shows_given_bodies() const {
    const Level &last = levels_.back();
    if (last.level >= 0)
      return true;
    const std::vector<int> before = levels_[levels_.size() - 2].bodies;
    const parameters::Scene of_before = at_mesh_levels(given_, before),
                            of_last = at_mesh_levels(given_, last.bodies);
    for (std::size_t b = 0; b < given_.bodies.size(); ++b)
      if (!approach(MeshSizes::of(of_before.bodies[b]), MeshSizes::of(of_last.bodies[b]),
                    MeshSizes::of(given_.bodies[b])))
        return false;
    return true;
  }

  /// Computes the difference from the level before. All ranks read the files: they are the same.
  /// `reach`: the largest distance of bodies from the origin [length].
  void compare(Level &level, const double reach) {
    fail_together(communicator_, [&] {
      const HistoryTable coarse = HistoryTable::read(folder_of(level.level - 1) + "/history.csv"),
                         fine = HistoryTable::read(folder_of(level.level) + "/history.csv");
      const HistoryDifference difference =
          compare_histories(coarse, fine, given_.scheme().has_inertia, reach);
      level.difference = difference.part;
      level.of_what = difference.of_what.empty() ? "results" : difference.of_what;
    });
  }

  /// Moves the results of the last level into the output folder.
  void finish() {
    fail_together(communicator_, [&] {
      if (!is_first_)
        return;
      const fs::path last = folder_of(levels_.back().level);
      fs::rename(left_copy(last.string()), scene_copy(given_));
      for (const fs::path &file : results_in(last))
        fs::rename(file, fs::path(folder_) / file.filename());
      std::error_code error;
      fs::remove(last, error); // unless it has files of the user
      write_table();
    });
  }

  void write_table() const {
    std::ofstream file(folder_ + "/mesh_levels.csv");
    file.precision(6);
    file << "level,processor_seconds,difference,order,error";
    for (const parameters::Body &body : given_.bodies)
      file << "," << body.name << ".level";
    file << "\n";
    for (const Level &level : levels_) {
      file << level.level << "," << level.seconds;
      if (level.difference > 0.)
        file << "," << level.difference << "," << level.error.order << "," << level.error.error;
      else
        file << ",,,";
      for (const int of_body : level.bodies)
        file << "," << of_body;
      file << "\n";
    }
    if (!file.flush())
      throw file_lost("'" + folder_ + "/mesh_levels.csv'");
  }

  /// Returns text about the bodies that have stayed behind a level.
  std::string bodies_behind(const int level, const std::vector<int> &levels) const {
    std::string text;
    for (std::size_t b = 0; b < levels.size(); ++b)
      if (levels[b] < level)
        text += ", '" + given_.bodies[b].name + "' at " + std::to_string(levels[b]);
    return text;
  }

  Diagnostic describe(const ErrorReport &others) const {
    std::ostringstream text;
    text.precision(3);
    text << "Levels of the meshes, 0 as given:";
    for (const Level &level : levels_) {
      text << (&level == levels_.data() ? " " : "; ") << "level " << level.level
           << bodies_behind(level.level, level.bodies) << ", " << level.seconds << " s of processor";
      if (&level != levels_.data())
        text << ", " << level.of_what << " differ by " << percent(level.difference)
             << " from the level before";
    }
    if (levels_.size() < 2) {
      text << ". Their error is unknown: there is one level only";
    } else {
      const MeshLevelError &error = levels_.back().error;
      text << ". The error of the mesh of level " << levels_.back().level << " is about "
           << percent(error.error);
      if (!error.is_known)
        text << " or more: the differences do not fall, or a level has a single element across what bends";
      else if (levels_.size() > 2)
        text << ", of order " << error.order;
      if (others.knows_all())
        text << ". With " << percent(others.total()) << " of steps, penetrations and iterations it is "
             << percent(error.error + others.total()) << ", of a target of "
             << percent(others.target + others.mesh_target);
    }
    Diagnostic message(diagnostic::mesh_levels, text.str());
    if (levels_.size() > 1)
      message.value("error", levels_.back().error.error);
    return message;
  }

  /// `memory`: that of the last level [bytes].
  Diagnostic describe_miss(const std::string &limit, const double memory) const {
    std::ostringstream text;
    text.precision(2);
    text << "The error of the mesh is not shown to be within what others leave of the target, "
         << percent(bodies_.allowed()) << ", and " << limit;
    if (levels_.size() > 1 && levels_.back().error.is_known) {
      const Level &last = levels_.back();
      const unsigned int more = bodies_.rises_to_target();
      // Seconds grow at least as elements do; short runs are mostly start-up, and factors of
      // matrices fill in.
      constexpr double most_growth = 20., shortest = 1e-3; // s
      const double of_elements = bodies_.growth(),
                   of_seconds =
                       std::clamp(last.seconds / std::max(shortest, levels_[levels_.size() - 2].seconds),
                                  of_elements, std::max(of_elements, most_growth));
      constexpr double gigabyte = 1e9, idle = 0.15e9; // bytes; the program without a mesh
      text << ". At this order it would take level " << last.level + static_cast<int>(more) << ": "
           << bodies_.growth(more) << " times the elements of level " << last.level << ", about "
           << last.seconds * std::pow(of_seconds, more) << " s of processor and "
           << (idle + std::max(0., memory - idle) * bodies_.growth(more)) / gigabyte << " GB of memory";
    }
    return Diagnostic(diagnostic::mesh_target_missed, text.str());
  }

  const parameters::Scene &given_;
  MPI_Comm communicator_;
  const RunOptions &options_;
  bool is_first_;
  std::string folder_;
  BodyLevels bodies_;
  std::vector<Level> levels_;
  DiagnosticList messages_;   ///< for the run on the last level
  bool is_last_ = false;      ///< whether the latest level is
  double penalty_raise_ = 1.; ///< factor of penalties that the target chooses, for the next level
};

} // namespace

ExitCode run_to_target(const parameters::Scene &parameters, const MPI_Comm communicator,
                       const RunOptions &options) {
  return parameters.mesh_target.is_wanted() ? MeshLadder(parameters, communicator, options).climb()
                                            : run_simulation(parameters, communicator, options);
}

} // namespace billet
