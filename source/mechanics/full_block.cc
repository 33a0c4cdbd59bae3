// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/eight_point_elements.h"
#include "billet/mechanics/law_block.h"

namespace billet {

std::unique_ptr<ElementBlock> make_full_block(const MaterialLaw &material,
                                              const ElementFormulation &formulation) {
  return make_law_block<FullElement>(material, formulation);
}

} // namespace billet
