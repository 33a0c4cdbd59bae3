// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/registered_type.h"

#include <deal.II/base/utilities.h>

#include <cmath>
#include <limits>

namespace billet {

double parse_number(const std::string &text) {
  double value = std::numeric_limits<double>::quiet_NaN();
  try {
    value = dealii::Utilities::string_to_double(text);
  } catch (const std::exception &) { // deal.II throws various types
  }
  if (!std::isfinite(value))
    throw std::invalid_argument("'" + text + "' is not a finite number");
  return value;
}

} // namespace billet
