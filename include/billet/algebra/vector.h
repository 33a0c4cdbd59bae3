// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_ALGEBRA_VECTOR_H
#define BILLET_ALGEBRA_VECTOR_H

#include <deal.II/base/array_view.h>
#include <deal.II/base/index_set.h>
#include <deal.II/lac/trilinos_vector.h>

namespace billet {

/// Vector that is distributed over the ranks. Beside the entries that a rank owns it may have
/// ghosts to read from, or entries of other ranks to add to.
using Vector = dealii::TrilinosWrappers::MPI::Vector;

/// Returns the entries that this rank owns, by ascending index, of a vector without ghosts. Local
/// to this rank.
inline dealii::ArrayView<double> owned_values(Vector &vector) {
  return {vector.begin(), static_cast<std::size_t>(vector.locally_owned_size())};
}
inline dealii::ArrayView<const double> owned_values(const Vector &vector) {
  return {vector.begin(), static_cast<std::size_t>(vector.locally_owned_size())};
}

/// Returns a vector of zeros for the entries `owned` and, behind those of all ranks, `n_more`
/// entries, which the first rank owns. Collective.
Vector make_extended_vector(const dealii::IndexSet &owned, unsigned int n_more, MPI_Comm communicator);

} // namespace billet

#endif
