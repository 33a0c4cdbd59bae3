// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/eight_point_elements.h"
#include "billet/mechanics/element_comparison.h"
#include "billet/mechanics/law_block.h"

namespace billet {

ElementType mean_dilatation_type();

namespace {

constexpr ElementKind mean_dilatation_kind = {"mean dilatation",
                                              &make_law_block<MeanDilatationElement>,
                                              false,
                                              false,
                                              LaneElement::mean_dilatation,
                                              &compare_points<MeanDilatationElement>,
                                              /*may_lock_in_bending=*/true,
                                              /*may_be_soft=*/true};

} // namespace

const BrickElement BrickElement::mean_dilatation(mean_dilatation_kind);

ElementType mean_dilatation_type() {
  return make_element_type(BrickElement::mean_dilatation,
                           "eight points with a common volumetric strain, for solid parts that do not bend");
}

} // namespace billet
