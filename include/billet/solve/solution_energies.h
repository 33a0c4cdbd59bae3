// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_SOLUTION_ENERGIES_H
#define BILLET_SOLVE_SOLUTION_ENERGIES_H

#include "billet/solve/solution.h"

#include <vector>

namespace billet {

/// Returns ½ Σ p g A of each pair [energy]. Collective; the same on all ranks.
std::vector<double> energies_of_penetration(const std::vector<std::vector<ContactNodeReport>> &reports,
                                            MPI_Comm communicator);

/// Returns the energy in the elements of each of these bodies [energy]: stored, and dissipated by
/// yielding. Collective; the same on all ranks.
std::vector<double> energies_of_bodies(const Solution &solution, const std::vector<std::size_t> &bodies,
                                       MPI_Comm communicator);

} // namespace billet

#endif
