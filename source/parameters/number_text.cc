// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/number_text.h"

#include "billet/registered_type.h"

#include <regex>
#include <stdexcept>

namespace billet::parameters {

std::string number_remedy(const std::string &text) {
  static const std::regex thousands(R"([-+]?\d{1,3}([,' _]\d{3})+(\.\d*)?)"),
      decimal_comma(R"(([-+]?\d*),(\d+([eE][-+]?\d+)?))"),
      with_unit(R"(([-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?)\s*((?![eE][-+]?\d)[A-Za-z%].*))");
  std::smatch match;
  if (std::regex_match(text, thousands)) {
    std::string plain = std::regex_replace(text, std::regex("[,' _]"), "");
    // Few numbers that scenes need are 1,000 times another: '0,125' has a decimal comma.
    if (text.front() == '0' && std::regex_match(text, match, decimal_comma))
      return "; write " + match[1].str() + "." + match[2].str() + ", with a decimal point";
    return "; write " + plain + ", without separators of thousands";
  }
  if (std::regex_match(text, match, decimal_comma))
    return "; write " + (match[1].str().empty() ? "0" : match[1].str()) + "." + match[2].str() +
           ", with a decimal point";
  if (std::regex_match(text, match, with_unit))
    return "; write " + match[1].str() + ", without '" + match[4].str() +
           "': numbers have no units, and all of a scene use one consistent system";
  return "";
}

bool is_zero(const std::string &expression) {
  try {
    return parse_number(expression) == 0.;
  } catch (const std::invalid_argument &) {
    return false;
  }
}

} // namespace billet::parameters
