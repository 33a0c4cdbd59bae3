// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/forming_limit.h"

#include "billet/material/csv_columns.h"
#include "billet/material/interpolation.h"

#include <algorithm>

namespace billet {

namespace {

PointTable limit_table() {
  return {
      "Forming limit", "minor : major",
      "Logarithmic strains in the plane of a sheet at which it necks: minor ones increase strictly, major "
      "ones are > 0. The curve is constant beyond both ends. Empty: none. [- : -]"};
}

} // namespace

double FormingLimit::major_strain(const double minor_strain) const {
  return interpolate(points_, minor_strain);
}

std::vector<TypeParameter> FormingLimit::parameters() { return limit_table().parameters(); }

std::shared_ptr<const FormingLimit> FormingLimit::read(const TypeInput &input) {
  const auto names = parameters();
  if (std::none_of(names.begin(), names.end(), [&](const auto &name) { return input.is_set(name.key); }))
    return nullptr;
  std::string key;
  std::vector<std::array<double, 2>> points;
  for (const auto &[minor, major] : limit_table().read(input, key)) {
    if (!(major > 0.))
      input.reject(key, "major strains > 0");
    if (!points.empty() && !(minor > points.back()[0]))
      input.reject(key, "minor strains that increase strictly");
    points.push_back({minor, major});
  }
  if (points.empty())
    input.reject(key, "at least one 'minor : major' pair");
  return std::make_shared<const FormingLimit>(std::move(points));
}

} // namespace billet
