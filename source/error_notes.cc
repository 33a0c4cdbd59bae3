// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/error_notes.h"

#include <algorithm>

namespace billet {

void ErrorNotes::add(const DiagnosticList &errors) {
  for (const Diagnostic &error : errors)
    if (std::none_of(errors_.begin(), errors_.end(),
                     [&](const Diagnostic &noted) { return noted.text() == error.text(); }))
      errors_.push_back(error);
}

const Diagnostic *ErrorNotes::find(const std::string &text) const {
  for (const Diagnostic &error : errors_)
    if (error.what().find(text) != std::string::npos)
      return &error;
  return nullptr;
}

void ErrorNotes::require_none() const {
  if (!errors_.empty())
    throw InputError(errors_);
}

} // namespace billet
