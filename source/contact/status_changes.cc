// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/status_changes.h"

#include <algorithm>

namespace billet {

void StatusChanges::add(const std::vector<SlaveForce> &before, const std::vector<SlaveForce> &after) {
  for (std::size_t i = 0; i < after.size(); ++i) {
    contact_force += after[i].force.norm();
    if (before[i].status == after[i].status)
      continue;
    n += 1.;
    force += (after[i].force - before[i].force).norm();
  }
}

double StatusChanges::part() const {
  return force > 0. ? std::min(1., force / std::max(force, contact_force)) : 0.;
}

} // namespace billet
