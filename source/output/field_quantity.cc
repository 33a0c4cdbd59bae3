// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/field_quantity.h"

#include <algorithm>
#include <stdexcept>

namespace billet {

NodalQuantity displacement_quantity();
NodalQuantity velocity_quantity();
NodalQuantity contact_quantity();
ElementQuantity stress_quantity();
ElementQuantity strain_quantity();
ElementQuantity plastic_strain_quantity();
ElementQuantity sheet_strains_quantity();
ElementQuantity forming_limit_quantity();
ElementQuantity mesh_error_quantity_of_elements();
ElementQuantity body_quantity();
ElementQuantity material_quantity();

FieldQuantities &field_quantities() {
  static FieldQuantities quantities{
      {displacement_quantity(), velocity_quantity(), contact_quantity()},
      {stress_quantity(), strain_quantity(), plastic_strain_quantity(), sheet_strains_quantity(),
       forming_limit_quantity(), mesh_error_quantity_of_elements(), body_quantity(), material_quantity()}};
  return quantities;
}

FieldQuantities::FieldQuantities(const std::vector<NodalQuantity> &nodal,
                                 const std::vector<ElementQuantity> &of_elements) {
  for (const auto &quantity : nodal)
    add(quantity);
  for (const auto &quantity : of_elements)
    add(quantity);
}

void FieldQuantities::add(const NodalQuantity &quantity) {
  check_new(quantity.name);
  nodal_.push_back(quantity);
}

void FieldQuantities::add(const ElementQuantity &quantity) {
  check_new(quantity.name);
  for (const auto &other : of_elements_)
    for (const std::string &component : quantity.components)
      if (std::count(other.components.begin(), other.components.end(), component) > 0)
        throw std::logic_error("the fields '" + other.name + "' and '" + quantity.name +
                               "' have a component of the same name, '" + component + "'");
  of_elements_.push_back(quantity);
}

void FieldQuantities::check_new(const std::string &name) const {
  const auto has_name = [&name](const auto &other) { return other.name == name; };
  if (std::any_of(nodal_.begin(), nodal_.end(), has_name) ||
      std::any_of(of_elements_.begin(), of_elements_.end(), has_name))
    throw std::logic_error("the field '" + name + "' is registered twice");
}

} // namespace billet
