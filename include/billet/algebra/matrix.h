// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_ALGEBRA_MATRIX_H
#define BILLET_ALGEBRA_MATRIX_H

#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <cstddef>

namespace billet {

/// Sparse matrix whose rows are distributed like the entries of a vector, and its pattern.
using Matrix = dealii::TrilinosWrappers::SparseMatrix;
using SparsityPattern = dealii::TrilinosWrappers::SparsityPattern;

/// Returns the number of entries in the rows of this rank.
std::size_t count_owned_entries(const Matrix &matrix);

} // namespace billet

#endif
