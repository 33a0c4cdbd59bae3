// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/state_fields.h"

#include <algorithm>
#include <utility>

namespace billet {

StateField symmetric_field(std::string name) {
  return {std::move(name), 6, {"xx", "yy", "zz", "xy", "xz", "yz"}};
}

StateField tensor_field(std::string name) {
  return {std::move(name), 9, {"xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"}};
}

std::vector<StateField> stored_fields(const PointLaw &law) {
  std::vector<StateField> fields = law.fields();
  const auto is_empty = [](const StateField &field) { return field.n_components == 0; };
  fields.erase(std::remove_if(fields.begin(), fields.end(), is_empty), fields.end());
  return fields;
}

std::string describe(const std::vector<StateField> &fields) {
  std::string words;
  for (const StateField &field : fields)
    words += (words.empty() ? "'" : ", '") + field.name + "' (" + std::to_string(field.n_components) + ")";
  return words.empty() ? "none" : words;
}

std::size_t place_of_field(const PointLaw &law, const std::string &name) {
  std::size_t place = 0;
  for (const StateField &field : law.fields()) {
    if (field.name == name)
      break;
    place += field.n_components;
  }
  return place;
}

std::vector<double> StateAverage::find(const std::string &name) const {
  auto first = numbers.begin();
  for (const StateField &field : fields) {
    const auto last = first + static_cast<std::ptrdiff_t>(field.n_components);
    if (field.name == name)
      return {first, last};
    first = last;
  }
  return {};
}

} // namespace billet
