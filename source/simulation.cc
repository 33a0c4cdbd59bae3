// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/simulation.h"

#include "billet/contact/faceted_curvature.h"
#include "billet/diagnostic_kinds.h"
#include "billet/discretization/inverted_corners.h"
#include "billet/errors.h"
#include "billet/output/capabilities_file.h"
#include "billet/output/checkpoint.h"
#include "billet/output/element_means.h"
#include "billet/output/energy_watch.h"
#include "billet/output/error_report.h"
#include "billet/output/field_writer.h"
#include "billet/output/history_file.h"
#include "billet/output/progress.h"
#include "billet/scene/plausibility.h"
#include "billet/solve/energy_errors.h"
#include "billet/solve/error_watch.h"
#include "billet/solve/explicit_dynamics.h"
#include "billet/solve/quasi_static.h"
#include "billet/solve/run_review.h"
#include "billet/solve/stability_watch.h"
#include "billet/solve/step_control.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <sstream>

namespace billet {

namespace {

/// Makes the folder and puts a copy of the scene as it was read into it. First rank only.
void prepare_folder(const parameters::Scene &parameters) {
  const std::filesystem::path folder = parameters.output.folder.value;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  std::ofstream copy(folder / "scene.prm");
  copy << parameters.text;
  if (error || !copy.flush())
    throw InputError(parameters.output.folder.origin + ": nothing can be written to '" + folder.string() +
                     "'");
}

/// Whether somebody may be watching. Open MPI's mpirun hands its ranks a terminal of its own, whatever its
/// output goes to.
bool console_is_terminal() {
  if (isatty(STDOUT_FILENO) == 0)
    return false;
  if (std::getenv("OMPI_COMM_WORLD_SIZE") == nullptr)
    return true;
  std::error_code error;
  const auto target =
      std::filesystem::read_symlink("/proc/" + std::to_string(getppid()) + "/fd/1", error).string();
  return target.rfind("/dev/pts/", 0) == 0 || target.rfind("/dev/tty", 0) == 0;
}

/// Writes fields at the start, as often as the scene asks for, and at the end.
class Snapshots {
public:
  Snapshots(const parameters::Scene &parameters, FieldWriter &writer)
      : output_(parameters.output), end_(parameters.time_stepping.end_time), writer_(writer) {}

