// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_NAMED_VALUES_H
#define BILLET_PARAMETERS_NAMED_VALUES_H

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace billet::parameters {

/// Values of a parameter and their names in scene files, in the order of the documentation.
template <class Value> using NamedValues = std::vector<std::pair<std::string, Value>>;

/// Returns all names, as dealii::Patterns::Selection takes them: "name|name|name".
template <class Value> std::string selection(const NamedValues<Value> &values) {
  std::string result;
  for (const auto &entry : values)
    result += (result.empty() ? "" : "|") + entry.first;
  return result;
}

/// Returns the value with this name; nothing if there is none.
template <class Value>
std::optional<Value> find_value(const NamedValues<Value> &values, const std::string &name) {
  for (const auto &entry : values)
    if (entry.first == name)
      return entry.second;
  return std::nullopt;
}

/// Returns the value with this name. Throws std::logic_error if there is none: the selection
/// refuses such names before.
template <class Value> Value chosen(const NamedValues<Value> &values, const std::string &name) {
  if (const std::optional<Value> value = find_value(values, name))
    return *value;
  throw std::logic_error("'" + name + "' is none of " + selection(values));
}

/// Returns the first name of this value.
template <class Value> const std::string &name_in(const NamedValues<Value> &values, const Value &value) {
  for (const auto &entry : values)
    if (entry.second == value)
      return entry.first;
  throw std::logic_error("a value has no name; there are " + selection(values));
}

} // namespace billet::parameters

#endif
