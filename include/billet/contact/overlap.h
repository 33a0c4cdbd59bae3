// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_OVERLAP_H
#define BILLET_CONTACT_OVERLAP_H

#include "billet/discretization/discretization.h"

#include <vector>

namespace billet {

/// How deep undeformed bodies are in each other.
struct Overlap {
  /// Largest distance of a node of one, or a point below its faces, to the surface of the other, inside it
  /// [length].
  double depth = 0.;
  dealii::Tensor<1, 3> position; ///< of that point
};

/// Looks for the nodes of one body's faces, and points of the elements at them, inside the elements of
/// another, and how far they are from its faces. Among the points are some on every part of the faces' sides
/// that the other's faces cut off: so it finds bodies that pierce each other wherever they do. Collective;
/// meant for the start only: ranks tell each other all of the first body's faces.
Overlap find_overlap(const Discretization &discretization, std::size_t body,
                     const std::vector<unsigned int> &boundary_ids, std::size_t other_body,
                     const std::vector<unsigned int> &other_boundary_ids);

/// The same of a body whose elements are in each other: `depth` is that of such points below its faces.
Overlap find_self_overlap(const Discretization &discretization, std::size_t body,
                          const std::vector<unsigned int> &boundary_ids);

} // namespace billet

#endif
