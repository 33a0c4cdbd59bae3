// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_OVERLAP_H
#define BILLET_CONTACT_OVERLAP_H

#include "billet/discretization/boundary_facets.h"
#include "billet/geometry/facet_bulge.h"

#include <vector>

namespace billet {

/// How deep a node may be in a facet and still belong to it [length]. What is deeper than half the wall below
/// is nearer to the wall's other side; and a node that comes in from beside the facet, rather than through
/// it, is not to be thrown out from the depth.
double contact_reach(const BoundaryFacet &facet);

/// From the axis, or the centre, of the surface that a scene names, to a point [length].
dealii::Tensor<1, 3> arm_to(const dealii::Tensor<1, 3> &x,
                            const parameters::ContactPair::Correction &correction);

/// Of the true surface that a scene names for a face, above the undeformed facet; 0 if it names none. Its
/// distance from the axis, or the centre, is linear between the nodes of an edge.
FacetBulge bulge_of(const BoundaryFacet &facet, const parameters::ContactPair::Correction &correction);

/// The boundary of a body but for its symmetry planes, behind which it goes on. Of this rank.
std::vector<BoundaryFacet> collect_free_boundary(const Discretization &discretization, std::size_t body,
                                                 const std::vector<Hold> &holds);

/// How deep undeformed bodies are in each other.
struct Overlap {
  /// Largest distance of a node of one, or a point below its faces, to the surface of the other, inside it
  /// [length].
  double depth = 0.;
  dealii::Tensor<1, 3> position; ///< of that point
};

/// Finds the nodes of one body's faces, and points of the elements at them, that are inside elements of
/// another body. The depth of such a point is its distance to the whole boundary of that body but for its
/// symmetry planes (among `other_holds`). That may be beside the faces that touch: a node that lies on the
/// head of a bolt is not inside its shank. Among the
/// points are some on every part of the faces' sides that the other's faces (`other_boundary_ids`) cut off:
/// so bodies that pierce each other are found wherever they do. Collective; meant for the start only: all
/// ranks get all of the first body's faces.
Overlap find_overlap(const Discretization &discretization, std::size_t body,
                     const std::vector<unsigned int> &boundary_ids, std::size_t other_body,
                     const std::vector<unsigned int> &other_boundary_ids,
                     const std::vector<Hold> &other_holds);

/// The same of a body whose elements are in each other: `depth` is that of such points below its faces.
Overlap find_self_overlap(const Discretization &discretization, std::size_t body,
                          const std::vector<unsigned int> &boundary_ids);

/// Throws InputError, with the largest overlap and where it is, if the undeformed bodies of a pair are deeper
/// in each other than the scene allows, or their faces are not of the surface that it names. Collective.
void check_overlap(const Scene &scene, std::size_t pair, const Discretization &discretization);

} // namespace billet

#endif
