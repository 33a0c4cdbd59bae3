// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/errors.h"

#include "billet/diagnostic_kinds.h"

#include <utility>

namespace billet {

InputError::InputError(const std::string &message) : InputError(diagnostic::bad_input, message) {}

SolutionFailure::SolutionFailure(const std::string &message)
    : SolutionFailure(diagnostic::solution_failed, message) {}

SolutionFailure file_lost(const std::string &name) {
  return SolutionFailure(Diagnostic(diagnostic::solution_failed, name + " cannot be written")
                             .advice("Check whether the disk is full"));
}

void check_before_start(const std::function<void()> &action) {
  try {
    action();
  } catch (const SolutionFailure &error) {
    Diagnostic diagnostic = error.diagnostic();
    if (&diagnostic.kind() == &diagnostic::solution_failed)
      diagnostic.change_kind(diagnostic::bad_input);
    throw InputError(std::move(diagnostic));
  }
}

} // namespace billet
