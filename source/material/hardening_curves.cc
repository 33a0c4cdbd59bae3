// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/hardening_curves.h"

#include "billet/material/csv_columns.h"

#include <algorithm>
#include <cmath>

namespace billet {

HardeningCurves::HardeningCurves(std::vector<double> strains, std::vector<double> values,
                                 std::vector<std::vector<double>> stresses)
    : strains_(std::move(strains)), values_(std::move(values)), stresses_(std::move(stresses)) {}

double HardeningCurves::factor(const double alpha, const double value) const {
  const Place strain = find(strains_, alpha), place = find(values_, value);
  return mix(place, stress(strain, place.i), stress(strain, place.next)) / stress(strain, 0);
}

std::pair<double, double> HardeningCurves::slopes(const double alpha, const double value) const {
  const Place strain = find(strains_, alpha), place = find(values_, value);
  const double from = stress(strain, place.i), to = stress(strain, place.next), first = stress(strain, 0);
  const double by_strain = mix(place, hardening(strain, place.i), hardening(strain, place.next)) -
                           mix(place, from, to) / first * hardening(strain, 0);
  return {place.length > 0. ? (to - from) / (place.length * first) : 0., by_strain / first};
}

HardeningCurves::Place HardeningCurves::find(const std::vector<double> &numbers, const double x) {
  const auto above = std::upper_bound(numbers.begin(), numbers.end(), x);
  const auto i = static_cast<std::size_t>(above - numbers.begin());
  if (i == 0 || i == numbers.size()) {
    const std::size_t end = i == 0 ? 0 : i - 1;
    return {end, end, 0., 0.};
  }
  const double length = numbers[i] - numbers[i - 1];
  return {i - 1, i, (x - numbers[i - 1]) / length, length};
}

double HardeningCurves::stress(const Place &strain, const std::size_t k) const {
  return mix(strain, stresses_[strain.i][k], stresses_[strain.next][k]);
}

double HardeningCurves::hardening(const Place &strain, const std::size_t k) const {
  return strain.length > 0. ? (stresses_[strain.next][k] - stresses_[strain.i][k]) / strain.length : 0.;
}

std::vector<TypeParameter> CurvesInput::parameters(const std::string &meaning) const {
  using Kind = TypeParameter::Kind;
  return {
      {values_key, "", Kind::text, meaning + " [" + unit + "]"},
      {file_key, "", Kind::text,
       "CSV file of the curves, relative to the scene file: plastic strains from 0, and yield stresses at "
       "each " +
           quantity + ". Lines before the first number and comments after '#' are skipped."},
      {columns_key, "1, 2, 3", Kind::text,
       "Columns of that file, from 1: the plastic strain, and the yield stress at each of '" + values_key +
           "'."}};
}

HardeningCurves
CurvesInput::read(const TypeInput &input, std::vector<double> values,
                  const std::function<void(const std::vector<double> &, const std::string &)> &check) const {
  const std::string allowed = "the column of the plastic strain and one for each of the " +
                              std::to_string(values.size()) + " '" + values_key + "', from 1 to 1000";
  if (input.numbers(columns_key).size() != values.size() + 1)
    input.reject(columns_key, allowed);
  std::vector<double> strains;
  std::vector<std::vector<double>> stresses;
  for (const auto &row : read_table(input, file_key, columns_key, allowed)) {
    const std::string at = "at the plastic strain " + std::to_string(row[0]);
    if (strains.empty() ? row[0] != 0. : !(row[0] > strains.back()))
      input.reject(file_key, "plastic strains that increase strictly from 0, as they do not " + at);
    strains.push_back(row[0]);
    stresses.emplace_back(row.begin() + 1, row.end());
    if (!(*std::min_element(stresses.back().begin(), stresses.back().end()) > 0.))
      input.reject(file_key, "yield stresses > 0, which it has not " + at);
    if (check)
      check(stresses.back(), at);
  }
  return {std::move(strains), std::move(values), std::move(stresses)};
}

} // namespace billet
