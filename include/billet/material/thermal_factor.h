// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_THERMAL_FACTOR_H
#define BILLET_MATERIAL_THERMAL_FACTOR_H

#include "billet/registered_type.h"

#include <memory>
#include <string>

namespace billet {

/// Factor of the flow stress as a function of the temperature.
class ThermalFactor {
public:
  virtual ~ThermalFactor() = default;

  /// Returns a description that follows that of the flow stress, such as "times Johnson and Cook's factor of
  /// the temperature".
  virtual std::string description() const = 0;
  /// Returns the factor, which is positive.
  virtual double value(double temperature) const = 0;
  /// Returns the derivative of value() [1/temperature].
  virtual double slope(double temperature) const = 0;
};

/// Thermal factors that a scene file can name; "none" makes a null pointer. A new one is a file in
/// source/material/ with a function that returns its type, and its name in the table of thermal_factor.cc.
using ThermalFactorType = RegisteredType<std::shared_ptr<const ThermalFactor>>;
TypeTable<std::shared_ptr<const ThermalFactor>> &thermal_factor_types();

} // namespace billet

#endif
