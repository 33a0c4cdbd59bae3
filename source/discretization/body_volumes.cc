// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/discretization/body_volumes.h"

#include <deal.II/base/mpi.h>

namespace billet {

std::vector<double> measure_body_volumes(const Discretization &discretization) {
  std::vector<double> volumes(discretization.n_bodies());
  for (std::size_t body = 0; body < volumes.size(); ++body)
    for (const auto &element : discretization.elements(body))
      volumes[body] += element.cell->measure();
  dealii::Utilities::MPI::sum(volumes, discretization.communicator(), volumes);
  return volumes;
}

} // namespace billet
