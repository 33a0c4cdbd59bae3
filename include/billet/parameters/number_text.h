// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_NUMBER_TEXT_H
#define BILLET_PARAMETERS_NUMBER_TEXT_H

#include <string>

namespace billet::parameters {

/// Returns how to write a text that should be a number, such as "; write 200000, without
/// separators" for '200,000'. Returns "" if there is no such advice.
std::string number_remedy(const std::string &text);

/// Whether an expression is the plain number 0; others that vanish are known only when evaluated.
bool is_zero(const std::string &expression);

} // namespace billet::parameters

#endif
