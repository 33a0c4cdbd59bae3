// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/csv_columns.h"
#include "billet/material/interpolation.h"
#include "billet/material/thermal_factor.h"

#include <string>
#include <utility>

namespace billet {

ThermalFactorType tabulated_thermal_type();

namespace {

/// Factor through points (temperature, factor), constant beyond both ends.
class TabulatedThermal final : public ThermalFactor {
public:
  explicit TabulatedThermal(CurvePoints points) : points_(std::move(points)) {}

  std::string description() const override { return "times a table of the temperature"; }
  double value(const double temperature) const override { return interpolate(points_, temperature); }
  double slope(const double temperature) const override { return find_slope(points_, temperature); }

private:
  CurvePoints points_;
};

/// Not a constant of the file: other files may ask for the type before it is made.
PointTable thermal_table() {
  return {"Thermal table", "temperature : factor",
          "Temperatures increase strictly; factors are > 0. The factor is constant beyond both "
          "ends. [temperature : -]"};
}

std::shared_ptr<const ThermalFactor> make_thermal_table(const TypeInput &input) {
  std::string key;
  CurvePoints points;
  for (const auto &[temperature, factor] : thermal_table().read(input, key)) {
    if (!(factor > 0.))
      input.reject(key, "factors > 0");
    if (!points.empty() && !(temperature > points.back()[0]))
      input.reject(key, "temperatures that increase strictly");
    points.push_back({temperature, factor});
  }
  if (points.empty())
    input.reject(key, "at least one 'temperature : factor' pair");
  return std::make_shared<const TabulatedThermal>(std::move(points));
}

} // namespace

ThermalFactorType tabulated_thermal_type() {
  return {"table", "linear interpolation between points", thermal_table().parameters(), &make_thermal_table};
}

} // namespace billet
