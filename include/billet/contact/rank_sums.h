// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_RANK_SUMS_H
#define BILLET_CONTACT_RANK_SUMS_H

#include <deal.II/base/tensor.h>

#include <mpi.h>

#include <vector>

namespace billet {

/// Fields of a contact's load, each of which all ranks have a part of.
struct RankParts {
  std::vector<double *> sums;
  std::vector<dealii::Tensor<1, 3> *> vectors; ///< summed, too
  std::vector<double *> maxima;

  /// Replaces the parts by their sums and maxima over all ranks.
  void reduce(MPI_Comm communicator) const;
};

/// Whether a contact presses anywhere, on any rank, both at the start of the step and now.
bool presses_at_both_ends(bool pressed, bool presses, MPI_Comm communicator);

} // namespace billet

#endif
