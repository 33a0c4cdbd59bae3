// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_THERMAL_FACTOR_H
#define BILLET_MATERIAL_THERMAL_FACTOR_H

#include "billet/registered_type.h"

#include <memory>
#include <string>
#include <utility>

namespace billet {

/// Factor of the flow stress as a function of the temperature.
class ThermalFactor {
public:
  virtual ~ThermalFactor() = default;

  /// Returns a description that follows that of the flow stress, such as "times Johnson and Cook's
  /// factor of the temperature".
  virtual std::string description() const = 0;
  /// Returns the factor, which is positive.
  virtual double value(double temperature) const = 0;
  /// Returns the derivative of value() [1/temperature].
  virtual double slope(double temperature) const = 0;
  /// Returns the factor at an equivalent plastic strain, for factors that depend on it, too.
  virtual double value_at(double /*alpha*/, const double temperature) const { return value(temperature); }
  /// Returns the derivatives of value_at() by the temperature [1/temperature] and by the plastic
  /// strain.
  virtual std::pair<double, double> slopes_at(double /*alpha*/, const double temperature) const {
    return {slope(temperature), 0.};
  }
};

/// Thermal factors that a scene file can name; "none" makes a null pointer. A new one is a file in
/// source/material/ with a function that returns its type, and its name in the table of
/// thermal_factor.cc.
using ThermalFactorType = RegisteredType<std::shared_ptr<const ThermalFactor>>;
TypeTable<std::shared_ptr<const ThermalFactor>> &thermal_factor_types();

} // namespace billet

#endif
