// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/subroutine_messages.h"

#include <algorithm>
#include <utility>

namespace billet {

namespace {

/// Subroutines have no argument for an object that could hold their messages.
std::vector<SubroutineMessage> &kept() {
  static std::vector<SubroutineMessage> messages;
  return messages;
}

} // namespace

void keep_subroutine_message(const int level, const std::string &format, const std::string &text) {
  const auto found = std::find_if(kept().begin(), kept().end(), [&](const SubroutineMessage &message) {
    return message.level == level && message.format == format;
  });
  if (found == kept().end())
    kept().push_back({level, format, text});
  else
    ++found->n;
}

std::vector<SubroutineMessage> take_subroutine_messages() { return std::exchange(kept(), {}); }

} // namespace billet
