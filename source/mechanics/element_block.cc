// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/element_block.h"

#include "billet/mechanics/law_block.h"

namespace billet {

using Element = ElementFormulation::Element;
const char *name_of(const Element element) {
  switch (element) {
  case Element::assumed_strain:
    return "assumed strain";
  case Element::mean_dilatation:
    return "mean dilatation";
  case Element::one_point:
    return "one point";
  }
  return "";
}

std::string describe(const ElementFormulation &formulation, const PointLaw &law) {
  std::string words = std::string("implicit, ") + name_of(formulation.element) + ", ";
  if (formulation.points_through > 2)
    words += std::to_string(formulation.points_through) + " points through, ";
  return words + law.name();
}

std::unique_ptr<ElementBlock> make_element_block(const std::shared_ptr<const PointLaw> &law,
                                                 const ElementFormulation &formulation) {
  switch (formulation.element) {
  case Element::assumed_strain:
    switch (formulation.points_through) {
    case 3:
      return make_assumed_strain_block_3(law, formulation);
    case 5:
      return make_assumed_strain_block_5(law, formulation);
    case 7:
      return make_assumed_strain_block_7(law, formulation);
    default:
      return make_assumed_strain_block(law, formulation);
    }
  case Element::mean_dilatation:
    return make_mean_dilatation_block(law, formulation);
  case Element::one_point:
    break;
  }
  return make_one_point_block(law, formulation);
}

} // namespace billet
