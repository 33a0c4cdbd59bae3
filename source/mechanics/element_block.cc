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

const char *name_of(const Kinematics kinematics) {
  switch (kinematics) {
  case Kinematics::hencky:
    return "Hencky";
  case Kinematics::neo_hookean:
    return "neo-Hookean";
  case Kinematics::hypoelastic:
    return "hypoelastic";
  }
  return "";
}

std::string describe(const ElementFormulation &formulation) {
  std::string words = std::string("implicit, ") + name_of(formulation.element) + ", ";
  if (formulation.points_through > 2)
    words += std::to_string(formulation.points_through) + " points through, ";
  return words + name_of(formulation.kinematics);
}

std::unique_ptr<ElementBlock> make_element_block(const MaterialLaw &material,
                                                 const ElementFormulation &formulation) {
  switch (formulation.element) {
  case Element::assumed_strain:
    switch (formulation.points_through) {
    case 3:
      return make_assumed_strain_block_3(material, formulation);
    case 5:
      return make_assumed_strain_block_5(material, formulation);
    case 7:
      return make_assumed_strain_block_7(material, formulation);
    default:
      return make_assumed_strain_block(material, formulation);
    }
  case Element::mean_dilatation:
    return make_mean_dilatation_block(material, formulation);
  case Element::one_point:
    break;
  }
  return make_one_point_block(material, formulation);
}

} // namespace billet
