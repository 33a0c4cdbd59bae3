// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/solution_energies.h"

#include <deal.II/base/mpi.h>

namespace billet {

std::vector<double> energies_of_penetration(const std::vector<std::vector<ContactNodeReport>> &reports,
                                            const MPI_Comm communicator) {
  std::vector<double> energies;
  for (const auto &of_pair : reports) {
    energies.push_back(0.);
    for (const auto &node : of_pair)
      energies.back() += 0.5 * node.pressure * node.penetration * node.area;
  }
  dealii::Utilities::MPI::sum(energies, communicator, energies);
  return energies;
}

std::vector<double> energies_of_bodies(const Solution &solution, const std::vector<std::size_t> &bodies,
                                       const MPI_Comm communicator) {
  std::vector<double> energies;
  for (const std::size_t body : bodies) {
    energies.push_back(0.);
    for (const ElementSummary &element : solution.summarize(body))
      energies.back() += element.elastic_energy + element.plastic_work + element.hourglass_energy;
  }
  dealii::Utilities::MPI::sum(energies, communicator, energies);
  return energies;
}

} // namespace billet
