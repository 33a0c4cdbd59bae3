// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_IMPLICIT_REACTIONS_H
#define BILLET_SOLVE_IMPLICIT_IMPLICIT_REACTIONS_H

#include "billet/solve/implicit/implicit_problem.h"
#include "billet/solve/reactions.h"

#include <optional>
#include <vector>

namespace billet {

/// Reactions of the accepted steps of an implicit scene, at their ends: at a constrained dof, the
/// sum of all forces without constraints. In dynamics they include inertia, with the accelerations
/// at the end of the step. The free residual is that of the integrator's balance, which weighs
/// forces of both ends. Inertia of the whole model is what is in balance with the other forces.
///
/// A support that has ended has the force that fades.
class ImplicitReactions {
public:
  explicit ImplicitReactions(const ImplicitProblem &problem);

  const Reactions &values() const { return values_; }
  /// Computes the reactions of supports from the last residual, before anything is committed;
  /// contact comes by set_pair(). Collective.
  void start();
  /// Sets force and work of each load; none: the scene has no loads.
  void set_loads(const std::vector<LoadResult> &of_loads) { values_.of_loads = of_loads; }
  /// Sets the load and the penetration of a pair with a tool, whose placement is that at the end of
  /// the step.
  void set_pair(std::size_t pair, const ContactLoad &load, const FacetPenetration &between_nodes,
                const Placement &placement);
  /// Adds what is left of a removed tool's load through a pair, with the moment about the
  /// placement's moved centre. The pair is known unless the run resumes with other pairs.
  void add_removed(std::optional<std::size_t> pair, const ContactLoad &load, const Placement &placement);

private:
  /// Adds the fading forces of supports.
  void add_fading();
  /// Sets the sums over the nodes of each body. `residual`: that of all nodes, with these
  /// reactions.
  void balance_bodies(const Vector &residual, const std::vector<Resultant> &of_supports);

  const ImplicitProblem &problem_;
  const ImplicitParts &parts_ = problem_.parts();
  SupportReactions supports_;
  std::vector<std::size_t> bodies_of_nodes_;    ///< owned
  std::vector<std::size_t> bodies_of_supports_; ///< in the order of named_supports()
  Reactions values_;
};

} // namespace billet

#endif