  bool is_due(const unsigned int step, const double time) const {
    if (output_.interval > 0. && time >= (n_intervals_ + 1) * output_.interval * (1. - 1e-8))
      return true;
    return (output_.interval == 0. && output_.every_steps > 0 && step % output_.every_steps == 0) ||
           time >= end_;
  }
  void after_step(const unsigned int step, const Solution &solution) {
    const double time = solution.state().time;
    if (!is_due(step, time))
      return;
    if (output_.interval > 0.)
      n_intervals_ = static_cast<unsigned int>(time / output_.interval * (1. + 1e-8));
    write(solution);
  }
  void save(StateWriter &writer) const {
    writer.write("pictures", {static_cast<double>(n_intervals_), last_});
  }
  void load(const StateReader &reader) {
    const std::vector<double> state = reader.read("pictures");
    last_ = state.at(1);
    if (output_.interval > 0.)
      n_intervals_ = static_cast<unsigned int>(last_ / output_.interval * (1. + 1e-8));
  }
  void write(const Solution &solution) {
    if (solution.state().time == last_)
      return;
    writer_.write(solution);
    last_ = solution.state().time;
  }

private:
  const parameters::Output &output_;
  double end_;
  FieldWriter &writer_;
  unsigned int n_intervals_ = 0;
  double last_ = -1.;
};

/// Whether its yield stress does not grow without end.
bool has_limit(const parameters::Material &material) {
  if (material.law == parameters::Material::Law::elastic)
    return false;
  switch (material.hardening) {
  case parameters::Material::Hardening::table:
    return true;
  case parameters::Material::Hardening::power_law:
    return material.exponent == 0.;
  default:
    return material.hardening_modulus == 0.;
  }
}

/// Where physics may be what ends a run: forces that a body cannot bear.
std::string describe_limit_load(const parameters::Scene &parameters) {
  using Control = parameters::Motion::Control;
  const auto is_given = [](const parameters::Tool &tool) {
    return tool.motion.control == Control::force || tool.motion.control == Control::moment;
  };
  const auto tool = std::find_if(parameters.tools.begin(), parameters.tools.end(), is_given);
  const auto body = std::find_if(parameters.bodies.begin(), parameters.bodies.end(),
                                 [](const parameters::Body &b) { return has_limit(b.material); });
  const bool has_tool = tool != parameters.tools.end();
  const bool has_loads = std::any_of(parameters.bodies.begin(), parameters.bodies.end(),
                                     [](const parameters::Body &b) { return !b.loads.empty(); });
  if (body == parameters.bodies.end() || !(has_tool || has_loads))
    return "";
  const bool turns = has_tool && tool->motion.control == Control::moment;
  return "Body '" + body->name + "' yields without hardening, and " +
         (has_tool ? "tool '" + tool->name +
                         (turns ? "' turns it with a given moment" : "' presses with a given force")
                   : "loads are given") +
         (parameters.is_dynamic() ? ": above the limit load it flows on and on"
                                  : ": above the limit load nothing is in balance") +
         ". If that is what ends the run, " +
         (!has_tool
              ? std::string()
              : std::string("move the tool by its '") + (turns ? "Rotation" : "Translation") + "', or ") +
         "let the material harden. ";
}

/// Whether a body that yields, of another law than Hencky's, has elastic strains of the order of what
/// energies may be off. Collective.
bool has_inexact_dissipation(const Scene &scene, const Discretization &discretization,
                             const Solution &solution) {
  constexpr double large = 0.02;
  double largest = 0.;
  for (std::size_t b = 0; b < scene.bodies().size(); ++b) {
    const Body &body = scene.bodies()[b];
    if (std::holds_alternative<std::monostate>(body.material.hardening) ||
        scene.parameters().bodies[b].material.kinematics.value == parameters::Material::Kinematics::hencky)
      continue;
    for (const ElementSummary &summary : solution.summarize(b))
      if (summary.equivalent_plastic_strain > 0.)
        largest = std::max(largest, dealii::deviator(summary.cauchy_stress).norm() /
                                        (2. * body.material.elastic.shear));
  }
  return dealii::Utilities::MPI::max(largest, discretization.communicator()) > large;
}

/// Shear and bulk modulus as far apart as here leave Newton's method few digits.
std::string describe_incompressibility(const parameters::Scene &parameters) {
  const double nearly = 0.49995;
  const auto body = std::find_if(parameters.bodies.begin(), parameters.bodies.end(),
                                 [&](const auto &b) { return b.material.poisson_ratio > nearly; });
  if (body == parameters.bodies.end())
    return "";
  std::ostringstream text;
  text << ". Body '" << body->name
       << "' is all but incompressible ('Poisson ratio' = " << body->material.poisson_ratio
       << "): 0.4999 differs from that by a ten-thousandth of the bulk modulus, and is easier to solve";
  return text.str();
}

std::string explain_failure(const parameters::Scene &parameters, const StepReport &report, const double from,
                            const double to, const bool is_unstable) {
  std::ostringstream message;
  message << parameters.file_name << ": the step from time " << from << " to " << to << " failed after "
          << report.step << " accepted steps and " << report.total_cuts << " cuts: " << report.newton.failure;
  std::ostringstream computed;
  computed << ". What was computed until time " << from << " is in '" << parameters.output.folder.value
           << "'.";
  if (report.newton.is_lost_in_round_off || report.newton.is_explained)
    return message.str() + computed.str();
  message << (report.newton.criteria.empty() ? "" : "; ") << report.newton.criteria << ". "
          << describe_limit_load(parameters);
  const bool goes_round = report.newton.goes_round && !parameters.pairs.empty();
  if (goes_round)
    message << "Nodes that touch and let go by turns, or stick and slip, do that: where a body snaps, or "
               "friction "
               "is strong. Try a penalty that is a half or twice as stiff, normal or tangential, or a "
               "'Penetration "
               "tolerance'. ";
  if (parameters.time_stepping.control == parameters::TimeStepping::Control::fixed)
    message << "Steps are fixed: try a smaller 'Initial step' or 'Step control = automatic'";
  else
    message << "The step cannot be cut below 'Smallest step' = " << parameters.time_stepping.smallest_step
            << (parameters.is_dynamic() ? ": where it is for accuracy, try a larger 'Error tolerance'; else"
                                        : ":")
            << (report.newton.goes_round   ? ""
                : parameters.pairs.empty() ? " try more 'Most iterations', or"
                                           : " try a softer penalty, more 'Most iterations', or")
            << " look at the last picture for an unstable or torn mesh";
  return message.str() + describe_incompressibility(parameters) +
         (is_unstable ? ". Besides, " + EnergyWatch::advise(EnergyWatch::Cause::unstable_law) : "") +
         computed.str();
}

} // namespace

void check_output_folder(const parameters::Scene &parameters) {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::path folder = fs::absolute(parameters.output.folder.value, error);
  while (!fs::exists(folder, error) && folder.has_relative_path())
    folder = folder.parent_path();
  if (!fs::is_directory(folder, error) || access(folder.c_str(), W_OK | X_OK) != 0)
    throw InputError(parameters.output.folder.origin + ": found '" + parameters.output.folder.value +
                     "', allowed is a folder that can be made and written to; '" + folder.string() + "' is " +
                     (fs::is_directory(folder, error) ? "not writable" : "not a folder"));
  for (const std::string name : {"scene.prm", "history.csv"}) {
    const fs::path file = fs::path(parameters.output.folder.value) / name;
    if (fs::exists(file, error) && (fs::is_directory(file, error) || access(file.c_str(), W_OK) != 0))
      throw InputError(parameters.output.folder.origin + ": found '" + parameters.output.folder.value +
                       "', allowed is a folder that can be made and written to; '" + file.string() +
                       "' cannot be written over");
  }
}

namespace {

/// What is doubtful about the undeformed meshes. Collective.
DiagnosticList find_doubts(const Scene &scene, const Discretization &discretization) {
  DiagnosticList doubts = find_inverted_corners(scene, discretization);
  append(doubts, find_faceted_curvature(scene, discretization));
  return doubts;
}

/// Where a run begins that is not the first of its scene.
struct Resumption {
  CheckpointReader reader;
  RestartReport report;

  Resumption(const parameters::Scene &parameters, MPI_Comm communicator)
      : reader(communicator, parameters.restart.file.value, parameters.restart.file.origin) {}

