// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/thermal_factor.h"

namespace billet {

ThermalFactorType johnson_cook_thermal_type();
ThermalFactorType tabulated_thermal_type();
ThermalFactorType thermal_curves_type();

TypeTable<std::shared_ptr<const ThermalFactor>> &thermal_factor_types() {
  static TypeTable<std::shared_ptr<const ThermalFactor>> types{
      {"none", "1", {}, [](const TypeInput &) { return nullptr; }},
      johnson_cook_thermal_type(),
      tabulated_thermal_type(),
      thermal_curves_type()};
  return types;
}

} // namespace billet
