// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_PENETRATION_H
#define BILLET_CONTACT_FACET_PENETRATION_H

#include <deal.II/base/tensor.h>

#include <algorithm>

namespace billet {

/// Penetration of a tool into facets between their nodes, beyond that of the nodes, see *Facets
/// between nodes* in doc/theory.md.
struct FacetPenetration {
  double length = 0.;            ///< maximum [length]
  double of_facet = 0.;          ///< maximum relative to the distance of the nodes around it, ...
  double facet_length = 0.;      ///< ... that distance [length], ...
  dealii::Tensor<1, 3> position; ///< ... and where it is

  void add(const FacetPenetration &other) {
    length = std::max(length, other.length);
    if (other.of_facet > of_facet) {
      of_facet = other.of_facet;
      facet_length = other.facet_length;
      position = other.position;
    }
  }
};

struct RigidContactParts;

/// Measures it at the last update() of a pair. Samples are the middles of sides and of facets.
/// Collective.
FacetPenetration find_facet_penetration(const RigidContactParts &parts);

} // namespace billet

#endif
