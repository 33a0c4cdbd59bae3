// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_RENAMES_H
#define BILLET_PARAMETERS_RENAMES_H

#include <string>
#include <utility>
#include <vector>

namespace billet {

/// Parameter that had another name, or values with other names. Scenes may use the old ones until
/// version 1.0.
struct Rename {
  std::vector<std::string> path; ///< the subsections; "*" stands for a name of the user's choice
  std::string old_key, key;
  /// Old and new name of each value that changed.
  std::vector<std::pair<std::string, std::string>> values;
};

/// Returns the table of all renamed parameters, the only place with old names.
const std::vector<Rename> &renames();

/// Current names of a parameter and its value.
struct CurrentNames {
  std::string key, value;
};

/// Returns the current names of a parameter and of its value. Names that are not old remain
/// unchanged.
CurrentNames current_names(const std::vector<std::string> &path, const std::string &key,
                           const std::string &value);

} // namespace billet

#endif
