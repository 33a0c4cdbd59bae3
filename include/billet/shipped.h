// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SHIPPED_H
#define BILLET_SHIPPED_H

#include <string>
#include <vector>

namespace billet {

/// Returns the first of these files or folders that exists, seen from a folder above the program.
/// This folder is the prefix where the program is installed, or the sources around the folder in
/// which it was built. Returns "" if there is none.
std::string find_shipped(const std::vector<std::string> &places);

} // namespace billet

#endif
