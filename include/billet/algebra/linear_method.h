// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_ALGEBRA_LINEAR_METHOD_H
#define BILLET_ALGEBRA_LINEAR_METHOD_H

#include <string>
#include <variant>
#include <vector>

namespace billet {

enum class DirectMethod {
  mumps_symmetric, ///< LDLᵀ of the matrix's upper triangle
  mumps,           ///< LU
  klu              ///< LU on the first rank
};

enum class IterativeMethod { conjugate_gradients, gmres };

/// Method of a linear solver.
using LinearMethod = std::variant<DirectMethod, IterativeMethod>;

/// Returns all methods, in the order of the documentation.
const std::vector<LinearMethod> &all_linear_methods();

/// Returns the method of its kind that is chosen by default for such matrices.
DirectMethod default_direct_method(bool symmetric);
IterativeMethod default_iterative_method(bool symmetric);

/// Returns the name in scene files and messages.
const char *name_of(DirectMethod method);
const char *name_of(IterativeMethod method);
const char *name_of(const LinearMethod &method);

/// Returns the method in words, for the summary of a scene.
std::string describe(const LinearMethod &method);

/// Whether the method solves with symmetric matrices only.
bool requires_symmetry(DirectMethod method);
bool requires_symmetry(IterativeMethod method);
bool requires_symmetry(const LinearMethod &method);

} // namespace billet

#endif
