// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/progress.h"

#include "billet/spent_time.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <map>
#include <ostream>
#include <sstream>

namespace billet {

using Verbosity = parameters::Output::Verbosity;

namespace {

constexpr double seconds_between_lines = 30.; // of progress where there is no terminal
constexpr std::size_t max_load_columns = 5;

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

int Progress::Load::width() const {
  constexpr int min_width = 14, prefix = 4, space = 2;
  return std::max(min_width, prefix + static_cast<int>(name.size()) + space);
}

Progress::Progress(const Scene &scene, std::ostream &stream, std::ostream &messages, const bool is_terminal)
    : scene_(scene), stream_(stream), messages_(messages), is_terminal_(is_terminal),
      verbosity_(scene.parameters().output.verbosity), start_(SpentTime::on_all()) {
  make_columns();
}

void Progress::find_loads() {
  for (std::size_t i = 0; i < scene_.tools().size(); ++i)
    loads_.push_back({scene_.tools()[i].name(), [i](const Solution &s) {
                        const ContactLoad &load = s.state().tool_loads[i];
                        return Resultant{load.force, load.moment};
                      }});
  for (std::size_t i = 0; i < scene_.body_pairs().size(); ++i)
    loads_.push_back({scene_.body_pairs()[i].name, [i](const Solution &s) {
                        const ContactLoad &load = s.state().body_pair_loads[i];
                        return Resultant{load.force, load.moment};
                      }});
  for (std::size_t i = 0; i < scene_.pairs().size(); ++i) {
    const auto is_of_tool = [&](const ContactPair &pair) { return pair.tool == scene_.pairs()[i].tool; };
    // If the tool has one pair, its load is the tool's.
    if (std::count_if(scene_.pairs().begin(), scene_.pairs().end(), is_of_tool) > 1)
      loads_.push_back({scene_.pairs()[i].name, [i](const Solution &s) {
                          const ContactLoad &load = s.reactions().of_tool_pairs[i];
                          return Resultant{load.force, load.moment};
                        }});
  }
  const std::vector<NamedSupport> supports = named_supports(scene_);
  const std::string support = "support ", plane = "symmetry plane ";
  const auto find_of_kind = [&](const std::string &kind) {
    std::map<std::string, unsigned int> n_of_name;
    for (const Load &load : loads_)
      ++n_of_name[load.name];
    for (const NamedSupport &of_body : supports)
      if (of_body.name.rfind(kind, 0) == 0)
        ++n_of_name[of_body.name.substr(kind.size())];
    for (std::size_t i = 0; i < supports.size(); ++i)
      if (supports[i].name.rfind(kind, 0) == 0) {
        const std::string name = supports[i].name.substr(kind.size());
        loads_.push_back({(n_of_name[name] > 1 ? scene_.bodies()[supports[i].body].name + "." : "") + name,
                          [i](const Solution &s) { return s.reactions().of_supports[i]; }});
      }
  };
  find_of_kind(support);
  if (loads_.empty()) // else most symmetry planes balance what is shown already
    find_of_kind(plane);
}

ForceChoice::Load Progress::size_of(const Resultant &load) const {
  const WholeSection &whole = scene_.whole_section();
  return {whole.size_of(load.force), whole.kind == WholeSection::Kind::model ? load.moment.norm() : 0.};
}

void Progress::make_columns() {
  const Capabilities &capabilities = scene_.capabilities();
  const auto add_energy = [this](const char *header, double EnergyLedger::*energy) {
    columns_.push_back({header, 15, [energy](const Solution &s) { return s.state().energies.*energy; }});
  };
  find_loads();
  if (capabilities.plasticity)
    add_energy("plastic work", &EnergyLedger::plastic);
  if (capabilities.friction)
    add_energy("friction work", &EnergyLedger::friction);
  add_probes();
}

void Progress::add_probes() {
  constexpr int min_width = 14;
  std::size_t place = 0;
  for (const auto &probe : scene_.parameters().probes)
    for (const std::string &column : probe.probe.columns()) {
      if (std::find(probe.console.begin(), probe.console.end(), column) != probe.console.end()) {
        const std::string name = probe.full_name(column);
        columns_.push_back(
            {name, std::max(min_width, static_cast<int>(name.size()) + 2), [this, place](const Solution &) {
               return place < probes_.size() ? probes_[place] : std::numeric_limits<double>::quiet_NaN();
             }});
      }
      ++place;
    }
}

void Progress::show_headers(const std::string &head, const Solution &solution) {
  constexpr unsigned int lines_between = 40;
  std::vector<ForceChoice::Load> sizes;
  for (const Load &load : loads_)
    sizes.push_back(size_of(load.value(solution)));
  if (choice_->update(sizes))
    n_lines_ = 0;
  if (n_lines_++ % lines_between != 0)
    return;
  stream_ << head;
  for (const ForceChoice::Shown &shown : choice_->shown())
    stream_ << std::setw(loads_[shown.load].width())
            << (shown.is_moment ? "|M| " : "|F| ") + loads_[shown.load].name;
  for (const Column &column : columns_)
    stream_ << std::setw(column.width) << column.header;
  stream_ << "\n";
}

void Progress::show_values(const Solution &solution) const {
  for (const ForceChoice::Shown &shown : choice_->shown()) {
    const ForceChoice::Load size = size_of(loads_[shown.load].value(solution));
    stream_ << std::setw(loads_[shown.load].width()) << (shown.is_moment ? size.moment : size.force);
  }
  for (const Column &column : columns_)
    stream_ << std::setw(column.width) << column.value(solution);
  stream_ << "\n";
}

void Progress::start(const Discretization &discretization, const Solution &solution) {
  if (verbosity_ == Verbosity::quiet)
    return;
  shows_linear_iterations_ = solution.solves_iteratively();
  // Moments may be about the origin: a force has one of no more than itself times this distance.
  choice_.emplace(loads_.size(), max_load_columns, discretization.centre().norm() + discretization.radius());
  if (!scene_.parameters().title.empty())
    stream_ << scene_.parameters().title << "\n";
  const parameters::Scene &parameters = scene_.parameters();
  if (!parameters.presets.empty()) {
    if (parameters.target_error > 0.)
      stream_ << "Target error " << parameters.print_target() << ":";
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
  const WholeSection &whole = scene_.whole_section();
  if (whole.kind == WholeSection::Kind::full_circle)
    stream_ << "Forces here are those of the full circle, along its axis: " << whole.factor
            << " times those of the wedge. In the scene forces are those of the wedge\n";
  if (whole.kind == WholeSection::Kind::per_width)
    stream_ << "Forces here are those per unit of width: " << whole.factor
            << " times those of the layer. In the scene forces are those of the layer\n";
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
  (severity == Severity::note ? stream_ : messages_) << text << std::endl;
}

void Progress::accept(const StepReport &report, const Solution &solution) {
  if (verbosity_ == Verbosity::quiet)
    return;
  erase_bar();
  if (verbosity_ == Verbosity::iterations)
    show_iterations(report.newton);
  show_headers("  step        time        step iter" +
                   std::string(shows_linear_iterations_ ? " linear" : "") + "   residual",
               solution);
  const double time = solution.state().time;
  stream_ << std::setw(6) << report.step << std::setw(12) << std::setprecision(6) << time << std::setw(12)
          << std::setprecision(4) << report.length << std::setw(5) << report.newton.iterations.size();
  if (shows_linear_iterations_)
    stream_ << std::setw(7) << report.newton.linear_iterations;
  stream_ << std::setw(11) << std::setprecision(2) << report.newton.force << std::setprecision(7);
  show_values(solution);
  show_advance(time, report.length);
  stream_ << std::flush;
}

void Progress::show(const unsigned int step, const double length, const Solution &solution) {
  if (verbosity_ == Verbosity::quiet)
    return;
  erase_bar();
  show_headers("    step        time        step       kinetic      external   drift", solution);
  const SolutionState &state = solution.state();
  const EnergyLedger &energies = state.energies;
  const double scale = std::max(energies.total(), std::abs(energies.initial));
  stream_ << std::setw(8) << step << std::setw(12) << std::setprecision(6) << state.time << std::setw(12)
          << std::setprecision(4) << length << std::setprecision(6) << std::setw(14) << energies.kinetic
          << std::setw(14) << energies.external << std::setw(8) << std::setprecision(1)
          << (scale > 0. ? energies.drift() / scale : 0.) << std::setprecision(6);
  show_values(solution);
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
  const double end = scene_.parameters().time_stepping.end_time, now = SpentTime::on_all();
  // A run that resumes has not spent its time on what was there.
  const double part = std::min(1., time / end), part_of_run = (time - *begin_) / (end - *begin_);
  std::string duration = format_duration(now);
  if (part_of_run > 0. && part < 1.)
    duration += ", about " + format_duration((now - start_) * (1. - part_of_run) / part_of_run) + " to go";
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
  std::ostream &stream = warnings.empty() ? stream_ : messages_;
  for (const auto &line : repetitions)
    stream << line << "\n";
  stream << "Completed in " << format_duration(SpentTime::on_all())
         << (warnings.empty() ? " without warnings." : " with " + warnings + ".");
  if (!file_to_open.empty())
    stream << " Open in ParaView: " << file_to_open;
  stream << std::endl;
}

} // namespace billet
