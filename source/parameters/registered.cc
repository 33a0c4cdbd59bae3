// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/registered.h"

namespace billet::parameters {

namespace Patterns = dealii::Patterns;

void declare_parameter(dealii::ParameterHandler &prm, const TypeParameter &parameter,
                       const std::string &meaning) {
  switch (parameter.kind) {
  case TypeParameter::Kind::number:
    prm.declare_entry(parameter.key, parameter.default_value, Patterns::Double(), meaning);
    break;
  case TypeParameter::Kind::text:
    prm.declare_entry(parameter.key, parameter.default_value, Patterns::Anything(), meaning);
    break;
  case TypeParameter::Kind::flag:
    prm.declare_entry(parameter.key, parameter.default_value, Patterns::Bool(), meaning);
    break;
  case TypeParameter::Kind::choice:
    prm.declare_entry(parameter.key, parameter.default_value,
                      Patterns::Selection(parameter.meaning.substr(0, parameter.meaning.find(':'))), meaning);
    break;
  }
}

void ParameterUnion::add(const std::string &type, const std::vector<TypeParameter> &parameters) {
  ++n_types_;
  for (const TypeParameter &parameter : parameters) {
    const auto known = std::find_if(entries_.begin(), entries_.end(),
                                    [&](const Entry &entry) { return entry.parameter.key == parameter.key; });
    if (known == entries_.end())
      entries_.push_back({parameter, type, 1});
    else {
      known->users += ", " + type;
      ++known->n_users;
    }
  }
}

void ParameterUnion::declare(dealii::ParameterHandler &prm) const {
  for (const Entry &entry : entries_)
    declare_parameter(prm, entry.parameter,
                      (entry.n_users == n_types_ ? "" : entry.users + ": ") + entry.parameter.meaning);
}

bool ParameterUnion::is_any_set(const std::function<bool(const std::string &)> &is_set) const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [&](const Entry &entry) { return is_set(entry.parameter.key); });
}

void ParameterUnion::reject_unused(const Reader &reader, const std::vector<TypeParameter> &used,
                                   const std::string &reason, const std::string &selector) const {
  for (const Entry &entry : entries_) {
    const std::string &key = entry.parameter.key;
    const bool is_used = std::any_of(used.begin(), used.end(),
                                     [&](const TypeParameter &parameter) { return parameter.key == key; });
    if (is_used || !reader.is_set(key))
      continue;
    if (selector.empty())
      reader.reject(key, "no value: " + reason);
    reader.reject_beside({selector}, key, "no value: " + reason);
  }
}

} // namespace billet::parameters
