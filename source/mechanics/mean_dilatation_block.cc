// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/eight_point_elements.h"
#include "billet/mechanics/law_block.h"

namespace billet {

std::unique_ptr<ElementBlock> make_mean_dilatation_block(const std::shared_ptr<const PointLaw> &law,
                                                         const ElementFormulation &formulation) {
  return make_law_block<MeanDilatationElement>(law, formulation);
}

} // namespace billet
