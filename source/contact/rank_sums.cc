// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/rank_sums.h"

#include <deal.II/base/mpi.h>

namespace billet {

void RankParts::reduce(MPI_Comm communicator) const {
  std::vector<double> values, deepest;
  for (const double *sum : sums)
    values.push_back(*sum);
  for (const dealii::Tensor<1, 3> *vector : vectors)
    values.insert(values.end(), {(*vector)[0], (*vector)[1], (*vector)[2]});
  for (const double *maximum : maxima)
    deepest.push_back(*maximum);
  dealii::Utilities::MPI::sum(values, communicator, values);
  dealii::Utilities::MPI::max(deepest, communicator, deepest);
  auto value = values.begin();
  for (double *sum : sums)
    *sum = *value++;
  for (dealii::Tensor<1, 3> *vector : vectors)
    for (unsigned int i = 0; i < 3; ++i)
      (*vector)[i] = *value++;
  for (std::size_t i = 0; i < maxima.size(); ++i)
    *maxima[i] = deepest[i];
}

bool presses_at_both_ends(const bool pressed, const bool presses, MPI_Comm communicator) {
  std::vector<int> ends{pressed ? 1 : 0, presses ? 1 : 0};
  dealii::Utilities::MPI::max(ends, communicator, ends);
  return ends[0] + ends[1] == 2;
}

} // namespace billet
