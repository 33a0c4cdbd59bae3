// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACETED_CURVATURE_H
#define BILLET_CONTACT_FACETED_CURVATURE_H

#include "billet/diagnostics.h"
#include "billet/discretization/boundary_facets.h"

namespace billet {

/// Maximum faceting error in the gap between two conforming curved surfaces, such as a pin in its
/// lug.
struct ChordGap {
  double gap = 0.;               ///< gap error due to the facets' chords [length]
  double relative = 0.;          ///< the same, relative to the size of the first surface's facets
  double clearance = 0.;         ///< between the smooth surfaces there; < 0: they overlap [length]
  dealii::Tensor<1, 3> position; ///< where
  bool fits = false;             ///< whether the surfaces conform anywhere
};

/// Finds the maximum faceting error between the faces of a pair, undeformed or with these (ghosted)
/// displacements. The smooth surfaces are those of mean nodal normals, (C9); facets that meet at
/// more than 50 degrees do not share a normal. Surfaces conform where one is convex, the other
/// concave, and their maximum curvatures differ by less than a quarter. Where nodes of both
/// surfaces coincide, so do their chords, and the error is 0. Collective; ranks get all faces of
/// the second body.
ChordGap find_chord_gap(const Discretization &discretization, const BodyPair &pair,
                        const Vector *displacements = nullptr);

/// Returns the tilt of an undeformed facet against its surface of revolution, or its sphere, in the
/// scene. It is the sine of the angle between its normal and the plane through its middle and the
/// axis, or the line to the centre. It is 0 for symmetric facets of the surface. For others it is
/// of second order in their angle, for any profile of a surface of revolution. If an axis is off by
/// d, the maximum tilt is about d/R.
double tilt_of(const BoundaryFacet &facet, const parameters::ContactPair::Correction &correction);

/// Maximum tilt of a facet of the named surface. This is about the relative error of heights above
/// the facet.
constexpr double max_tilt = 0.1;

/// Throws InputError if the faces of the pair do not belong to the surface of 'Surface correction'.
/// Then facets tilt too much, or its heights are on average less than half of those of mean nodal
/// normals. Collective.
void check_correction(const Scene &scene, const BodyPair &pair, const Discretization &discretization);

/// Returns a warning for each pair of two bodies whose chord gap exceeds the allowed initial
/// penetration and a fifth of the clearance there. Collective.
DiagnosticList find_faceted_curvature(const Scene &scene, const Discretization &discretization);

/// Returns, at the end of a run with its (ghosted) displacements, a warning for each pair that
/// conformed at the start without one. It warns if the faces have slid until their nodes no longer
/// match, or if the chord gap exceeds 0.03 of the maximum displacement. Collective.
DiagnosticList find_faceted_curvature(const Scene &scene, const Discretization &discretization,
                                      const Vector &displacements, double time);

} // namespace billet

#endif
