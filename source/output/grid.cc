// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/grid.h"

#include <algorithm>
#include <array>

namespace billet {

namespace {

/// Endings of the components of a tensor, and the places in the files of those that stand there.
struct TensorForm {
  std::vector<std::string> endings;
  std::vector<std::size_t> places;
};

const std::array<TensorForm, 2> &tensor_forms() {
  static const std::array<TensorForm, 2> forms{
      {{{"_xx", "_xy", "_xz", "_yx", "_yy", "_yz", "_zx", "_zy", "_zz"}, {0, 1, 2, 3, 4, 5, 6, 7, 8}},
       {{"_xx", "_yy", "_zz", "_xy", "_xz", "_yz"}, {0, 1, 2, 3, 5, 4}}}};
  return forms;
}

/// Whether the names from `first` on are those of one tensor of this form.
bool is_tensor(const std::vector<GridField> &scalars, const std::size_t first, const TensorForm &form) {
  const std::string &start = scalars[first].name;
  if (first + form.endings.size() > scalars.size() || start.size() <= 3)
    return false;
  const std::string base = start.substr(0, start.size() - 3);
  for (std::size_t k = 0; k < form.endings.size(); ++k)
    if (scalars[first + k].name != base + form.endings[k])
      return false;
  return true;
}

GridField join(const std::vector<GridField> &scalars, const std::size_t first, const TensorForm &form) {
  const std::string &start = scalars[first].name;
  const std::size_t n = form.places.size(), n_values = scalars[first].values.size();
  GridField tensor{start.substr(0, start.size() - 3), static_cast<unsigned int>(n), scalars[first].type,
                   std::vector<double>(n * n_values)};
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t i = 0; i < n_values; ++i)
      tensor.values[n * i + form.places[k]] = scalars[first + k].values[i];
  return tensor;
}

} // namespace

std::uint8_t vtk_cell_type(const unsigned int n_points) {
  constexpr std::uint8_t triangle = 5, polygon = 7, quadrilateral = 9, hexahedron = 12;
  switch (n_points) {
  case 3:
    return triangle;
  case 4:
    return quadrilateral;
  case 8:
    return hexahedron;
  default:
    return polygon;
  }
}

std::string escape_xml(const std::string &text) {
  std::string escaped;
  for (const char c : text)
    if (c == '&')
      escaped += "&amp;";
    else if (c == '<')
      escaped += "&lt;";
    else if (c == '>')
      escaped += "&gt;";
    else if (c == '"')
      escaped += "&quot;";
    else
      escaped += c;
  return escaped;
}

std::vector<GridField> join_components(std::vector<GridField> scalars) {
  std::vector<GridField> fields;
  for (std::size_t i = 0; i < scalars.size();) {
    const auto form = std::find_if(tensor_forms().begin(), tensor_forms().end(),
                                   [&](const TensorForm &tried) { return is_tensor(scalars, i, tried); });
    if (form == tensor_forms().end()) {
      fields.push_back(std::move(scalars[i++]));
      continue;
    }
    fields.push_back(join(scalars, i, *form));
    i += form->endings.size();
  }
  return fields;
}

} // namespace billet
