// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_BODY_CONTACT_PARTS_H
#define BILLET_CONTACT_BODY_CONTACT_PARTS_H

#include "billet/contact/body_surfaces.h"

#include <memory>
#include <vector>

namespace billet {

class FacetContact;

/// State of contact between bodies, which BodyContact advances and its evaluations and measures
/// read.
struct BodyContactParts {
  BodyContactParts(const Scene &scene, const BodyPair &pair, const LocalNodes &nodes);
  ~BodyContactParts();
  BodyContactParts(const BodyContactParts &) = delete;
  BodyContactParts &operator=(const BodyContactParts &) = delete;

  const BodyPair &pair;
  const LocalNodes &nodes;
  const MPI_Comm communicator;
  const BodySurfaces surfaces;
  std::unique_ptr<FacetContact> contact;
  FacetSearch::Positions positions;   ///< of the surface nodes at the last evaluate() [length]
  FacetSearch::Positions positions_n; ///< at the last commit(); empty before the first evaluate()
  FacetSearch::Positions forces;      ///< F_c at the last evaluate() [force]
  double duration = 0.;               ///< of the step [time]

  /// Computes contact at `positions` in a step of this duration [time]. Collective.
  void evaluate(double step_duration);
  /// Records the initial penetration if the scene allows it, after evaluate(). Closes initial gaps
  /// if the scene requests it. Collective.
  void allow_overlap();

private:
  void allow_penetrations();
};

/// Returns which surfaces a pair searches for the facets that its nodes touch.
FacetSearch::Partners partners_of(const BodyPair &pair);

} // namespace billet

#endif
