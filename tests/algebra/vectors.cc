// SPDX-License-Identifier: LGPL-2.1-or-later
// Vectors with entries behind those of all ranks, which the first rank owns; entries of a matrix by rank.
#include "../testing.h"
#include "billet/algebra/matrix.h"
#include "billet/algebra/vector.h"

#include <deal.II/base/mpi.h>

#include <sstream>

namespace vectors_test {

using namespace billet;
using billet::testing::check;
using dealii::Utilities::MPI::sum;

BILLET_MPI_TEST(vectors) {
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD),
                     n_ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  std::ostringstream silence;
  std::streambuf *const console = std::cout.rdbuf();
  if (rank != 0)
    std::cout.rdbuf(silence.rdbuf());

  constexpr unsigned int n_each = 3;
  dealii::IndexSet owned(n_each * n_ranks);
  owned.add_range(rank * n_each, (rank + 1) * n_each);
  for (const unsigned int n_more : {0u, 2u}) {
    const std::string name = std::to_string(n_more) + " more";
    Vector vector = make_extended_vector(owned, n_more, MPI_COMM_WORLD);
    check(name + ": all are there, and zero",
          vector.size() == n_each * n_ranks + n_more && vector.l2_norm() == 0.);
    const auto values = owned_values(vector);
    const unsigned int n_wrong = values.size() == n_each + (rank == 0 ? n_more : 0) ? 0 : 1;
    check(name + ": the first rank owns them", sum(n_wrong, MPI_COMM_WORLD) == 0);
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = i < n_each ? rank * n_each + i : n_ranks * n_each + i - n_each;
    unsigned int n_misplaced = 0;
    for (const auto i : vector.locally_owned_elements())
      n_misplaced += vector(i) == i ? 0 : 1;
    check(name + ": behind its others", sum(n_misplaced, MPI_COMM_WORLD) == 0);
    Vector copy = vector;
    copy -= vector;
    check(name + ": it can be computed with", copy.l2_norm() == 0. && vector.l2_norm() > 0.);
  }

  Matrix matrix(owned, MPI_COMM_WORLD, 2);
  for (const auto row : owned) {
    matrix.set(row, row, 1.);
    if (row > 0)
      matrix.set(row, row - 1, 1.);
  }
  matrix.compress(dealii::VectorOperation::insert);
  const unsigned int n_wrong = count_owned_entries(matrix) == 2 * n_each - (rank == 0 ? 1 : 0) ? 0 : 1;
  check("entries of a matrix are counted by rank", sum(n_wrong, MPI_COMM_WORLD) == 0);
  std::cout.rdbuf(console); // `silence` goes first
}

} // namespace vectors_test