  /// Into this folder; then what is there goes on.
  bool is_from(const std::string &folder) const {
    const auto from = std::filesystem::path(reader.file_name()).parent_path();
    std::error_code error;
    return std::filesystem::equivalent(from.empty() ? "." : from, folder, error);
  }
  /// The solution's own part: `load` returns the report.
  template <class Load>
  void load(const Scene &scene, const Discretization &discretization, const Load &load) {
    reader.load("scene", [&] { check_scene(reader, scene, discretization); });
    reader.load("solution", [&] { report = load(); });
    const parameters::Scene &parameters = scene.parameters();
    if (report.time < parameters.time_stepping.end_time)
      return;
    std::ostringstream message;
    message << parameters.file_name << ": found 'End time' = " << parameters.time_stepping.end_time
            << ", allowed is a time after that of the checkpoint, " << report.time;
    throw InputError(message.str());
  }
};

/// What a run writes: the copy of the scene, the history, the fields, the console, checkpoints.
struct Outputs {
  /// `resumption`: none if the run begins at time 0.
  Outputs(const Scene &scene, const Discretization &discretization, Diagnostics &diagnostics,
          Resumption *resumption)
      : is_first(dealii::Utilities::MPI::this_mpi_process(discretization.communicator()) == 0),
        writer(scene, discretization, scene.parameters().output.folder.value),
        snapshots(scene.parameters(), writer),
        progress(scene, is_first ? std::cout : silence, is_first && console_is_terminal()),
        diagnostics(diagnostics), checkpoints(scene.parameters().output, discretization.communicator()),
        signals(discretization.communicator()), scene_(scene), discretization_(discretization) {
    const std::string &folder = scene.parameters().output.folder.value;
    const bool goes_on = resumption != nullptr && resumption->is_from(folder);
    HistoryFile::Mark mark;
    if (resumption != nullptr)
      resumption->reader.in("output", [&] {
        mark = {resumption->reader.read_text("columns"), resumption->reader.number("bytes")};
        checkpoints.load(resumption->reader, resumption->report.time, goes_on);
        snapshots.load(resumption->reader);
        if (goes_on && resumption->reader.read_text("format") == format())
          writer.load(resumption->reader);
        if (goes_on && resumption->reader.has("diagnostics"))
          diagnostics.load(resumption->reader.read_text("diagnostics"));
      });
    diagnostics.set_print([this](const Severity severity, const std::string &text) {
      progress.show_diagnostic(severity, text);
    });
    fail_together(discretization.communicator(), [&] {
      if (is_first) {
        prepare_folder(scene.parameters());
        diagnostics.open(folder + "/diagnostics.jsonl", goes_on);
        history = goes_on ? std::make_unique<HistoryFile>(scene, folder, mark, resumption->report.time)
                          : std::make_unique<HistoryFile>(scene, folder);
      }
    });
  }

  ~Outputs() { diagnostics.set_print({}); }
  Outputs(const Outputs &) = delete;
  Outputs &operator=(const Outputs &) = delete;

  /// Reports where the run resumes, and with what.
  void announce(const Resumption &resumption, const double force_tolerance) {
    const RestartReport &report = resumption.report;
    std::ostringstream text;
    text << "Resumed from " << resumption.reader.file_name() << " at time " << report.time;
    for (const auto &part : report.gone)
      text << ", without " << part;
    if (report.kinetic_energy > 0.)
      text << ". The kinetic energy there, " << report.kinetic_energy << ", is dropped";
    if (report.imbalance > force_tolerance * report.force_scale)
      text << ". Forces out of balance, " << 100. * report.imbalance / report.force_scale
           << " % of those in the scene, fade until time " << report.release_end;
    diagnostics.report(Diagnostic(diagnostic::resumed, text.str()));
  }

  /// Ends a run that has come to its end time. Collective.
  ExitCode finish() {
    ExitCode code = ExitCode::success;
    if (scene_.parameters().warnings_are_errors && diagnostics.count(Severity::warning) > 0)
      code = ExitCode::warnings;
    else if (diagnostics.has(diagnostic::target_error_missed))
      code = ExitCode::target_missed;
    progress.finish(diagnostics.repetitions(), diagnostics.count_in_words(), writer.file_to_open());
    return code;
  }

  /// Writes a checkpoint of what `save` saves. A full disk does not end the run.
  bool write_checkpoint(const double time, const std::function<void(StateWriter &)> &save) {
    const HistoryFile::Mark mark = is_first ? history->mark() : HistoryFile::Mark();
    const std::string failure = checkpoints.write(time, [&](StateWriter &state) {
      state.in("scene", [&] { save_scene(state, scene_, discretization_); });
      save(state);
      state.in("output", [&] {
        state.write_text("columns", mark.columns);
        state.write("bytes", {mark.n_bytes});
        state.write_text("format", format());
        state.write_text("diagnostics", diagnostics.save());
        checkpoints.save(state);
        snapshots.save(state);
        writer.save(state);
      });
    });
    if (!failure.empty())
      diagnostics.report(
          Diagnostic(
              diagnostic::checkpoint_failed,
              "No checkpoint was written: " + failure +
                  (checkpoints.last().empty() ? "" : " The last one, " + checkpoints.last() + ", stays"))
              .time(time));
    return failure.empty();
  }

  /// What to say where a signal ends the run.
  std::string explain_stop(const unsigned int n_steps, const double time) const {
    std::ostringstream message;
    message << scene_.parameters().file_name << ": stopped by " << signals.name() << " at time " << time
            << " after " << n_steps << " steps";
    return message.str();
  }
  /// Ends the run as a signal demands.
  ExitCode stop(const unsigned int n_steps, const double time, const bool has_checkpoint) {
    const std::string what = explain_stop(n_steps, time);
    if (!has_checkpoint)
      throw SolutionFailure(what + ", and no checkpoint could be written" +
                            (checkpoints.last().empty() ? "" : "; the last one is " + checkpoints.last()));
    if (is_first)
      std::cerr << "billet: " << what << ". To resume: billet --restart " << checkpoints.last() << " "
                << scene_.parameters().file_name << std::endl;
    return ExitCode::stopped;
  }

