// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/nearest_name.h"

#include <algorithm>
#include <cctype>

namespace billet {

namespace {

std::string in_lower_case(const std::string &text) {
  std::string result = text;
  for (char &c : result)
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

/// Returns how many letters of `a` must be inserted, removed, replaced, or exchanged with their
/// neighbours to get `b` (optimal string alignment).
std::size_t edit_distance(const std::string &a, const std::string &b) {
  std::vector<std::size_t> before, above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j)
    above[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] == b[j - 1] ? 0U : 1U)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before = above;
    above = row;
  }
  return above.back();
}

/// Returns the one known name that begins with `start`; "" if none or several do.
std::string only_continuation(const std::string &start, const std::vector<std::string> &known) {
  constexpr std::size_t min_letters = 3;
  std::string found;
  if (start.size() < min_letters)
    return found;
  for (const auto &candidate : known)
    if (in_lower_case(candidate).compare(0, start.size(), start) == 0) {
      if (!found.empty())
        return "";
      found = candidate;
    }
  return found;
}

} // namespace

std::string nearest_name(const std::string &name, const std::vector<std::string> &known) {
  // Longer text is no name, and the distance costs its square.
  constexpr std::size_t max_letters = 200;
  if (name.empty() || name.size() > max_letters)
    return "";
  const std::string wanted = in_lower_case(name);
  std::string nearest;
  std::size_t least = 0;
  for (const auto &candidate : known) {
    const std::size_t distance = edit_distance(wanted, in_lower_case(candidate));
    if (3 * distance <= std::max<std::size_t>(name.size(), 3) && distance < candidate.size() &&
        (nearest.empty() || distance < least)) {
      nearest = candidate;
      least = distance;
    }
  }
  // "implicit" means "implicit dynamics" rather than "explicit".
  const std::string continuation = least < 2 && !nearest.empty() ? "" : only_continuation(wanted, known);
  return nearest.empty() || !continuation.empty() ? continuation : nearest;
}

std::string did_you_mean(const std::string &name, const std::vector<std::string> &known) {
  const std::string nearest = nearest_name(name, known);
  return nearest.empty() ? "" : "; did you mean '" + nearest + "'?";
}

} // namespace billet
