// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/csv_columns.h"
#include "billet/material/rate_factor.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace billet {

RateFactorType tabulated_rate_type();

namespace {

/// Piecewise linear factor through (rate, factor) points, from (0, 1) on, constant beyond the last one.
class TabulatedRate final : public RateFactor {
public:
  explicit TabulatedRate(std::vector<std::pair<double, double>> points) : points_(std::move(points)) {}

  std::string description() const override { return "times a table of the rate"; }
  double value(const double rate) const override {
    const auto &start = points_[segment(rate)];
    return start.second + slope(rate) * (rate - start.first);
  }
  double slope(const double rate) const override {
    const std::size_t i = segment(rate);
    return i + 1 == points_.size()
               ? 0.
               : (points_[i + 1].second - points_[i].second) / (points_[i + 1].first - points_[i].first);
  }

private:
  /// Returns the number of the last point at or below a rate >= 0.
  std::size_t segment(const double rate) const {
    const auto above =
        std::upper_bound(points_.begin(), points_.end(), rate,
                         [](const double value, const auto &point) { return value < point.first; });
    return static_cast<std::size_t>(above - points_.begin()) - 1;
  }

  std::vector<std::pair<double, double>> points_;
};

/// Not a constant of the file: other files may ask for the type before it is made.
PointTable table() {
  return {"Rate table", "rate : factor",
          "Rates > 0 increase strictly; factors >= 1 do not decrease. The factor is 1 at rest, "
          "and constant beyond the last point. [1/time : -]"};
}

std::shared_ptr<const RateFactor> make_table(const TypeInput &input) {
  std::string key;
  std::vector<std::pair<double, double>> points = {{0., 1.}};
  for (const auto &[rate, factor] : table().read(input, key)) {
    if (!(rate > points.back().first))
      input.reject(key, "rates > 0 that increase strictly");
    if (!(factor >= points.back().second))
      input.reject(key, "factors >= 1 that do not decrease");
    points.emplace_back(rate, factor);
  }
  if (points.size() == 1)
    input.reject(key, "at least one 'rate : factor' pair");
  return std::make_shared<const TabulatedRate>(std::move(points));
}

} // namespace

RateFactorType tabulated_rate_type() {
  return {"table", "linear interpolation between points, from 1 at rest", table().parameters(), &make_table};
}

} // namespace billet
