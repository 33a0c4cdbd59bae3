// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_ERRORS_H
#define BILLET_ERRORS_H

#include "billet/diagnostics.h"

#include <exception>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>

namespace billet {

/// Exit code of the program.
enum class ExitCode : int {
  success = 0,
  bad_input = 2,       ///< scene file or command line are unusable; nothing was written
  failed_solution = 3, ///< the scene is valid, the solution failed; computed results are on disk
  internal_error = 4,  ///< a defect of the program or of the machine
  stopped = 5,         ///< by a signal; the run can resume from a checkpoint
  warnings = 6,        ///< the run completed with warnings, and the scene says 'Warnings = errors'
  target_missed = 7    ///< the run completed, and its estimated error exceeds the 'Target error'
};

/// Error for input that cannot be used. The message names the place, the value found and the
/// allowed values. Thrown on all ranks or on none.
class InputError : public std::runtime_error {
public:
  explicit InputError(const std::string &message);
  InputError(const DiagnosticKind &kind, const std::string &message)
      : InputError(Diagnostic(kind, message)) {}
  explicit InputError(Diagnostic diagnostic) : InputError(DiagnosticList{std::move(diagnostic)}) {}
  /// Makes one error of several, at least one.
  explicit InputError(DiagnosticList diagnostics)
      : std::runtime_error(diagnostics.front().what()), diagnostics_(std::move(diagnostics)) {}
  /// Returns the first error.
  const Diagnostic &diagnostic() const { return diagnostics_.front(); }
  const DiagnosticList &diagnostics() const { return diagnostics_; }

private:
  DiagnosticList diagnostics_;
};

/// Error for a computation that cannot continue. The message names the time, the cause and possible
/// remedies. Thrown on all ranks or on none.
class SolutionFailure : public std::runtime_error {
public:
  explicit SolutionFailure(const std::string &message);
  SolutionFailure(const DiagnosticKind &kind, const std::string &message)
      : SolutionFailure(Diagnostic(kind, message)) {}
  explicit SolutionFailure(Diagnostic diagnostic)
      : std::runtime_error(diagnostic.what()), diagnostic_(std::move(diagnostic)) {}
  const Diagnostic &diagnostic() const { return diagnostic_; }

private:
  Diagnostic diagnostic_;
};

/// Returns the failure of a run that cannot write a file of its results.
SolutionFailure file_lost(const std::string &name);

/// Calls `action` before the run starts: rethrows a SolutionFailure as InputError with the same
/// diagnostic. Its kind becomes 'bad-input' if it was the general 'solution-failed'.
void check_before_start(const std::function<void()> &action);

} // namespace billet

#endif
