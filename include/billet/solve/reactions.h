// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_REACTIONS_H
#define BILLET_SOLVE_REACTIONS_H

#include "billet/contact/contact_load.h"
#include "billet/contact/facet_penetration.h"
#include "billet/diagnostics.h"
#include "billet/discretization/support_reactions.h"
#include "billet/geometry/placement.h"

#include <string>
#include <vector>

namespace billet {

/// Sums over the whole model of the forces that act on bodies [force]. Internal forces, and those
/// of contact between bodies, have none. Where a scheme weights forces of both ends of a step, all
/// is the weighted balance, and `inertia` includes what the weights change.
struct ForceBalance {
  dealii::Tensor<1, 3> reactions; ///< of supports and symmetry planes
  dealii::Tensor<1, 3> contact;   ///< of tools
  /// Loads, including forces of removed tools, of releases and of stabilisation.
  dealii::Tensor<1, 3> loads;
  dealii::Tensor<1, 3> inertia; ///< −M a
  dealii::Tensor<1, 3> free;    ///< forces that are out of balance at unconstrained dofs
  double size = 0.;             ///< sum of the magnitudes of nodal forces
  double round_off = 0.;        ///< force by round-off of positions

  /// Returns the sum of the first four without the last, which is round-off, over the size.
  double defect() const;
};

/// Force of a load on its body, and the work that it has done on it since the start.
struct LoadResult {
  dealii::Tensor<1, 3> force; ///< [force]
  double work = 0.;           ///< [energy]
};

/// Returns the names of the loads of all bodies, "BODY.load NAME", body by body in the order of
/// Body::loads.
std::vector<std::string> named_loads(const Scene &scene);

/// Sums over the nodes of a body.
struct BodyBalance {
  dealii::Tensor<1, 3> free; ///< forces that are out of balance at unconstrained dofs [force]
  double nodal = 0.;         ///< magnitudes of the internal forces of its nodes [force]
};

/// Forces on the bodies at the end of the last step, the same on all ranks.
struct Reactions {
  std::vector<Resultant> of_supports; ///< in the order of named_supports()
  /// Loads in the order of Scene::pairs(), moments about the origin.
  std::vector<ContactLoad> of_tool_pairs;
  ForceBalance balance;
  std::vector<BodyBalance> of_bodies;          ///< of implicit schemes, else empty
  std::vector<FacetPenetration> between_nodes; ///< of `of_tool_pairs`
  std::vector<LoadResult> of_loads;            ///< in the order of named_loads()
};

/// Returns the load with its moment about the origin. `placement`: that of the tool, about whose
/// moved centre the moment is before.
ContactLoad about_origin(ContactLoad load, const Placement &placement);

/// Returns a warning if the forces of the whole model fail to balance by more than round-off, that
/// of positions included. `in_float`: whether elements compute in float.
DiagnosticList check_force_balance(const ForceBalance &balance, double time, bool in_float);

} // namespace billet

#endif
