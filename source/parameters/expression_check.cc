// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/expression_check.h"

#include "billet/errors.h"
#include "billet/without_traps.h"

#include <deal.II/base/function_parser.h>

#include <algorithm>
#include <iostream>
#include <map>
#include <sstream>

namespace billet {

namespace {

/// Whether the text has a comma outside parentheses. muParser would read "0,1" as two values and return the
/// last; its author meant 0.1.
bool has_free_comma(const std::string &text) {
  int depth = 0;
  return std::any_of(text.begin(), text.end(), [&depth](const char c) {
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    return c == ',' && depth == 0;
  });
}

/// Whether muParser can evaluate the text, whatever its value.
bool can_be_evaluated(const std::string &text, const ExpressionVariables variables,
                      const std::vector<parameters::Amplitude> &amplitudes) {
  std::map<std::string, double> constants{{"pi", dealii::numbers::PI}};
  for (const auto &amplitude : amplitudes)
    constants[amplitude.name] = 1.;
  // deal.II also prints muParser's errors to the console.
  std::ostringstream complaints;
  std::streambuf *console = std::cerr.rdbuf(complaints.rdbuf());
  bool makes_sense = true;
  try {
    const WithoutTraps quiet;
    dealii::FunctionParser<3> parser(1);
    parser.initialize(parser_variables(variables), text, constants, true);
    parser.value(dealii::Point<3>());
  } catch (...) { // muParser's exceptions are no std::exception
    makes_sense = false;
  }
  std::cerr.rdbuf(console);
  return makes_sense;
}

} // namespace

std::string parser_variables(const ExpressionVariables variables) {
  return variables == ExpressionVariables::time ? "_no_x,_no_y,_no_z,t" : "x,y,z,t";
}

void check_expression(const std::string &text, const ExpressionVariables variables,
                      const std::vector<parameters::Amplitude> &amplitudes, const std::string &origin) {
  if (!has_free_comma(text) && can_be_evaluated(text, variables, amplitudes))
    return;
  std::string allowed = variables == ExpressionVariables::time ? "t, pi" : "x, y, z, t, pi";
  for (const auto &amplitude : amplitudes)
    allowed += ", " + amplitude.name;
  throw InputError(origin + " contains '" + text + "'; allowed is a muParser expression of " + allowed);
}

} // namespace billet
