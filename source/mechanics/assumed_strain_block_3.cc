// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/assumed_strain_element.h"
#include "billet/mechanics/law_block.h"

namespace billet {

std::unique_ptr<ElementBlock> make_assumed_strain_block_3(const std::shared_ptr<const PointLaw> &law,
                                                          const ElementFormulation &formulation);

std::unique_ptr<ElementBlock> make_assumed_strain_block_3(const std::shared_ptr<const PointLaw> &law,
                                                          const ElementFormulation &formulation) {
  return make_law_block<AssumedStrainElement<3>>(law, formulation);
}

} // namespace billet
