// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/node_selection.h"

#include <deal.II/base/utilities.h>

#include <optional>
#include <stdexcept>

namespace billet {

const char *const node_selection_meaning =
    "Nodes, separated by semicolons. 'at x, y, z' is the node at an undeformed position. 'on line x, y, z : "
    "x, y, z' are all nodes on a segment, from its first end to its second. 'set NAME' are those of a node "
    "set of the mesh file.";

namespace {

constexpr auto allowed = "'at x, y, z', 'on line x, y, z : x, y, z' or 'set NAME', separated by semicolons";

/// Returns what follows the word at the beginning of a text; none if it begins otherwise.
std::optional<std::string> text_after(const std::string &word, const std::string &text) {
  if (text.rfind(word + " ", 0) != 0)
    return std::nullopt;
  return dealii::Utilities::trim(text.substr(word.size()));
}

dealii::Tensor<1, 3> read_point(const Reader &reader, const std::string &key, const std::string &text) {
  const auto numbers = dealii::Utilities::split_string_list(text, ',');
  if (numbers.size() != 3)
    reader.reject(key, allowed);
  dealii::Tensor<1, 3> point;
  try {
    for (unsigned int i = 0; i < 3; ++i)
      point[i] = parse_number(numbers[i]);
  } catch (const std::invalid_argument &) {
    reader.reject(key, allowed);
  }
  return point;
}

} // namespace

NodeSelection read_nodes(const Reader &reader, const std::string &key) {
  NodeSelection nodes;
  nodes.origin = reader.origin(key);
  for (const std::string &part : reader.parts(key)) {
    if (const auto point = text_after("at", part))
      nodes.points.push_back(read_point(reader, key, *point));
    else if (const auto name = text_after("set", part))
      nodes.sets.push_back(*name);
    else if (const auto line = text_after("on line", part)) {
      const auto ends = dealii::Utilities::split_string_list(*line, ':');
      if (ends.size() != 2)
        reader.reject(key, allowed);
      nodes.lines.push_back({read_point(reader, key, ends[0]), read_point(reader, key, ends[1])});
      if (nodes.lines.back()[0] == nodes.lines.back()[1])
        reader.reject(key, "a line between two different points; 'at x, y, z' is one point");
    } else
      reader.reject(key, allowed);
  }
  return nodes;
}

} // namespace billet
