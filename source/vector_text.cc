// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/vector_text.h"

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cctype>

namespace billet {

std::vector<std::string> split_vector(const std::string &text) {
  const auto is_digit = [&text](const std::size_t i) {
    return i < text.size() && std::isdigit(static_cast<unsigned char>(text[i])) != 0;
  };
  const char separator = text.find(';') != std::string::npos ? ';' : ',';
  std::vector<std::string> parts(1);
  int depth = 0;
  bool may_be_decimal = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    depth += text[i] == '(' ? 1 : text[i] == ')' ? -1 : 0;
    if (text[i] == separator && (separator == ';' || depth == 0)) {
      may_be_decimal = separator == ',' && i > 0 && is_digit(i - 1) && is_digit(i + 1);
      parts.emplace_back();
    } else
      parts.back() += text[i];
  }
  if (may_be_decimal && parts.size() == 2)
    parts = {text};
  for (std::string &part : parts)
    part = dealii::Utilities::trim(part);
  if (parts.back().empty())
    parts.pop_back();
  return parts;
}

bool has_empty_component(const std::vector<std::string> &components) {
  return std::any_of(components.begin(), components.end(), [](const auto &one) { return one.empty(); });
}

std::vector<std::string> read_expressions(const TypeInput &input, const std::string &key) {
  std::vector<std::string> result = split_vector(input.text(key));
  if (result.size() != 3 || has_empty_component(result))
    input.reject(key, "three expressions, separated by commas or semicolons, such as '0 ; 0 ; 0.5*t'");
  return result;
}

} // namespace billet
