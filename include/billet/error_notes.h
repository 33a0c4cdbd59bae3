// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_ERROR_NOTES_H
#define BILLET_ERROR_NOTES_H

#include "billet/errors.h"

namespace billet {

/// Errors of several parts of the input, all of which are found before any is thrown.
class ErrorNotes {
public:
  /// Calls `read` and notes its errors. Returns whether it had none.
  template <class Function> bool note(const Function &read) {
    try {
      read();
      return true;
    } catch (const InputError &error) {
      add(error.diagnostics());
      return false;
    }
  }
  /// Adds those that are not noted yet: subsections that take the same value repeat its error.
  void add(const DiagnosticList &errors);
  /// Returns the first error that contains this text; null if there is none.
  const Diagnostic *find(const std::string &text) const;
  bool is_empty() const { return errors_.empty(); }
  /// Throws InputError with all errors, if there are any.
  void require_none() const;

private:
  DiagnosticList errors_;
};

} // namespace billet

#endif
