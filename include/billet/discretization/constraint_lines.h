// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DISCRETIZATION_CONSTRAINT_LINES_H
#define BILLET_DISCRETIZATION_CONSTRAINT_LINES_H

#include "billet/discretization/discretization.h"

#include <deal.II/lac/affine_constraints.h>

#include <utility>
#include <vector>

namespace billet {

using Constraints = dealii::AffineConstraints<double>;

/// A linear constraint u_dof = Σ factor u_other + value, but for its value.
struct ConstraintLine {
  DofIndex dof;
  std::vector<std::pair<DofIndex, double>> others;
};

/// Constraints of one origin, such as supports or hanging nodes.
struct ConstraintSource {
  const std::vector<ConstraintLine> &lines;
  std::vector<double> values{}; ///< of the lines; none: all are 0 [length]
};

/// Returns the closed constraints of all sources. Where several sources constrain one dof the first one
/// counts. A line may depend on dofs that other lines constrain.
Constraints build_constraints(const dealii::IndexSet &owned, const dealii::IndexSet &relevant,
                              const std::vector<ConstraintSource> &sources);

/// Returns the constraints that keep displacements continuous where a face has a refined neighbour, of all
/// relevant dofs; none on a mesh without hanging nodes.
std::vector<ConstraintLine> collect_hanging_nodes(const dealii::DoFHandler<3> &dof_handler,
                                                  const dealii::IndexSet &relevant);

/// Returns whether constraints of any rank name dofs that another rank owns. Collective.
bool couple_ranks(const Constraints &constraints, const dealii::IndexSet &owned, MPI_Comm communicator);

/// Folds forces on constrained dofs into those that they depend on, and empties them: the transpose of
/// Constraints::distribute() without values. `forces` has owned entries. Collective if the constraints couple
/// ranks.
void condense(const Constraints &constraints, bool couples_ranks, Vector &forces);

} // namespace billet

#endif
