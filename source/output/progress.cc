// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/progress.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>
#include <sstream>

namespace billet {

using Verbosity = parameters::Output::Verbosity;

namespace {

constexpr double seconds_between_lines = 30.; // of progress where there is no terminal

std::string format_duration(const double seconds) {
  const auto whole = std::lround(seconds);
  std::ostringstream stream;
  stream << std::setfill('0');
  if (whole >= 3600)
    stream << whole / 3600 << ":" << std::setw(2);
  stream << whole / 60 % 60 << ":" << std::setw(2) << whole % 60;
  return stream.str();
}

} // namespace

Progress::Progress(const Scene &scene, std::ostream &stream, const bool is_terminal)
    : scene_(scene), stream_(stream), is_terminal_(is_terminal),
      verbosity_(scene.parameters().output.verbosity) {}

double Progress::elapsed() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void Progress::start(const Discretization &discretization, const Solution &solution) {
  if (verbosity_ == Verbosity::quiet)
    return;
  shows_linear_iterations_ = solution.solves_iteratively();
  if (!scene_.parameters().title.empty())
    stream_ << scene_.parameters().title << "\n";
  const parameters::Scene &parameters = scene_.parameters();
  if (!parameters.presets.empty()) {
    if (parameters.target_error > 0.)
      stream_ << "Target error " << 100. * parameters.target_error << " %:";
    else
      stream_ << "Profile " << parameters.profile << ":";
    for (const auto &preset : parameters.presets)
      stream_ << (&preset == parameters.presets.data() ? " " : ", ") << parameters::to_string(preset);
    stream_ << "\n";
  }
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(discretization.communicator());
  stream_ << discretization.n_global_elements() << " elements, " << discretization.dof_handler().n_dofs()
          << " unknowns, " << n_ranks << (n_ranks == 1 ? " process, " : " processes, ") << solution.method()
          << "\n";
}

void Progress::show_number_of_steps(const double n_steps, const double step) {
  if (verbosity_ == Verbosity::quiet)
    return;
  stream_ << "The run takes about " << std::llround(n_steps) << " steps of " << std::setprecision(4) << step
          << std::setprecision(6) << "\n";
}

void Progress::show_diagnostic(const Severity severity, const std::string &text) {
  if (verbosity_ == Verbosity::quiet && severity == Severity::note)
    return;
  erase_bar();
  stream_ << text << std::endl;
}

void Progress::accept(const StepReport &report, const SolutionState &state) {
  if (verbosity_ == Verbosity::quiet)
    return;
  erase_bar();
  if (verbosity_ == Verbosity::iterations)
    show_iterations(report.newton);
  if (n_lines_++ % 40 == 0) {
    stream_ << "  step        time        step iter" << (shows_linear_iterations_ ? " linear" : "")
            << "   residual";
    for (const auto &tool : scene_.tools())
      stream_ << std::setw(14) << ("|F| " + tool.name()).substr(0, 13);
    stream_ << "   plastic work\n";
  }
  stream_ << std::setw(6) << report.step << std::setw(12) << std::setprecision(6) << state.time
          << std::setw(12) << std::setprecision(4) << report.length << std::setw(5)
          << report.newton.iterations.size();
  if (shows_linear_iterations_)
    stream_ << std::setw(7) << report.newton.linear_iterations;
  stream_ << std::setw(11) << std::setprecision(2) << report.newton.force << std::setprecision(7);
  for (const auto &load : state.tool_loads)
    stream_ << std::setw(14) << load.force.norm();
  stream_ << std::setw(15) << state.energies.plastic << "\n";
  show_advance(state.time, report.length);
  stream_ << std::flush;
}

void Progress::show(const unsigned int step, const double length, const SolutionState &state) {
  if (verbosity_ == Verbosity::quiet)
    return;
  erase_bar();
  if (n_lines_++ % 40 == 0) {
    stream_ << "    step        time        step       kinetic       plastic      external   drift";
    for (const auto &tool : scene_.tools())
      stream_ << std::setw(14) << ("|F| " + tool.name()).substr(0, 13);
    for (const auto &pair : scene_.body_pairs())
      stream_ << std::setw(14) << ("|F| " + pair.name).substr(0, 13);
    stream_ << "\n";
  }
  const EnergyLedger &energies = state.energies;
  const double scale = std::max(energies.total(), std::abs(energies.initial));
  stream_ << std::setw(8) << step << std::setw(12) << std::setprecision(6) << state.time << std::setw(12)
          << std::setprecision(4) << length << std::setprecision(6) << std::setw(14) << energies.kinetic
          << std::setw(14) << energies.plastic << std::setw(14) << energies.external << std::setw(8)
          << std::setprecision(1) << (scale > 0. ? energies.drift() / scale : 0.) << std::setprecision(6);
  for (const auto &load : state.tool_loads)
    stream_ << std::setw(14) << load.force.norm();
  for (const auto &load : state.body_pair_loads)
    stream_ << std::setw(14) << load.force.norm();
  stream_ << "\n";
  show_advance(state.time, length);
  stream_ << std::flush;
}

void Progress::reject(const StepReport &report, const double from, const double to) {
  if (verbosity_ == Verbosity::quiet)
    return;
  erase_bar();
  if (verbosity_ == Verbosity::iterations)
    show_iterations(report.newton);
  stream_ << "       step from " << std::setprecision(6) << from << " to " << to << " failed ("
          << report.newton.failure << (report.newton.criteria.empty() ? "" : "; ") << report.newton.criteria
          << ")" << std::endl;
}

void Progress::show_iterations(const NewtonReport &newton) {
  unsigned int n = 0;
  for (const auto &iteration : newton.iterations)
    stream_ << "         iteration " << std::setw(2) << ++n << "  force " << std::scientific
            << std::setprecision(3) << iteration.force << "  energy " << iteration.energy << std::defaultfloat
            << "  step length " << std::setprecision(3) << iteration.step_length << "\n";
}

void Progress::show_advance(const double time, const double length) {
  if (!begin_)
    begin_ = std::max(0., time - length);
  const double end = scene_.parameters().time_stepping.end_time, now = elapsed();
  // A run that resumes has not spent its time on what was there.
  const double part = std::min(1., time / end), part_of_run = (time - *begin_) / (end - *begin_);
  std::string duration = format_duration(now);
  if (part_of_run > 0. && part < 1.)
    duration += ", about " + format_duration(now * (1. - part_of_run) / part_of_run) + " to go";
  if (is_terminal_)
    return show_bar(part, duration);
  if (part < 1. && now - last_line_ >= seconds_between_lines) {
    stream_ << "       " << static_cast<int>(100. * part) << " % in " << duration << "\n";
    last_line_ = now;
  }
}

void Progress::show_bar(const double part, const std::string &duration) {
  constexpr int width = 40;
  const int filled = static_cast<int>(part * width);
  stream_ << "[" << std::string(static_cast<std::size_t>(filled), '=')
          << std::string(static_cast<std::size_t>(width - filled), ' ') << "] "
          << static_cast<int>(100. * part) << " %  " << duration;
  has_bar_ = true;
}

void Progress::erase_bar() {
  if (has_bar_)
    stream_ << "\r\033[K";
  has_bar_ = false;
}

void Progress::show_pace(const unsigned int n_steps, const std::size_t n_elements, const double seconds,
                         const double processor_seconds) {
  if (verbosity_ == Verbosity::quiet || n_steps == 0)
    return;
  erase_bar();
  const double n = static_cast<double>(n_steps) * static_cast<double>(n_elements);
  stream_ << n_steps << " steps of " << n_elements << " elements in " << std::setprecision(4) << seconds
          << " s: " << 1e9 * seconds / n << " ns for each element and step, " << 1e9 * processor_seconds / n
          << " of this process\n"
          << std::setprecision(6);
}

void Progress::finish(const std::vector<std::string> &repetitions, const std::string &warnings,
                      const std::string &file_to_open) {
  if (verbosity_ == Verbosity::quiet && warnings.empty())
    return;
  erase_bar();
  for (const auto &line : repetitions)
    stream_ << line << "\n";
  stream_ << "Completed in " << format_duration(elapsed())
          << (warnings.empty() ? " without warnings." : " with " + warnings + ".");
  if (!file_to_open.empty())
    stream_ << " Open in ParaView: " << file_to_open;
  stream_ << std::endl;
}

} // namespace billet
