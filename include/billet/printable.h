// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PRINTABLE_H
#define BILLET_PRINTABLE_H

#include <cstddef>
#include <string>
#include <string_view>

namespace billet {

/// Returns what a file has for a message: its first characters, without what a terminal would take
/// for a command, and "..." if there are more.
inline std::string printable(const std::string_view text, const std::size_t max_length) {
  std::string result(text.substr(0, max_length));
  for (char &c : result)
    c = c >= ' ' && c <= '~' ? c : '?';
  return text.size() > max_length ? result + "..." : result;
}

} // namespace billet

#endif
