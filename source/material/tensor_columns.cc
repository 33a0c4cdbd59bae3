// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/tensor_columns.h"

namespace billet {

namespace {

std::vector<std::string> components_of(const std::string &tensor) {
  std::vector<std::string> names;
  for (const char *const component : {"xx", "yy", "zz", "xy", "xz", "yz"})
    names.push_back(tensor + "_" + component);
  return names;
}

} // namespace

std::vector<std::string> stress_columns() {
  std::vector<std::string> names = components_of("stress");
  names.insert(names.end(), {"von_mises_stress", "pressure"});
  return names;
}

std::vector<std::string> strain_columns() { return components_of("logarithmic_strain"); }

} // namespace billet
