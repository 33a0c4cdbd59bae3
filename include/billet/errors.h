// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_ERRORS_H
#define BILLET_ERRORS_H

#include "billet/diagnostics.h"

#include <mpi.h>

#include <exception>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>

namespace billet {

/// What the program returns to the shell.
enum class ExitCode : int {
  success = 0,
  bad_input = 2,       ///< the scene file or the command line; nothing was written
  failed_solution = 3, ///< the scene is sound, the solution stopped; what was computed is on disk
  internal_error = 4,  ///< a defect of the program or of the machine
  stopped = 5,         ///< by a signal; a checkpoint says how to resume
  warnings = 6,        ///< the run came to its end with warnings, and the scene says 'Warnings = errors'
  target_missed = 7    ///< the run came to its end, and its estimated error exceeds the 'Target error'
};

/// The user's input cannot be used. The message says where, what was found and what is allowed.
/// Thrown on all ranks or on none.
class InputError : public std::runtime_error {
public:
  explicit InputError(const std::string &message);
  InputError(const DiagnosticKind &kind, const std::string &message)
      : InputError(Diagnostic(kind, message)) {}
  explicit InputError(Diagnostic diagnostic)
      : std::runtime_error(diagnostic.what()), diagnostic_(std::move(diagnostic)) {}
  const Diagnostic &diagnostic() const { return diagnostic_; }

private:
  Diagnostic diagnostic_;
};

/// The computation cannot go on. The message says when, why and what to try. Thrown on all ranks or on none.
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

/// Calls `action` on every rank; if it throws on any of them, every rank throws: the same InputError or
/// SolutionFailure where that was its kind, std::runtime_error else. `action` itself must not communicate.
void fail_together(MPI_Comm communicator, const std::function<void()> &action);

/// Calls `action` while nothing has begun yet: what would fail the solution later is bad input now.
void check_before_start(const std::function<void()> &action);

} // namespace billet

#endif
