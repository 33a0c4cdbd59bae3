// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DISCRETIZATION_CONSTRAINT_LINES_H
#define BILLET_DISCRETIZATION_CONSTRAINT_LINES_H

#include "billet/discretization/discretization.h"

#include <deal.II/lac/affine_constraints.h>

#include <utility>
#include <vector>

namespace billet {

using Constraints = dealii::AffineConstraints<double>;

/// Linear constraint u_dof = Σ factor u_other + value, without its value.
struct ConstraintLine {
  DofIndex dof;
  std::vector<std::pair<DofIndex, double>> others;
};

/// Constraints of one origin, such as supports or hanging nodes.
struct ConstraintSource {
  const std::vector<ConstraintLine> &lines;
  std::vector<double> values{}; ///< of the lines; empty: all are 0 [length]
};

/// Returns the closed constraints of all sources. If several sources constrain a dof, the first one
/// applies. A line may depend on dofs that other lines constrain.
Constraints build_constraints(const dealii::IndexSet &owned, const dealii::IndexSet &relevant,
                              const std::vector<ConstraintSource> &sources);

/// Returns the constraints of all relevant dofs that keep displacements continuous at faces with a
/// refined neighbour; none on a mesh without hanging nodes.
std::vector<ConstraintLine> collect_hanging_nodes(const dealii::DoFHandler<3> &dof_handler,
                                                  const dealii::IndexSet &relevant);

/// Returns all lines that make relevant dofs depend on other nodes: those of hanging nodes. A new
/// source of such constraints is added here; supports and contact between bodies take them all.
std::vector<ConstraintLine> collect_links(const dealii::DoFHandler<3> &dof_handler,
                                          const dealii::IndexSet &relevant);

/// Returns whether constraints of any rank name dofs that another rank owns. Collective.
bool couple_ranks(const Constraints &constraints, const dealii::IndexSet &owned, MPI_Comm communicator);

/// Transfers forces on constrained dofs to the dofs on which these depend, and sets them to 0: the
/// transpose of Constraints::distribute() without values. `forces` has owned entries. Collective if
/// the constraints couple ranks.
void condense(const Constraints &constraints, bool couples_ranks, Vector &forces);

} // namespace billet

#endif
