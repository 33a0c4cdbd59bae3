// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_CONTACT_SETTINGS_H
#define BILLET_CONTACT_FACET_CONTACT_SETTINGS_H

#include "billet/contact/facet_choice.h"
#include "billet/friction/friction_law.h"
#include "billet/geometry/bilinear_facet.h"

namespace billet {

/// How a facet is seen by the nodes that touch it.
enum class FacetMethod {
  planed,   ///< PlanedFacet: no iteration
  mean_gap, ///< MeanGapFacet
  bilinear, ///< BilinearFacet: without friction, forces at a fixed area have a potential
  overlap   ///< FacetOverlapOf: no nodes, but facets touch, on their common polygon
};

/// The facets of FacetMethod::overlap, of which no node is projected.
struct OverlapFacet {};

/// Calls f(type), type::type being what a facet is to this method.
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

/// What contact between surfaces is made of.
struct FacetContactSettings {
  FacetMethod method = FacetMethod::planed;
  FrictionPointer friction; ///< null: none
  FacetSearch::Partners partners = FacetSearch::Partners::other_surfaces;
  /// Nodes of all surfaces are slaves, at half their penalty each, so that a pair of surfaces is as stiff as
  /// in one pass; else nodes of surface 0 only.
  bool two_pass = true;
  ContactLimits limits;
  double search_margin; ///< of FacetSearch, > 0 [length]
  /// Edges that are not flat are held apart where they cross, without friction, at the mean full penalty of
  /// the ends of both. Not asked for, this costs nothing.
  bool edges = false;
  double flat_edge = 0.99; ///< EdgeContact's largest alignment of normals
  double edge_depth = 5.;  ///< and its depth, relative to the facets' reach
  /// A node that is before a facet by no more than this part of its facets' size, now and at the start of the
  /// step, counts as touching it, without pressure: its stiffness may be all that holds a body at rest. < 0:
  /// none does.
  double touching_gap = -1.;
  /// How often a node may change facet or status in one step's iterations; one that did so more often stays
  /// with its facet as long as it touches that. 0: as often as it likes, and nobody counts.
  unsigned int most_changes = 0;

  bool has_friction() const { return friction != nullptr; }
  bool has_self_contact() const { return partners == FacetSearch::Partners::other_surfaces_and_self; }
};

} // namespace billet

#endif
