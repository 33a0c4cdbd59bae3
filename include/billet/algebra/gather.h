// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_ALGEBRA_GATHER_H
#define BILLET_ALGEBRA_GATHER_H

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <numeric>
#include <vector>

namespace billet {

/// Returns the objects of all ranks, in the order of these. deal.II's function of this name
/// compresses each object, also on a single rank. That takes far longer than to send it.
/// Collective.
template <class Object> std::vector<Object> all_gather(const MPI_Comm communicator, const Object &own) {
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(communicator);
  if (n_ranks == 1)
    return std::vector<Object>(1, own);
  constexpr bool compressed = false;
  const std::vector<char> packed = dealii::Utilities::pack(own, compressed);
  const int size = static_cast<int>(packed.size());
  std::vector<int> sizes(n_ranks), begins(n_ranks + 1, 0);
  MPI_Allgather(&size, 1, MPI_INT, sizes.data(), 1, MPI_INT, communicator);
  std::partial_sum(sizes.begin(), sizes.end(), begins.begin() + 1);
  std::vector<char> all(static_cast<std::size_t>(begins.back()));
  MPI_Allgatherv(packed.data(), size, MPI_CHAR, all.data(), sizes.data(), begins.data(), MPI_CHAR,
                 communicator);
  std::vector<Object> objects;
  for (unsigned int rank = 0; rank < n_ranks; ++rank)
    objects.push_back(dealii::Utilities::unpack<Object>(all.cbegin() + begins[rank],
                                                        all.cbegin() + begins[rank + 1], compressed));
  return objects;
}

/// Returns the items of all ranks, in the order of these. Collective.
template <class Item>
std::vector<Item> gather_all(const MPI_Comm communicator, const std::vector<Item> &own) {
  std::vector<Item> all;
  for (const auto &of_rank : all_gather(communicator, own))
    all.insert(all.end(), of_rank.begin(), of_rank.end());
  return all;
}

} // namespace billet

#endif
