// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_ALGEBRA_LINEAR_METHOD_H
#define BILLET_ALGEBRA_LINEAR_METHOD_H

#include <variant>

namespace billet {

enum class DirectMethod {
  mumps_symmetric, ///< LDLᵀ of the matrix's upper triangle
  mumps,           ///< LU
  klu              ///< LU on the first rank
};

enum class IterativeMethod { conjugate_gradients, gmres };

/// Method of a linear solver.
using LinearMethod = std::variant<DirectMethod, IterativeMethod>;

/// Returns the name in scene files and messages.
const char *name_of(DirectMethod method);
const char *name_of(IterativeMethod method);

/// Whether the method solves with symmetric matrices only.
bool requires_symmetry(DirectMethod method);
bool requires_symmetry(IterativeMethod method);
bool requires_symmetry(const LinearMethod &method);

} // namespace billet

#endif
