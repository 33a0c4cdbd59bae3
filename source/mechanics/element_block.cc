// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/element_block.h"

namespace billet {

std::unique_ptr<ElementBlock> make_element_block(const std::shared_ptr<const PointLaw> &law,
                                                 const ElementFormulation &formulation) {
  return formulation.element.make_block(law, formulation);
}

} // namespace billet
