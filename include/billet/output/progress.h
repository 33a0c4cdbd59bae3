// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_PROGRESS_H
#define BILLET_OUTPUT_PROGRESS_H

#include "billet/diagnostics.h"
#include "billet/output/force_choice.h"
#include "billet/output/history_file.h"

#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace billet {

/// Console of a run, with a line for every step and the remaining time. That is a progress bar on a
/// terminal, else a line every half minute. First rank only.
class Progress {
public:
  /// Lines of steps go to `stream`, warnings to `messages`, which may be the same.
  Progress(const Scene &scene, std::ostream &stream, std::ostream &messages, bool is_terminal);
  Progress(const Progress &) = delete; // columns refer to it
  Progress &operator=(const Progress &) = delete;

  void start(const Discretization &discretization, const Solution &solution);
  /// Shows the estimated number of steps of an explicit scene, from the length of the first step.
  void show_number_of_steps(double n_steps, double step);
  /// Shows a step of an explicit scene for which a line of the history is due.
  void show(unsigned int step, double length, const Solution &solution);
  /// Shows a warning at any verbosity, a note unless the verbosity is quiet.
  void show_diagnostic(Severity severity, const std::string &text);
  /// Sets the values of probe_columns() for the next line.
  void set_probes(const std::vector<double> &values) { probes_ = values; }
  void accept(const StepReport &report, const Solution &solution);
  void reject(const StepReport &report, double from, double to);
  /// Shows wall-clock and CPU time of the steps of an explicit scene, without output.
  void show_pace(unsigned int n_steps, std::size_t n_elements, double seconds, double processor_seconds);
  /// Shows the last lines: counts of repeated messages, the number of warnings (in words, or
  /// empty), and the file to open.
  void finish(const std::vector<std::string> &repetitions, const std::string &warnings,
              const std::string &file_to_open);

private:
  /// Number of a line that depends on what the scene has.
  struct Column {
    std::string header;
    int width;
    std::function<double(const Solution &)> value;
  };
  /// Force and moment for whose sizes there is a column if it is among the largest.
  struct Load {
    std::string name;
    std::function<Resultant(const Solution &)> value;

    int width() const; ///< of its column
  };
  void find_loads();
  void make_columns();
  void add_probes();
  /// Returns the sizes of a load, in the whole of a section; no moment there.
  ForceChoice::Load size_of(const Resultant &load) const;
  /// Shows the headers where they are due: after 40 lines, or where other loads are the largest
  /// now. `head`: that of the columns before.
  void show_headers(const std::string &head, const Solution &solution);
  void show_values(const Solution &solution) const;
  void show_iterations(const NewtonReport &newton);
  /// Shows how far the run is after a step of this length, and the time to go.
  void show_advance(double time, double length);
  void show_bar(double part, const std::string &duration);
  void erase_bar();

  const Scene &scene_;
  std::ostream &stream_, &messages_;
  bool is_terminal_;
  bool has_bar_ = false;
  bool shows_linear_iterations_ = false;
  unsigned int n_lines_ = 0;
  std::optional<double> begin_; ///< time before the first step shown
  double last_line_ = 0.;       ///< when the last line of progress was shown [s]
  std::vector<Load> loads_;
  std::optional<ForceChoice> choice_; ///< of the loads; set at the start
  std::vector<Column> columns_;       ///< behind those of the loads
  std::vector<double> probes_;
  parameters::Output::Verbosity verbosity_;
  double start_; ///< when the run began, after the program [s]
};

} // namespace billet

#endif
