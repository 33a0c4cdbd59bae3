// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_TYPE_LISTS_H
#define BILLET_RUN_TYPE_LISTS_H

#include <ostream>
#include <string>
#include <vector>

namespace billet {

/// Prints what scene files can name, such as primitives, surfaces and loads, with their parameters.
/// The first of `names` is that of a list, the others are those of its entries. Without the others,
/// prints all entries, and without `names` the names of the lists. After "faces", `names` are CAD
/// files, whose faces it prints. Throws InputError for an unknown name or a file that cannot be
/// read.
void print_types(std::ostream &stream, const std::vector<std::string> &names, bool as_json);

} // namespace billet

#endif
