// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/expression_check.h"

#include "billet/errors.h"
#include "billet/scene_fault.h"
#include "billet/without_traps.h"

#include <deal.II/base/function_parser.h>

#include <algorithm>
#include <cctype>
#include <iostream>
#include <iterator>
#include <map>
#include <sstream>
#include <vector>

namespace billet {

namespace {

/// Whether the text has a comma outside parentheses. muParser would read "0,1" as two values and
/// return the last; its author meant 0.1.
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

/// Returns the first name of a text, other than of functions, that is none of these; empty if there
/// is none.
std::string find_unknown_name(const std::string &text, const std::vector<std::string> &known) {
  const auto is_of_name = [](const char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
  };
  for (auto begin = text.begin(); begin != text.end();) {
    const auto end = std::find_if_not(begin, text.end(), is_of_name);
    const std::string word(begin, end);
    const auto next = std::find_if(end, text.end(), [](const char c) { return c != ' '; });
    const bool is_name =
        !word.empty() && (std::isalpha(static_cast<unsigned char>(word[0])) != 0 || word[0] == '_');
    const bool is_function = next != text.end() && *next == '(';
    if (is_name && !is_function && std::find(known.begin(), known.end(), word) == known.end())
      return word;
    begin = end == text.end() ? end : std::max(end, std::next(begin));
  }
  return "";
}

} // namespace

std::string parser_variables(const ExpressionVariables variables) {
  return variables == ExpressionVariables::time ? "_no_x,_no_y,_no_z,t" : "x,y,z,t";
}

void check_expression(const std::string &text, const ExpressionVariables variables,
                      const std::vector<parameters::Amplitude> &amplitudes, const std::string &origin) {
  if (!has_free_comma(text) && can_be_evaluated(text, variables, amplitudes))
    return;
  std::vector<std::string> known{"t", "pi"};
  if (variables != ExpressionVariables::time)
    known.insert(known.begin(), {"x", "y", "z"});
  for (const auto &amplitude : amplitudes)
    known.push_back(amplitude.name);
  std::string allowed;
  for (const std::string &name : known)
    allowed += (allowed.empty() ? "" : ", ") + name;
  const std::string unknown = find_unknown_name(text, known);
  SceneFault fault{SceneFault::Kind::wrong_value};
  if (!unknown.empty())
    fault.depends_on.push_back(unknown);
  throw InputError(scene_error(origin + " contains '" + text + "'; allowed is a muParser expression of " +
                                   allowed +
                                   (has_free_comma(text) ? ". Write decimals with a point, not with a comma"
                                    : unknown.empty()    ? ""
                                                         : "; '" + unknown + "' is unknown"),
                               fault));
}

} // namespace billet
