// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/element_block.h"

namespace billet {

std::string describe(const ElementFormulation &formulation, const PointLaw &law) {
  std::string words = std::string("implicit, ") + formulation.element.name() + ", ";
  if (formulation.points_through > 2)
    words += std::to_string(formulation.points_through) + " points through, ";
  return words + law.name();
}

std::unique_ptr<ElementBlock> make_element_block(const std::shared_ptr<const PointLaw> &law,
                                                 const ElementFormulation &formulation) {
  return formulation.element.make_block(law, formulation);
}

} // namespace billet
