// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/law_block.h"
#include "billet/mechanics/one_point.h"

namespace billet {

std::unique_ptr<ElementBlock> make_one_point_block(const std::shared_ptr<const PointLaw> &law,
                                                   const ElementFormulation &formulation) {
  return make_law_block<OnePointElement>(law, formulation);
}

} // namespace billet