  bool is_first;
  std::unique_ptr<HistoryFile> history; ///< on the first rank
  FieldWriter writer;
  Snapshots snapshots;
  std::ostringstream silence;
  Progress progress;
  Diagnostics &diagnostics;
  Checkpoints checkpoints;
  Signals signals;

private:
  std::string format() const {
    switch (scene_.parameters().output.format) {
    case parameters::Output::Format::vtu:
      return "vtu";
    case parameters::Output::Format::hdf5:
      return "hdf5";
    case parameters::Output::Format::none:
      break;
    }
    return "none";
  }

  const Scene &scene_;
  const Discretization &discretization_;
};

/// Of this process, in seconds.
double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Reports the estimate, and writes error_estimate.csv. Collective.
void report_errors(ErrorReport report, const Solution &solution, const Discretization &discretization,
                   const parameters::Scene &parameters, const RunReview &review, Outputs &outputs) {
  report.target = parameters.target_error;
  if (review.element_error() > 0.)
    report.sources.push_back(
        {"elements", review.element_error(), "Choose the element that the warnings about them name"});
  if (review.penalty_error() > 0.)
    report.sources.push_back(
        {"soft contact", review.penalty_error(), "Increase the penalties that the warnings name"});
  report.stress_jumps = stress_jumps(solution, discretization);
  report.costs.emplace_back("CPU seconds",
                            dealii::Utilities::MPI::sum(processor_time(), discretization.communicator()));
  outputs.diagnostics.report(report.diagnostics());
  fail_together(discretization.communicator(), [&] {
    if (outputs.is_first)
      report.write(parameters.output.folder.value);
  });
}

ErrorReport make_report(const ErrorWatch &watch, const StepReport &report) {
  const ErrorWatch::Belief belief = watch.belief();
  const ErrorControl::Estimate &estimate = belief.estimate;
  ErrorReport result;
  result.of_what = belief.of_what;
  result.since = belief.since;
  result.is_known = belief.has_results;
  result.sources = {
      {"steps", estimate.steps,
       "Reduce 'Largest step' or 'Initial step': no step is rejected for its error, and where contacts open "
       "and "
       "close the estimate is on the safe side",
       !watch.measures_steps() || watch.n_measurements() > 0},
      {"penetrations", estimate.penetration,
       watch.controls_penetration()
           ? "Reduce 'Initial step', or set a 'Penetration tolerance' in every pair: penetration at first "
             "contact is measured after the step"
           : "Increase 'Normal penalty', or leave 'Penetration tolerance' to the target error in all pairs",
       !watch.measures_penetration() || belief.knows_penetration},
      {"iterations", estimate.iterations, "Reduce 'Force tolerance'"}};
  result.costs = {{"steps taken", report.step},
                  {"Newton iterations", report.total_iterations},
                  {"of them for estimates", watch.n_iterations()}};
  return result;
}

/// What it cost is left to the caller.
ErrorReport make_report(const EnergyErrors &errors, const std::string &shorter_steps) {
  ErrorReport result;
  result.of_what = "energies";
  result.since = errors.start();
  result.is_known = errors.has_energies();
  result.sources = {{"steps", errors.steps(), shorter_steps},
                    {"penetrations", errors.penetration(), "Increase 'Normal penalty'"}};
  return result;
}

ExitCode run_quasi_static(const Scene &scene, const Discretization &discretization, Diagnostics &diagnostics,
                          Resumption *resumption) {
  const parameters::Scene &parameters = scene.parameters();
  QuasiStatic problem(scene, discretization);
  std::vector<double> stops = scene.stops();
  if (resumption != nullptr) {
    resumption->load(scene, discretization,
                     [&] { return problem.load(resumption->reader, parameters.restart.release_time); });
    stops.push_back(resumption->report.release_end);
  }
  StepControl control(parameters.time_stepping, parameters.output.interval, stops);
  std::unique_ptr<ErrorWatch> watch;
  std::unique_ptr<EnergyErrors> errors; // steps of dynamics follow their own estimate
  if (parameters.is_dynamic() && parameters.target_error > 0.)
    errors = std::make_unique<EnergyErrors>(parameters.target_error);
  else if (ErrorWatch::is_wanted(parameters))
    watch = std::make_unique<ErrorWatch>(scene, discretization, problem);
  StabilityWatch stability(scene, discretization);
  const double largest_drift = parameters.is_dynamic() ? parameters.implicit_dynamics.largest_drift : 0.;
  EnergyWatch energies = largest_drift > 0.        ? EnergyWatch(EnergyWatch::Balance::is_kept, largest_drift)
                         : parameters.is_dynamic() ? EnergyWatch(EnergyWatch::Balance::is_told)
                                                   : EnergyWatch(EnergyWatch::Balance::is_left);
  const bool has_sticking_overlaps =
      std::any_of(scene.body_pairs().begin(), scene.body_pairs().end(), [](const BodyPair &pair) {
        return pair.has_friction() && pair.facets == parameters::ContactPair::Facets::overlap;
      });
  RunReview review(scene, discretization);
  StepReport report;
  double continued = 0.; // length of the last step, if its increment may be continued
  if (resumption != nullptr) {
    control.begin(resumption->report.time, 0);
    if (watch)
      watch->begin(resumption->report.time);
    if (errors)
      errors->begin(resumption->report.time);
    if (resumption->reader.has("steps"))
      resumption->reader.in("steps", [&] {
        control.load(resumption->reader);
        const std::vector<double> totals = resumption->reader.read("totals");
        continued = resumption->report.is_exact ? totals.at(0) : 0.;
        report.total_iterations = static_cast<unsigned int>(totals.at(1));
        report.total_cuts = control.n_cuts();
        if (watch)
          watch->load(resumption->reader);
        review.load(resumption->reader);
        if (errors && resumption->reader.has("errors"))
          errors->load(resumption->reader);
      });
  }
  const std::array<bool, 3> free_directions = scene.free_directions();
  const double mass = errors ? problem.mass() : 0.;
  Outputs outputs(scene, discretization, diagnostics, resumption);
  outputs.progress.start(discretization, problem);
  diagnostics.report(problem.initial_diagnostics());
  diagnostics.report(review.start());
  if (resumption == nullptr)
    diagnostics.report(find_doubts(scene, discretization));
  if (resumption != nullptr)
    outputs.announce(*resumption, parameters.solver.force_tolerance);
  if (resumption == nullptr || !resumption->report.is_exact)
    outputs.snapshots.write(problem);
  const auto save = [&](StateWriter &writer) {
    writer.in("solution", [&] { problem.save(writer); });
    writer.in("steps", [&] {
      control.save(writer);
      writer.write("totals", {continued, static_cast<double>(report.total_iterations)});
      if (watch)
        watch->save(writer);
      if (errors)
        errors->save(writer);
      review.save(writer);
    });
  };
  while (!control.is_finished()) {
    if (watch)
      report.total_iterations += watch->before_step(control, continued);
    const double from = control.time(), to = control.next_time();
    report.length = to - from;
    try {
      report.newton = problem.step(to, continued);
    } catch (const SolutionFailure &) { // nothing already computed is lost
      outputs.snapshots.write(problem);
      throw;
    }
    report.total_iterations += static_cast<unsigned int>(report.newton.iterations.size());
    diagnostics.report(report.newton.diagnostics);
    if (report.newton.converged) {
      control.accept(static_cast<unsigned int>(report.newton.hardest), problem.time_error());
      if (watch) {
        watch->after_step(control, report.length, report.newton);
        diagnostics.report(watch->check(control));
      }
      if (errors) {
        const double factor = errors->step_factor();
        errors->add(control.time(), problem.state().energies,
                    carried_energy(free_directions, problem.state().momentum, mass));
        if (errors->step_factor() < factor)
          control.limit(errors->step_factor() * report.length);
      }
      continued = report.length;
      report.step = control.n_steps();
      fail_together(discretization.communicator(), [&] {
        if (outputs.is_first)
          outputs.history->write(report, problem.state());
      });
      outputs.progress.accept(report, problem.state());
      diagnostics.report(review.after_step(problem, control.is_finished()));
      diagnostics.report(stability.check(control.time(), problem.state().displacements));
      diagnostics.report(energies.check(control.time(), problem.state().energies, [&] {
        return stability.has_unstable_bodies() ? EnergyWatch::Cause::unstable_law
               : problem.has_soft_penalties()  ? EnergyWatch::Cause::soft_penalties
               : has_inexact_dissipation(scene, discretization, problem)
                   ? EnergyWatch::Cause::inexact_dissipation
               : has_sticking_overlaps          ? EnergyWatch::Cause::sticking_overlaps
               : problem.contact_makes_energy() ? EnergyWatch::Cause::contact_edges
                                                : EnergyWatch::Cause::steps;
      }));
      if (!energies.imbalance().empty()) {
        outputs.snapshots.write(problem);
        std::ostringstream message;
        message << parameters.file_name << ": at time " << control.time() << " after " << control.n_steps()
                << " steps " << energies.imbalance() << ". " << describe_limit_load(parameters)
                << "What was computed until then is in '" << parameters.output.folder.value << "'.";
        throw SolutionFailure(Diagnostic(diagnostic::energy_drift, message.str())
                                  .value("steps", control.n_steps())
                                  .value("Newton iterations", report.total_iterations));
      }
      outputs.snapshots.after_step(control.n_steps(), problem);
      const Signals::Wish wish = outputs.signals.look();
      const bool is_last = control.is_finished() && outputs.checkpoints.is_regular();
      const bool has_checkpoint = (wish != Signals::Wish::none || is_last ||
                                   outputs.checkpoints.is_due(control.n_steps(), control.time())) &&
                                  outputs.write_checkpoint(control.time(), save);
      if (wish == Signals::Wish::end && !control.is_finished())
        return outputs.stop(control.n_steps(), control.time(), has_checkpoint);
      continue;
    }
    outputs.progress.reject(report, from, to);
    if (watch)
      watch->after_failure();
    // Smaller loads would make that worse.
    bool may_go_on = control.reject() && !report.newton.is_lost_in_round_off;
    report.total_cuts = control.n_cuts();
    if (!may_go_on && !report.newton.is_lost_in_round_off && !report.newton.is_explained) {
      may_go_on = problem.take_exact_tangent();
      if (may_go_on)
        diagnostics.report(
            Diagnostic(diagnostic::exact_tangent,
                       "Newton's method failed with this 'Contact tangent'; from here on it is "
                       "the exact one, with an unsymmetric matrix")
                .time(from));
    }
    if (!may_go_on) {
      outputs.snapshots.write(problem);
      throw SolutionFailure(
          Diagnostic(diagnostic::solution_failed,
                     explain_failure(parameters, report, from, to, stability.has_unstable_bodies()))
              .value("steps", report.step)
              .value("Newton iterations", report.total_iterations));
    }
  }
  diagnostics.report(review.finish());
  diagnostics.report(problem.check_stabilisation());
  diagnostics.report(problem.check_balance());
  diagnostics.report(problem.check_contact_round_off());
  diagnostics.report(problem.check_augmentation());
  if (watch)
    report_errors(make_report(*watch, report), problem, discretization, parameters, review, outputs);
  if (errors) {
    ErrorReport estimate = make_report(*errors, "Reduce 'Largest step'");
    estimate.costs = {{"steps taken", report.step}, {"Newton iterations", report.total_iterations}};
    report_errors(std::move(estimate), problem, discretization, parameters, review, outputs);
  }
  diagnostics.report(find_checkerboard(problem, discretization).check());
  return outputs.finish();
}

/// Where steps of an explicit scene have to end: where the scene itself stops, not where something is
/// written.
class Events {
public:
  explicit Events(const Scene &scene)
      : end_(scene.parameters().time_stepping.end_time), stops_(scene.stops()) {
    const auto &more = scene.parameters().time_stepping.stops;
    stops_.insert(stops_.end(), more.begin(), more.end());
    // One that is at the end but for round-off is the end.
    constexpr double rounding = 1e-9;
    stops_.erase(std::remove_if(stops_.begin(), stops_.end(),
                                [this](const double stop) { return stop > end_ * (1. - rounding); }),
                 stops_.end());
    stops_.push_back(end_);
    std::sort(stops_.begin(), stops_.end());
  }

