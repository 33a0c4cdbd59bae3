// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/contact_load.h"

#include <deal.II/base/array_view.h>

#include <algorithm>

namespace billet {

ContactLoad &ContactLoad::operator+=(const ContactLoad &other) {
  force += other.force;
  moment += other.moment;
  area += other.area;
  stored_energy += other.stored_energy;
  dissipation += other.dissipation;
  damping += other.damping;
  deepest = std::max(deepest, other.deepest);
  return *this;
}

ContactLoad sum_over_ranks(const ContactLoad &local, MPI_Comm communicator) {
  const std::array<double, 10> sums{local.force[0],    local.force[1],  local.force[2], local.moment[0],
                                    local.moment[1],   local.moment[2], local.area,     local.stored_energy,
                                    local.dissipation, local.damping};
  std::array<double, 10> totals{};
  dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(sums.data(), sums.size()), communicator,
                              dealii::ArrayView<double>(totals.data(), totals.size()));
  ContactLoad load;
  for (unsigned int i = 0; i < 3; ++i) {
    load.force[i] = totals[i];
    load.moment[i] = totals[3 + i];
  }
  load.area = totals[6];
  load.stored_energy = totals[7];
  load.dissipation = totals[8];
  load.damping = totals[9];
  load.deepest = dealii::Utilities::MPI::max(local.deepest, communicator);
  return load;
}

} // namespace billet
