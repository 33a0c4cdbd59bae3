// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/element_type.h"

#include "billet/mechanics/element_block.h"

#include <utility>

namespace billet {

ElementType assumed_strain_type();
ElementType mean_dilatation_type();
ElementType one_point_type();

TypeTable<ElementChoice, ElementType> &element_types() {
  static TypeTable<ElementChoice, ElementType> types{assumed_strain_type(), mean_dilatation_type(),
                                                     one_point_type()};
  return types;
}

ElementType make_element_type(const BrickElement element, std::string meaning,
                              std::vector<TypeParameter> parameters,
                              std::function<void(const TypeInput &, ElementChoice &)> read) {
  const auto make = [element, read = std::move(read)](const TypeInput &input) {
    ElementChoice choice;
    choice.type = element;
    if (read)
      read(input, choice);
    return choice;
  };
  return {{element.name(), std::move(meaning), std::move(parameters), make}, element};
}

std::vector<BrickElement> all_elements() {
  std::vector<BrickElement> elements;
  for (const ElementType &type : element_types())
    elements.push_back(type.element);
  return elements;
}

std::unique_ptr<ElementBlock> BrickElement::make_block(const std::shared_ptr<const PointLaw> &law,
                                                       const ElementFormulation &formulation) const {
  return kind_->make_block(law, formulation);
}

PlaneFactors BrickElement::plane_factors(const ElasticModuli &elastic, const ElementFormulation &formulation,
                                         const ElementVectors &positions,
                                         const unsigned int direction) const {
  return kind_->plane_factors != nullptr ? kind_->plane_factors(elastic, formulation, positions, direction)
                                         : plane_factors_of_displacements(elastic);
}

} // namespace billet
