// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_SURFACE_CORRECTION_H
#define BILLET_CONTACT_SURFACE_CORRECTION_H

#include "billet/discretization/smooth_facets.h"

#include <cstddef>
#include <vector>

/// The true surfaces that 'Surface correction' names, above the facets of the mesh.
namespace billet {

/// Collects the undeformed facets of all ranks with these boundary ids, or those with these (ghosted)
/// displacements; those of this rank, `n_own_facets`, come first. Collective.
std::vector<SmoothFacet> collect_smooth_facets(const Discretization &discretization, std::size_t body,
                                               const std::vector<unsigned int> &boundary_ids,
                                               const Vector *displacements, std::size_t &n_own_facets);

/// Returns the vector from the axis, or the centre, of the surface of `correction` to a point
/// [length].
dealii::Tensor<1, 3> arm_to(const dealii::Tensor<1, 3> &x,
                            const parameters::ContactPair::Correction &correction);

/// Returns the bulge, above the undeformed facet, of the true surface in the scene; 0 if there is
/// none. Its distance from the axis, or the centre, is linear between the nodes of an edge.
FacetBulge bulge_of(const BoundaryFacet &facet, const parameters::ContactPair::Correction &correction);

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

/// Returns the maximum error of the corrected facets of both sides against the surface in the scene
/// [length]. Between the corners the surface has the bilinear radius of these. Collective.
double find_correction_error(const Discretization &discretization, const BodyPair &pair);

} // namespace billet

#endif
