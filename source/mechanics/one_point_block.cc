// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/element_comparison.h"
#include "billet/mechanics/law_block.h"
#include "billet/mechanics/one_point.h"

namespace billet {

ElementType one_point_type();

namespace {

bool compare(const ElementComparison &, const ComparedBrick &brick, ElementEnergies &energies) {
  energies += brick.one_point;
  return true;
}

constexpr ElementKind one_point_kind = {"one point", &make_law_block<OnePointElement>, true,
                                        false,       LaneElement::one_point,           &compare};

} // namespace

const BrickElement BrickElement::one_point(one_point_kind);

ElementType one_point_type() {
  return make_element_type(BrickElement::one_point, "one point with hourglass stabilisation, the cheapest");
}

} // namespace billet
