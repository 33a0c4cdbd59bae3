// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/renames.h"

#include <algorithm>

namespace billet {

const std::vector<Rename> &renames() {
  static const std::vector<Rename> table = {
      {{"Solver"}, "Most iterations", "Maximum iterations", {}},
      {{"Solver"}, "Most augmentations", "Maximum augmentations", {}},
  };
  return table;
}

namespace {

bool matches(const std::vector<std::string> &pattern, const std::vector<std::string> &path) {
  return std::equal(pattern.begin(), pattern.end(), path.begin(), path.end(),
                    [](const std::string &expected, const std::string &name) {
                      return expected == "*" || expected == name;
                    });
}

} // namespace

CurrentNames current_names(const std::vector<std::string> &path, const std::string &key,
                           const std::string &value) {
  const auto rename = std::find_if(renames().begin(), renames().end(), [&](const Rename &candidate) {
    return (key == candidate.old_key || key == candidate.key) && matches(candidate.path, path);
  });
  if (rename == renames().end())
    return {key, value};
  const auto renamed_value = std::find_if(rename->values.begin(), rename->values.end(),
                                          [&](const auto &names) { return names.first == value; });
  return {rename->key, renamed_value == rename->values.end() ? value : renamed_value->second};
}

} // namespace billet
