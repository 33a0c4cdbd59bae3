// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_NEAREST_NAME_H
#define BILLET_NEAREST_NAME_H

#include <string>
#include <vector>

namespace billet {

/// Returns the known name that `name` most probably means; "" if none is near. Upper and lower case
/// count as equal. A name is near if at most a third of its letters are missing, added, different,
/// or exchanged with their neighbours. The one known name that begins with `name` comes before
/// those that differ by two letters or more.
std::string nearest_name(const std::string &name, const std::vector<std::string> &known);

/// Returns "; did you mean 'X'?" for messages; "" if no known name is near.
std::string did_you_mean(const std::string &name, const std::vector<std::string> &known);

} // namespace billet

#endif
