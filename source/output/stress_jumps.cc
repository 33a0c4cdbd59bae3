// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/stress_jumps.h"

#include <array>
#include <cmath>

namespace billet {

double stress_jumps(const Solution &solution, const Discretization &discretization) {
  // Six components times the volume, and the volume, in the dofs of three vectors.
  constexpr unsigned int n_components = 6, n_vectors = 3;
  std::array<Vector, n_vectors> sums, ghosted;
  for (auto &sum : sums)
    sum = discretization.make_additive_vector();
  std::vector<std::vector<ElementSummary>> summaries;
  for (std::size_t body = 0; body < discretization.n_bodies(); ++body) {
    summaries.push_back(solution.summarize(body));
    const auto &elements = discretization.elements(body);
    for (std::size_t e = 0; e < elements.size(); ++e) {
      const double volume = elements[e].cell->measure();
      for (unsigned int a = 0; a < n_element_nodes; ++a)
        for (unsigned int c = 0; c <= n_components; ++c)
          sums[c / 3](elements[e].dofs[3 * a + c % 3]) +=
              volume * (c < n_components ? summaries[body][e].cauchy_stress.access_raw_entry(c) : 1.);
    }
  }
  for (unsigned int i = 0; i < n_vectors; ++i) {
    sums[i].compress(dealii::VectorOperation::add);
    Vector owned = discretization.make_owned_vector();
    owned = sums[i];
    ghosted[i] = discretization.make_ghosted_vector();
    ghosted[i] = owned;
  }
  std::array<double, 2> integrals{}; // of jumps, of stresses
  for (std::size_t body = 0; body < discretization.n_bodies(); ++body) {
    const auto &elements = discretization.elements(body);
    for (std::size_t e = 0; e < elements.size(); ++e) {
      dealii::SymmetricTensor<2, 3> smooth;
      for (unsigned int a = 0; a < n_element_nodes; ++a) {
        const auto value = [&](const unsigned int c) {
          return ghosted[c / 3](elements[e].dofs[3 * a + c % 3]);
        };
        for (unsigned int c = 0; c < n_components; ++c)
          smooth.access_raw_entry(c) += value(c) / value(n_components) / n_element_nodes;
      }
      const auto &stress = summaries[body][e].cauchy_stress;
      const double volume = elements[e].cell->measure();
      integrals[0] += volume * (stress - smooth) * (stress - smooth);
      integrals[1] += volume * (stress * stress);
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, integrals.data(), 2, MPI_DOUBLE, MPI_SUM, discretization.communicator());
  return integrals[1] > 0. ? std::sqrt(integrals[0] / integrals[1]) : 0.;
}

} // namespace billet
