// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/csv_columns.h"
#include "billet/material/thermal_factor.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace billet {

ThermalFactorType tabulated_thermal_type();

namespace {

/// Piecewise linear factor through (temperature, factor) points, constant beyond both ends.
class TabulatedThermal final : public ThermalFactor {
public:
  explicit TabulatedThermal(std::vector<std::pair<double, double>> points) : points_(std::move(points)) {}

  std::string description() const override { return "times a table of the temperature"; }
  double value(const double temperature) const override {
    if (temperature <= points_.front().first)
      return points_.front().second;
    if (temperature >= points_.back().first)
      return points_.back().second;
    const auto &start = points_[segment(temperature)];
    return start.second + slope(temperature) * (temperature - start.first);
  }
  double slope(const double temperature) const override {
    if (temperature < points_.front().first || temperature >= points_.back().first)
      return 0.;
    const std::size_t i = segment(temperature);
    return (points_[i + 1].second - points_[i].second) / (points_[i + 1].first - points_[i].first);
  }

private:
  /// Returns the number of the point at the start of the segment, inside the table.
  std::size_t segment(const double temperature) const {
    const auto above =
        std::upper_bound(points_.begin(), points_.end(), temperature,
                         [](const double value, const auto &point) { return value < point.first; });
    return static_cast<std::size_t>(above - points_.begin()) - 1;
  }

  std::vector<std::pair<double, double>> points_;
};

/// Not a constant of the file: other files may ask for the type before it is made.
PointTable table() {
  return {"Thermal table", "temperature : factor",
          "Temperatures increase strictly; factors are > 0. The factor is constant beyond both "
          "ends. [temperature : -]"};
}

std::shared_ptr<const ThermalFactor> make_table(const TypeInput &input) {
  std::string key;
  std::vector<std::pair<double, double>> points;
  for (const auto &[temperature, factor] : table().read(input, key)) {
    if (!(factor > 0.))
      input.reject(key, "factors > 0");
    if (!points.empty() && !(temperature > points.back().first))
      input.reject(key, "temperatures that increase strictly");
    points.emplace_back(temperature, factor);
  }
  if (points.empty())
    input.reject(key, "at least one 'temperature : factor' pair");
  return std::make_shared<const TabulatedThermal>(std::move(points));
}

} // namespace

ThermalFactorType tabulated_thermal_type() {
  return {"table", "linear interpolation between points", table().parameters(), &make_table};
}

} // namespace billet
