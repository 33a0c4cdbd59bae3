// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/csv_columns.h"
#include "billet/material/interpolation.h"
#include "billet/material/rate_factor.h"

#include <string>
#include <utility>

namespace billet {

RateFactorType tabulated_rate_type();

namespace {

/// Factor through points (rate, factor), from (0, 1) on, constant beyond the last one.
class TabulatedRate final : public RateFactor {
public:
  explicit TabulatedRate(CurvePoints points) : points_(std::move(points)) {}

  std::string description() const override { return "times a table of the rate"; }
  double value(const double rate) const override { return interpolate(points_, rate); }
  double slope(const double rate) const override { return find_slope(points_, rate); }

private:
  CurvePoints points_;
};

/// Not a constant of the file: other files may ask for the type before it is made.
PointTable rate_table() {
  return {"Rate table", "rate : factor",
          "Rates > 0 increase strictly; factors >= 1 do not decrease. The factor is 1 at rest, "
          "and constant beyond the last point. [1/time : -]"};
}

std::shared_ptr<const RateFactor> make_rate_table(const TypeInput &input) {
  std::string key;
  CurvePoints points = {{0., 1.}};
  for (const auto &[rate, factor] : rate_table().read(input, key)) {
    if (!(rate > points.back()[0]))
      input.reject(key, "rates > 0 that increase strictly");
    if (!(factor >= points.back()[1]))
      input.reject(key, "factors >= 1 that do not decrease");
    points.push_back({rate, factor});
  }
  if (points.size() == 1)
    input.reject(key, "at least one 'rate : factor' pair");
  return std::make_shared<const TabulatedRate>(std::move(points));
}

} // namespace

RateFactorType tabulated_rate_type() {
  return {"table", "linear interpolation between points, from 1 at rest", rate_table().parameters(),
          &make_rate_table};
}

} // namespace billet
