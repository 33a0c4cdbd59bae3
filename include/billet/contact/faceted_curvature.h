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
