// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_VECTOR_TEXT_H
#define BILLET_VECTOR_TEXT_H

#include "billet/registered_type.h"

#include <string>
#include <vector>

namespace billet {

/// Returns the trimmed components of a vector. They stand between semicolons or, without these,
/// between commas outside parentheses, so that 'atan2(y, x), 0, t' has three. "0,5" stays one: it
/// may be a number with a decimal comma. An empty text has none, and a separator at the end begins
/// none.
std::vector<std::string> split_vector(const std::string &text);

/// Whether any component is empty, as in '0 ; ; 1'.
bool has_empty_component(const std::vector<std::string> &components);

/// Returns the three expressions of the parameter `key`. Refuses other numbers of them.
std::vector<std::string> read_expressions(const TypeInput &input, const std::string &key);

} // namespace billet

#endif
