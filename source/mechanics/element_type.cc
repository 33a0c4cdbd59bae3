// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mechanics/element_type.h"

#include "billet/mechanics/element_block.h"

#include <stdexcept>
#include <utility>

namespace billet {

ElementType assumed_strain_type();
ElementType mean_dilatation_type();
ElementType one_point_type();

TypeTable<BrickElement> &element_types() {
  static TypeTable<BrickElement> types{assumed_strain_type(), mean_dilatation_type(), one_point_type()};
  return types;
}

namespace {

/// Input of a type without parameters.
class NoInput final : public TypeInput {
public:
  bool is_set(const std::string &) const override { return false; }
  std::string text(const std::string &key) const override { reject(key, ""); }
  bool flag(const std::string &key) const override { reject(key, ""); }
  double number(const std::string &key) const override { reject(key, ""); }
  double positive(const std::string &key) const override { reject(key, ""); }
  double not_negative(const std::string &key) const override { reject(key, ""); }
  std::vector<double> numbers(const std::string &key) const override { reject(key, ""); }
  dealii::Tensor<1, 3> vector(const std::string &key) const override { reject(key, ""); }
  dealii::Tensor<1, 3> direction(const std::string &key) const override { reject(key, ""); }
  std::vector<std::string> parts(const std::string &key, char) const override { reject(key, ""); }
  std::string file(const std::string &key) const override { reject(key, ""); }
  [[noreturn]] void reject(const std::string &key, const std::string &) const override {
    throw std::logic_error("elements have no parameter '" + key + "'");
  }
};

} // namespace

ElementType make_element_type(const BrickElement element, std::string meaning) {
  return {element.name(), std::move(meaning), {}, [element](const TypeInput &) { return element; }};
}

std::vector<BrickElement> all_elements() {
  std::vector<BrickElement> elements;
  for (const ElementType &type : element_types())
    elements.push_back(type.make(NoInput()));
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
