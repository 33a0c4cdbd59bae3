// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_CONTACT_SETTINGS_H
#define BILLET_CONTACT_FACET_CONTACT_SETTINGS_H

#include "billet/contact/contact_penalties.h"
#include "billet/contact/facet_choice.h"
#include "billet/friction/friction_law.h"
#include "billet/geometry/bilinear_facet.h"
#include "billet/geometry/facet_method.h"

namespace billet {

/// Tag for the facets of FacetMethod::overlap, onto which no node is projected.
struct OverlapFacet {};

/// Calls f(type), where type::type is the facet class of this method.
template <class Type> struct FacetType { using type = Type; };
template <class Function> void visit_method(const FacetMethod method, const Function &f) {
  switch (method) {
  case FacetMethod::planed:
    f(FacetType<PlanedFacet>());
    break;
  case FacetMethod::mean_gap:
    f(FacetType<MeanGapFacet>());
    break;
  case FacetMethod::bilinear:
    f(FacetType<BilinearFacet>());
    break;
  case FacetMethod::overlap:
    f(FacetType<OverlapFacet>());
    break;
  }
}

/// Settings of contact between surfaces.
struct FacetContactSettings {
  FacetMethod method = FacetMethod::planed;
  FrictionPointer friction; ///< null: none
  FacetSearch::Partners partners = FacetSearch::Partners::other_surfaces;
  /// Whether nodes of all surfaces are slaves, with half the penalty each, so that a pair of
  /// surfaces is as stiff as in one pass. Otherwise only nodes of surface 0 are slaves.
  bool two_pass = true;
  ContactLimits limits;
  double search_margin; ///< of FacetSearch, > 0 [length]
  /// Whether edge-to-edge contact keeps crossing edges apart, except flat ones. It has no friction;
  /// its penalty is the mean full penalty of the ends of both edges. It costs nothing if disabled.
  bool edges = false;
  double flat_edge = 0.99;      ///< maximum alignment of normals for EdgeContact
  double edge_penetration = 5.; ///< its maximum penetration, relative to the facets' reach
  /// Maximum gap [facet sizes], now and at the start of the step, at which a node counts as
  /// touching a facet without pressure. The stiffness of such nodes may be the only constraint of a
  /// body at rest. If < 0, no node does.
  double touching_gap = -1.;
  /// Maximum number of changes of facet or status of a node in one step's iterations. A node that
  /// exceeds it stays with its facet as long as it touches that. 0: no limit, and no counting.
  unsigned int max_changes = 0;
  double penetration_tolerance = 0.;       ///< of ContactPenalties; 0: none [facet sizes]
  ContactPenalties::Limits max_stiffening; ///< of the given penalties

  bool has_friction() const { return friction != nullptr; }
  bool has_self_contact() const { return partners == FacetSearch::Partners::other_surfaces_and_self; }
};

} // namespace billet

#endif
