// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACETED_CURVATURE_H
#define BILLET_CONTACT_FACETED_CURVATURE_H

#include "billet/diagnostics.h"
#include "billet/discretization/boundary_facets.h"

namespace billet {

/// The largest error that facets make in the gap between two curved surfaces that fit each other, such as a
/// pin in its lug.
struct ChordGap {
  double gap = 0.;               ///< that the facets' chords add or take away [length]
  double relative = 0.;          ///< the same in sizes of the first surface's facets
  double clearance = 0.;         ///< between the smooth surfaces there; < 0: they overlap [length]
  dealii::Tensor<1, 3> position; ///< where
  bool fits = false;             ///< whether the surfaces fit each other anywhere
};

/// Finds it between the faces of a pair, undeformed or with these (ghosted) displacements. The smooth
/// surfaces are those of mean nodal normals, (C9); facets that meet at more than 50 degrees do not share one.
/// Surfaces fit each other where one is convex, the other concave, and their largest curvatures differ by
/// less than a quarter. Where nodes of both lie at the same places chords do, too, and nothing is found.
/// Collective; ranks get all faces of the second body.
ChordGap find_chord_gap(const Discretization &discretization, const BodyPair &pair,
                        const Vector *displacements = nullptr);

/// The tilt of an undeformed facet against the surface of revolution, or the sphere, that a scene names for
/// it: the sine of the angle between its normal and the plane through its middle and the axis, or the line to
/// the centre. 0 for facets of the surface that are symmetric, second order in their angle for others,
/// whatever the profile of a surface of revolution. If an axis is off by d, the largest tilt is about d/R.
double tilt_of(const BoundaryFacet &facet, const parameters::ContactPair::Correction &correction);

/// The largest tilt that counts as a facet of the named surface. Heights above the facet are off by about
/// that part of themselves.
constexpr double largest_tilt = 0.1;

/// Throws InputError if the faces of the pair are not of the surface that 'Surface correction' names: facets
/// tilt too much, or its heights are on average less than half of those of mean nodal normals. Collective.
void check_correction(const Scene &scene, const BodyPair &pair, const Discretization &discretization);

/// A warning for each pair of two bodies whose chord gap is more than the allowed initial penetration and
/// more than a fifth of the clearance there. Collective.
DiagnosticList find_faceted_curvature(const Scene &scene, const Discretization &discretization);

/// At the end of a run, with its (ghosted) displacements, a warning for each pair that fitted at its start
/// without one: whose faces have slid until their nodes no longer match, or whose chord gap is more than 0.03
/// of the largest displacement. Collective.
DiagnosticList find_faceted_curvature(const Scene &scene, const Discretization &discretization,
                                      const Vector &displacements, double time);

} // namespace billet

#endif