  double next(const double time) const { return *std::upper_bound(stops_.begin(), stops_.end() - 1, time); }
  double end() const { return end_; }

private:
  double end_;
  std::vector<double> stops_;
};

/// When a row of the history is due: at the start, at the end of the first step that reaches the next
/// multiple of the interval, at the end.
class HistoryTimes {
public:
  explicit HistoryTimes(const parameters::Scene &parameters)
      : end_(parameters.time_stepping.end_time),
        interval_(parameters.output.history_interval > 0. ? parameters.output.history_interval
                                                          : end_ / 200.) {}

  /// Once for each time.
  bool is_due(const double time) {
    constexpr double rounding = 1e-9; // of an interval
    const double n = std::floor(time / interval_ + rounding);
    const bool is_due = n > last_ || time >= end_;
    last_ = std::max(n, last_);
    return is_due;
  }

  double last() const { return last_; } ///< multiple that was reached
  double interval() const { return interval_; }
  void begin_after(const double last) { last_ = last; }

private:
  double end_, interval_, last_ = -1.;
};

/// At the end: added mass that changes the motion.
DiagnosticList check_mass_scaling(const ExplicitDynamics &problem, const RunReview &review) {
  constexpr double much = 0.1, slow = 0.05;
  const double added = problem.added_mass() / problem.mass(), kinetic = review.kinetic_part();
  if (!(added > much && kinetic > slow))
    return {};
  std::ostringstream text;
  text.precision(3);
  text << "Mass scaling adds " << 100. * added << " % to the mass, and the kinetic energy reaches "
       << 100. * kinetic << " % of the internal energy";
  return {Diagnostic(diagnostic::mass_scaling_too_strong, text.str())
              .measure("added mass / mass", added)
              .value("kinetic / internal energy", kinetic)};
}

ExitCode run_explicit(const Scene &scene, const Discretization &discretization, Diagnostics &diagnostics,
                      Resumption *resumption) {
  const parameters::Scene &parameters = scene.parameters();
  ExplicitDynamics problem(scene, discretization);
  const Events events(scene);
  HistoryTimes history_times(parameters);
  std::unique_ptr<EnergyErrors> errors;
  if (parameters.target_error > 0.)
    errors = std::make_unique<EnergyErrors>(parameters.target_error);
  RunReview review(scene, discretization);
  unsigned int balanced_step = 0; // the last at which the energies were seen to balance
  if (resumption != nullptr) {
    resumption->load(scene, discretization, [&] { return problem.load(resumption->reader); });
    problem.plan_to(events.next(problem.time()));
    if (errors)
      errors->begin(problem.time());
    if (resumption->report.is_exact && resumption->reader.has("rows"))
      resumption->reader.in("rows", [&] {
        // Of another interval the next row is due at once.
        if (resumption->reader.number("interval") == history_times.interval())
          history_times.begin_after(resumption->reader.number("last"));
        balanced_step = static_cast<unsigned int>(resumption->reader.number("balanced step"));
        review.load(resumption->reader);
        if (errors && resumption->reader.has("errors")) {
          errors->load(resumption->reader);
          problem.shorten_steps(errors->step_factor());
        }
      });
  }
  const std::array<bool, 3> free_directions = scene.free_directions();
  Outputs outputs(scene, discretization, diagnostics, resumption);
  outputs.progress.start(discretization, problem);
  diagnostics.report(problem.initial_diagnostics());
  diagnostics.report(review.start());
  if (resumption == nullptr)
    diagnostics.report(find_doubts(scene, discretization));
  if (resumption != nullptr)
    outputs.announce(*resumption, 0.);
  const auto save = [&](StateWriter &writer) {
    writer.in("solution", [&] { problem.save(writer); });
    writer.in("rows", [&] {
      writer.write("interval", {history_times.interval()});
      writer.write("last", {history_times.last()});
      writer.write("balanced step", {static_cast<double>(balanced_step)});
      review.save(writer);
      if (errors)
        errors->save(writer);
    });
  };
  if (parameters.explicit_dynamics.scaled_step > 0.) {
    std::ostringstream text;
    text << "Mass scaling adds " << problem.added_mass() << " to the bodies' " << problem.mass() << " ("
         << std::setprecision(3) << 100. * problem.added_mass() / problem.mass() << " %)";
    diagnostics.report(Diagnostic(diagnostic::mass_scaling, text.str())
                           .value("mass", problem.mass())
                           .value("added mass", problem.added_mass()));
  }

  EnergyWatch energies(EnergyWatch::Balance::is_left); // where they fail to balance the run ends
  StabilityWatch stability(scene, discretization);
  constexpr double n_looks = 100.; // in a run: each takes as long as a step or a few
  double next_look = 0.;
  const auto put_out = [&] {
    problem.update_ledger();
    fail_together(discretization.communicator(), [&] {
      if (outputs.is_first)
        outputs.history->write(problem.n_steps(), problem.step_length(), problem.state());
    });
    outputs.progress.show(problem.n_steps(), problem.step_length(), problem.state());
    diagnostics.report(problem.check_penalties());
    problem.update_state();
    diagnostics.report(review.after_step(problem, problem.time() >= events.end()));
    diagnostics.report(energies.check(problem.time(), problem.state().energies));
  };
  const auto look_at_stability = [&] {
    if (problem.time() < next_look || !std::isfinite(problem.relative_drift()))
      return;
    problem.update_state();
    diagnostics.report(stability.check(problem.time(), problem.state().displacements));
    next_look = problem.time() + events.end() / n_looks;
  };
  constexpr unsigned int steps_between_looks = ExplicitDynamics::steps_between_looks;
  const auto advise_on_law = [&]() -> std::string {
    diagnostics.report(stability.check(problem.time(), problem.state().displacements));
    return stability.has_unstable_bodies() ? EnergyWatch::advise(EnergyWatch::Cause::unstable_law)
           : !problem.has_soft_penalties() && has_inexact_dissipation(scene, discretization, problem)
               ? EnergyWatch::advise(EnergyWatch::Cause::inexact_dissipation)
               : "";
  };
  // The first touch makes all the energy there is, and up to a quarter of it is the error of the step in
  // which a node enters; it is a small part soon. Energy without limit grows on.
  const auto stop_on_drift = [&](const bool is_finished) {
    const bool is_finite = std::isfinite(problem.relative_drift());
    if (std::abs(problem.relative_drift()) <= parameters.explicit_dynamics.largest_drift)
      balanced_step = problem.n_steps();
    if (is_finite && problem.n_steps() < balanced_step + (is_finished ? 1 : steps_between_looks))
      return;
    problem.update_state();
    outputs.snapshots.write(problem);
    const std::string of_law = is_finite ? advise_on_law() : "";
    std::ostringstream message;
    message << parameters.file_name << ": at time " << problem.time() << " after " << problem.n_steps()
            << " steps the energies ";
    if (is_finite)
      message << "fail to balance by " << 100. * problem.relative_drift()
              << " % of the largest energy so far, allowed are "
              << 100. * parameters.explicit_dynamics.largest_drift << " % ('Largest drift'): "
              << (!of_law.empty() ? of_law
                  : problem.has_soft_penalties()
                      ? "contact pairs are soft, and nodes that are deep make energy: try a larger 'Normal "
                        "penalty'"
                  : scene.capabilities().friction && !scene.body_pairs().empty()
                      ? "bodies with friction that stick and hop make energy: try a larger 'Normal penalty', "
                        "such as 1000 E/h; else a smaller 'Safety factor' or more bulk viscosity"
                      : "try a smaller 'Safety factor', a softer penalty or more bulk viscosity");
    else
      message << "are not finite; a velocity, a load or a penalty may be too large for its units";
    message << ". " << describe_limit_load(parameters) << "What was computed until then is in '"
            << parameters.output.folder.value << "'.";
    throw SolutionFailure(
        Diagnostic(is_finite ? diagnostic::energy_drift : diagnostic::solution_failed, message.str())
            .value("steps", problem.n_steps()));
  };

  double seconds = 0., processor_seconds = 0.; // of the steps, without output
  const auto measure = [&](const auto &run) {
    const auto start = std::chrono::steady_clock::now();
    const double processor_start = processor_time();
    run();
    processor_seconds += processor_time() - processor_start;
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  const auto attempt = [&](const auto &run) {
    try {
      measure(run);
    } catch (const SolutionFailure &failure) { // nothing already computed is lost
      problem.update_state();
      outputs.snapshots.write(problem);
      if (std::isfinite(problem.relative_drift()))
        diagnostics.report(stability.check(problem.time(), problem.state().displacements));
      throw SolutionFailure(
          Diagnostic(failure.diagnostic().kind(),
                     std::string(failure.what()) + ". " +
                         (stability.has_unstable_bodies()
                              ? "Besides, " + EnergyWatch::advise(EnergyWatch::Cause::unstable_law) + ". "
                              : "") +
                         describe_limit_load(parameters) + "What was computed until then is in '" +
                         parameters.output.folder.value + "'.")
              .value("steps", problem.n_steps()));
    }
  };
  for (bool is_finished = false; !is_finished;) {
    is_finished = problem.time() >= events.end();
    const bool is_due = history_times.is_due(problem.time()) || problem.n_steps() == 0;
    attempt([&] {
      const double event = is_finished ? events.end() + problem.step_length() : events.next(problem.time());
      problem.prepare_step(event);
    });
    if (problem.n_steps() == 0) {
      const double n_steps = events.end() / problem.usual_step();
      outputs.progress.show_number_of_steps(n_steps, problem.usual_step());
      if (n_steps > too_many_steps && !diagnostics.has(diagnostic::many_steps))
        diagnostics.report(
            Diagnostic(diagnostic::many_steps, "The run takes " + std::to_string(n_steps) + " steps")
                .value("steps", n_steps));
    }
    if (is_due)
      put_out();
    else if (problem.n_steps() % steps_between_looks == 0)
      problem.update_ledger();
    if (is_due || problem.n_steps() % steps_between_looks == 0) {
      diagnostics.report(problem.check_steps());
      look_at_stability();
      stop_on_drift(is_finished);
      if (errors) {
        errors->add(
            problem.time(), problem.state().energies,
            carried_energy(free_directions, problem.state().momentum, problem.mass() + problem.added_mass()));
        problem.shorten_steps(errors->step_factor());
      }
    }
    if (problem.n_steps() == 0) {
      problem.update_state();
      outputs.snapshots.write(problem);
    } else if (outputs.snapshots.is_due(problem.n_steps(), problem.time())) {
      problem.update_state();
      outputs.snapshots.after_step(problem.n_steps(), problem);
    }
    if (!is_finished || outputs.checkpoints.is_regular()) // a checkpoint is of the next step's beginning
      attempt([&] { problem.finish_step(); });
    const Signals::Wish wish = outputs.signals.look_now_and_then();
    const bool is_last = is_finished && outputs.checkpoints.is_regular();
    const bool has_checkpoint =
        (is_last || (!is_finished && wish != Signals::Wish::none) ||
         (problem.time() < events.end() && outputs.checkpoints.is_due(problem.n_steps(), problem.time()))) &&
        outputs.write_checkpoint(problem.time(), save);
    if (wish == Signals::Wish::end && !is_finished)
      return outputs.stop(problem.n_steps(), problem.time(), has_checkpoint);
  }
  diagnostics.report(review.finish());
  diagnostics.report(check_mass_scaling(problem, review));
  if (errors) {
    ErrorReport report = make_report(*errors, "Reduce 'Safety factor'");
    report.costs = {{"steps taken", problem.n_steps()},
                    {"element updates", static_cast<double>(problem.n_steps()) *
                                            static_cast<double>(discretization.n_global_elements())}};
    problem.update_state();
    report_errors(report, problem, discretization, parameters, review, outputs);
  }
  outputs.progress.show_pace(problem.n_steps(), discretization.n_global_elements(), seconds,
                             processor_seconds);
  problem.update_state();
  diagnostics.report(find_checkerboard(problem, discretization).check());
  return outputs.finish();
}

} // namespace

namespace {

/// Sets up what a run would set up. Returns what it would warn of before its first step. Collective.
DiagnosticList check_start(const Scene &scene, MPI_Comm communicator) {
  const Discretization discretization(scene, communicator);
  DiagnosticList messages =
      check_plausibility(scene, discretization.dof_handler().get_triangulation(), communicator);
  if (scene.parameters().restart.is_wanted())
    return messages;
  if (scene.parameters().is_explicit())
    append(messages, ExplicitDynamics(scene, discretization).initial_diagnostics());
  else
    append(messages, QuasiStatic(scene, discretization).initial_diagnostics());
  append(messages, find_doubts(scene, discretization));
  return messages;
}

/// Checks the outline of the meshes only, which fits anywhere. Collective.
DiagnosticList check_outline(const Scene &scene, MPI_Comm communicator) {
  DiagnosticList messages;
  fail_together(communicator, [&] {
    dealii::Triangulation<3> outline;
    scene.build_mesh(MeshDetail::outline, outline);
    messages = check_plausibility(scene, outline, MPI_COMM_SELF);
  });
  messages.emplace_back(diagnostic::outline_checked,
                        "The mesh is too large to be built for a check: overlaps of bodies and the shapes of "
                        "elements were not checked");
  return messages;
}

} // namespace

void check_simulation(const parameters::Scene &parameters, MPI_Comm communicator, std::ostream &stream,
                      const bool as_json) {
  fail_together(communicator, [&] { check_output_folder(parameters); });
  if (parameters.restart.is_wanted())
    const CheckpointReader sound(communicator, parameters.restart.file.value, parameters.restart.file.origin);
  const Scene scene(parameters);
  constexpr std::size_t max_elements = 500000; // a minute and some GB on one rank
  DiagnosticList messages = scene.count_elements() <= max_elements ? check_start(scene, communicator)
                                                                   : check_outline(scene, communicator);
  append(messages, check_bricks(scene));
  if (dealii::Utilities::MPI::this_mpi_process(communicator) != 0)
    return;
  if (as_json) {
    stream << scene.describe_as_json(messages) << "\n";
    return;
  }
  scene.describe(stream);
  for (const auto &message : messages)
    stream << message.text() << "\n";
}

ExitCode run_simulation(const parameters::Scene &parameters, MPI_Comm communicator) {
  // Set up: everything that can be wrong with the scene shows here, before anything is written.
  fail_together(communicator, [&] { check_output_folder(parameters); });
  std::unique_ptr<Resumption> resumption;
  if (parameters.restart.is_wanted())
    resumption = std::make_unique<Resumption>(parameters, communicator);
  const Scene scene(parameters);
  const Discretization discretization(scene, communicator);
  Diagnostics diagnostics(dealii::Utilities::MPI::this_mpi_process(communicator) == 0);
  ExitCode code = ExitCode::success;
  try {
    code = parameters.is_explicit() ? run_explicit(scene, discretization, diagnostics, resumption.get())
                                    : run_quasi_static(scene, discretization, diagnostics, resumption.get());
  } catch (const SolutionFailure &failure) { // on all ranks
    diagnostics.report(failure.diagnostic());
    diagnostics.write_summary(static_cast<int>(ExitCode::failed_solution));
    throw;
  }
  fail_together(communicator, [&] {
    if (!diagnostics.write_summary(static_cast<int>(code)))
      throw SolutionFailure("'" + diagnostics.file_name() + "' cannot be written: is the disk full?");
  });
  write_capabilities(parameters.output.folder.value, communicator);
  return code;
}

} // namespace billet
