// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_ALGEBRA_GATHER_H
#define BILLET_ALGEBRA_GATHER_H

#include <deal.II/base/mpi.h>

#include <vector>

namespace billet {

/// Returns the items of all ranks, in the order of these. Collective.
template <class Item>
std::vector<Item> gather_all(const MPI_Comm communicator, const std::vector<Item> &own) {
  std::vector<Item> all;
  for (const auto &of_rank : dealii::Utilities::MPI::all_gather(communicator, own))
    all.insert(all.end(), of_rank.begin(), of_rank.end());
  return all;
}

} // namespace billet

#endif
