// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/element_block.h"

#include "billet/mechanics/law_block.h"

namespace billet {

using Element = ElementFormulation::Element;
using Kinematics = ElementFormulation::Kinematics;

bool has_symmetric_tangent(const ElementFormulation &formulation, const bool is_plastic) {
  return formulation.kinematics != Kinematics::hypoelastic &&
         !(is_plastic && formulation.kinematics == Kinematics::neo_hookean);
}

std::string describe(const ElementFormulation &formulation) {
  const std::string element = formulation.element == Element::full        ? "full"
                              : formulation.element == Element::one_point ? "one point"
                                                                          : "mean dilatation";
  return "implicit, " + element +
         (formulation.kinematics == Kinematics::hencky        ? ", Hencky"
          : formulation.kinematics == Kinematics::neo_hookean ? ", neo-Hookean"
                                                              : ", hypoelastic");
}

std::unique_ptr<ElementBlock> make_element_block(const MaterialLaw &material,
                                                 const ElementFormulation &formulation) {
  switch (formulation.element) {
  case Element::full:
    return make_full_block(material, formulation);
  case Element::one_point:
    return make_one_point_block(material, formulation);
  case Element::mean_dilatation:
    break;
  }
  return make_mean_dilatation_block(material, formulation);
}

} // namespace billet
