// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/field_quantity.h"

#include <algorithm>
#include <cctype>

namespace billet {

namespace {

/// Returns a name for files.
std::string to_file_name(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](const unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return "state_" + name;
}

std::vector<std::string> component_names(const StateField &field) {
  const std::string name = to_file_name(field.name);
  if (field.n_components == 1)
    return {name};
  std::vector<std::string> names;
  for (std::size_t k = 0; k < field.n_components; ++k)
    names.push_back(name + "_" + (k < field.components.size() ? field.components[k] : std::to_string(k + 1)));
  return names;
}

/// Returns the field of this name with the most components.
StateField find_field(const Scene &scene, const std::string &name) {
  StateField found{name, 0, {}};
  for (const Body &body : scene.bodies())
    for (const StateField &field : stored_fields(*body.law))
      if (field.name == name && field.n_components > found.n_components)
        found = field;
  return found;
}

} // namespace

std::vector<ElementQuantity> state_quantities(const Scene &scene) {
  std::vector<ElementQuantity> quantities;
  for (const std::string &name : scene.parameters().output.state_fields.value) {
    const StateField field = find_field(scene, name);
    quantities.push_back({name, "", component_names(field), true, [](const Scene &) { return true; },
                          [field](const ElementAverage &average) {
                            std::vector<double> values = average.state.find(field.name);
                            values.resize(field.n_components, 0.);
                            return values;
                          },
                          true});
  }
  return quantities;
}

} // namespace billet
