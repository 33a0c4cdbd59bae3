// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_OVERLAP_H
#define BILLET_CONTACT_OVERLAP_H

#include "billet/discretization/boundary_facets.h"
#include "billet/geometry/facet_bulge.h"

#include <vector>

namespace billet {

/// Returns the maximum penetration at which a node still belongs to a facet [length]. A node deeper
/// than half the wall below is nearer to the wall's other side. A node that comes in from the side
/// of the facet, rather than through it, must not be ejected.
double contact_reach(const BoundaryFacet &facet);

/// Returns this rank's boundary of a body except its symmetry planes, behind which the body
/// continues.
std::vector<BoundaryFacet> collect_free_boundary(const Discretization &discretization, std::size_t body,
                                                 const std::vector<Constraint> &constraints);

/// Initial penetration of undeformed bodies.
struct Overlap {
  /// Maximum distance of a node of one body, or of a point below its faces, to the surface of the
  /// other, inside it [length].
  double penetration = 0.;
  dealii::Tensor<1, 3> position; ///< of that point
};

/// Finds the nodes of one body's faces, and points of the elements at them, that are inside
/// elements of another body. The depth of such a point is its distance to the whole boundary of
/// that body except its symmetry planes (among `other_constraints`).
///
/// The nearest boundary need not be a contact face: a node that lies on the head of a bolt is not
/// inside its shank. The points include some on every part of the faces' sides that the other's
/// faces (`other_boundary_ids`) cut off. Thus they detect intersecting bodies anywhere. Collective;
/// intended for the start only: all ranks get all of the first body's faces.
Overlap find_overlap(const Discretization &discretization, std::size_t body,
                     const std::vector<unsigned int> &boundary_ids, std::size_t other_body,
                     const std::vector<unsigned int> &other_boundary_ids,
                     const std::vector<Constraint> &other_constraints);

/// Finds the overlap of a body with itself: `penetration` is that of such points below its faces.
Overlap find_self_overlap(const Discretization &discretization, std::size_t body,
                          const std::vector<unsigned int> &boundary_ids);

/// Throws InputError, with the maximum overlap and its position, if the initial penetration of a
/// pair exceeds the allowed one. Also throws if its faces do not belong to the surface in the
/// scene. Collective.
void check_overlap(const Scene &scene, std::size_t pair, const Discretization &discretization);

} // namespace billet

#endif
