// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_REGISTERED_H
#define BILLET_PARAMETERS_REGISTERED_H

#include "billet/parameters/reader.h"

#include <deal.II/base/parameter_handler.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace billet::parameters {

/// Declares one parameter of a registered type. `meaning` may differ from the parameter's own.
void declare_parameter(dealii::ParameterHandler &prm, const TypeParameter &parameter,
                       const std::string &meaning);

/// Joins the parameters of all types. A meaning begins with the names of the types that use it,
/// unless all do.
class ParameterUnion {
public:
  void add(const std::string &type, const std::vector<TypeParameter> &parameters);
  void declare(dealii::ParameterHandler &prm) const;
  /// Whether the user set one of the parameters.
  bool is_any_set(const std::function<bool(const std::string &)> &is_set) const;
  /// Refuses each parameter that the user set and that is not in `used`. `reason` follows "no
  /// value: "; `selector` is the parameter that selects the type, if `reason` does not quote it.
  void reject_unused(const Reader &reader, const std::vector<TypeParameter> &used, const std::string &reason,
                     const std::string &selector = "") const;

private:
  struct Entry {
    TypeParameter parameter;
    std::string users;
    unsigned int n_users;
  };
  std::vector<Entry> entries_;
  unsigned int n_types_ = 0;
};

template <class Table> ParameterUnion join_parameters(const Table &table) {
  ParameterUnion all;
  for (const auto &type : table)
    all.add(type.name, type.parameters);
  return all;
}

/// Declares the entry `key`, which selects one type of the table, and the parameters of all its
/// types.
template <class Table>
void declare_selection(dealii::ParameterHandler &prm, const std::string &key, const std::string &default_name,
                       const Table &table, const std::string &meaning) {
  std::string text = meaning;
  for (const auto &type : table)
    text += (&type == &*table.begin() ? " " : ". ") + type.name + ": " + type.meaning;
  prm.declare_entry(key, default_name, dealii::Patterns::Selection(table.names()), text + ".");
  join_parameters(table).declare(prm);
}

/// Refuses the selection and all its parameters. `reason` follows "no value: ".
template <class Table>
void reject_selection(const Reader &reader, const std::string &key, const Table &table,
                      const std::string &reason) {
  if (reader.is_set(key))
    reader.reject(key, "no value: " + reason);
  join_parameters(table).reject_unused(reader, {}, reason);
}

/// Returns the type that `key` selects. Refuses parameters of the other types.
template <class Table>
const auto &find_selected(const Reader &reader, const std::string &key, const Table &table) {
  const auto *type = table.find(reader.text(key));
  if (type == nullptr) // the selection has refused all other names
    throw std::logic_error("unknown type '" + reader.text(key) + "'");
  join_parameters(table).reject_unused(reader, type->parameters,
                                       "'" + key + " = " + type->name + "' does not use it");
  return *type;
}

/// Makes the product that `key` selects.
template <class Table> auto make_selected(const Reader &reader, const std::string &key, const Table &table) {
  return find_selected(reader, key, table).make(reader);
}

} // namespace billet::parameters

#endif
