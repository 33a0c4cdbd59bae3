// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/contact_load.h"

#include "billet/contact/rank_sums.h"

#include <algorithm>

namespace billet {

ContactLoad &ContactLoad::operator+=(const ContactLoad &other) {
  force += other.force;
  moment += other.moment;
  area += other.area;
  stored_energy += other.stored_energy;
  dissipation += other.dissipation;
  damping += other.damping;
  ramp_work += other.ramp_work;
  deepest = std::max(deepest, other.deepest);
  return *this;
}

ContactLoad sum_over_ranks(const ContactLoad &local, MPI_Comm communicator) {
  ContactLoad load = local;
  RankParts{{&load.area, &load.stored_energy, &load.dissipation, &load.damping, &load.ramp_work},
            {&load.force, &load.moment},
            {&load.deepest}}
      .reduce(communicator);
  return load;
}

} // namespace billet
