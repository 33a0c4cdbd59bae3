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

/// Whether the method solves with symmetric matrices only.
inline bool requires_symmetry(const LinearMethod method) {
  return method == LinearMethod(DirectMethod::mumps_symmetric) ||
         method == LinearMethod(IterativeMethod::conjugate_gradients);
}

} // namespace billet

#endif
