// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/restless_nodes.h"

#include <algorithm>
#include <utility>

namespace billet {

void RestlessNodes::restart() {
  std::fill(n_changes_.begin(), n_changes_.end(), 0U);
  states_.clear();
}

void RestlessNodes::count(std::vector<std::uint64_t> states) {
  n_changes_.resize(states.size());
  if (!states_.empty())
    for (std::size_t i = 0; i < states.size(); ++i)
      if (states[i] != states_[i])
        ++n_changes_[i];
  states_ = std::move(states);
}

} // namespace billet
