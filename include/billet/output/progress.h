// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_PROGRESS_H
#define BILLET_OUTPUT_PROGRESS_H

#include "billet/diagnostics.h"
#include "billet/output/history_file.h"

#include <chrono>
#include <iosfwd>

namespace billet {

/// The console of a run: a line for every step, and on a terminal a bar with the time to go. First rank only.
class Progress {
public:
  Progress(const Scene &scene, std::ostream &stream, bool is_terminal);

  void start(const Discretization &discretization, const Solution &solution);
  /// Of an explicit scene, once its first step is known: how many there will be, if they stay as long.
  void show_number_of_steps(double n_steps, double step);
  /// Of an explicit scene, where a line of the history is due.
  void show(unsigned int step, double length, const SolutionState &state);
  /// A warning, whatever the verbosity; a note unless that is quiet.
  void show_diagnostic(Severity severity, const std::string &text);
  void accept(const StepReport &report, const SolutionState &state);
  void reject(const StepReport &report, double from, double to);
  /// Of an explicit scene, at its end: how long its steps took without output, by the clock and of the
  /// processor.
  void show_pace(unsigned int n_steps, std::size_t n_elements, double seconds, double processor_seconds);
  /// The last lines: how often messages were repeated, how many warnings there were (in words, or empty), and
  /// what to open.
  void finish(const std::vector<std::string> &repetitions, const std::string &warnings,
              const std::string &file_to_open);

private:
  void show_iterations(const NewtonReport &newton);
  void show_bar(double time);
  void erase_bar();
  double elapsed() const;

  const Scene &scene_;
  std::ostream &stream_;
  bool is_terminal_;
  bool has_bar_ = false;
  bool shows_linear_iterations_ = false;
  unsigned int n_lines_ = 0;
  parameters::Output::Verbosity verbosity_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

} // namespace billet

#endif
