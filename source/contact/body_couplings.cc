// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/body_couplings.h"

#include "billet/contact/body_surfaces.h"

namespace billet {

BodyCouplings::BodyCouplings(const BodyPair &pair, const LocalNodes &nodes, const BodySurfaces &surfaces,
                             FacetContact &contact, const ContactTangent tangent)
    : pair_(pair), surfaces_(surfaces), blocks_(contact, nodes, surfaces.local_nodes), tangent_(tangent) {}

void BodyCouplings::save(StateWriter &writer) const { blocks_.save(writer, surfaces_.keys, describe()); }

bool BodyCouplings::load(const StateReader &reader) {
  return blocks_.load(reader, surfaces_.keys, describe());
}

std::vector<double> BodyCouplings::describe() const {
  return {static_cast<double>(tangent_), static_cast<double>(pair_.facets), pair_.two_passes ? 1. : 0.};
}

} // namespace billet
