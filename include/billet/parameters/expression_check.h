// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_EXPRESSION_CHECK_H
#define BILLET_PARAMETERS_EXPRESSION_CHECK_H

#include "billet/parameters/control.h"

#include <string>
#include <vector>

namespace billet {

/// Names that an expression may contain beside pi and those of amplitudes.
enum class ExpressionVariables { time, time_and_position };

/// Returns the names of x, y, z and t for muParser. It needs three coordinates: where they are not
/// allowed, they have names that users cannot choose.
std::string parser_variables(ExpressionVariables variables);

/// Refuses a text that is no muParser expression of these variables. Throws InputError, beginning
/// with `origin`.
void check_expression(const std::string &text, ExpressionVariables variables,
                      const std::vector<parameters::Amplitude> &amplitudes, const std::string &origin);

} // namespace billet

#endif
