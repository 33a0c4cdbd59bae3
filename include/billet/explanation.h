// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_EXPLANATION_H
#define BILLET_EXPLANATION_H

#include <string>

namespace billet {

/// Appends sentences to a text without its last full stop; either may be empty.
inline void append_sentences(std::string &text, const std::string &more) {
  text += (text.empty() || more.empty() ? "" : ". ") + more;
}

/// Cause of a failure and what to do, the parts of a later Diagnostic.
struct Explanation {
  std::string what;   ///< clause without its full stop
  std::string advice; ///< sentences without the last full stop; may be empty

  bool empty() const { return what.empty(); }
  /// Appends a clause that begins with its own separator, and its advice.
  Explanation &operator+=(const Explanation &next) {
    what += next.what;
    append_sentences(advice, next.advice);
    return *this;
  }
};

} // namespace billet

#endif
