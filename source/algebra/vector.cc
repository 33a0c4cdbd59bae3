// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/algebra/vector.h"

#include <deal.II/base/mpi.h>

namespace billet {

Vector make_extended_vector(const dealii::IndexSet &owned, const unsigned int n_more, MPI_Comm communicator) {
  dealii::IndexSet extended(owned.size() + n_more);
  extended.add_indices(owned);
  if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
    extended.add_range(owned.size(), owned.size() + n_more);
  extended.compress();
  return Vector(extended, communicator);
}

} // namespace billet
