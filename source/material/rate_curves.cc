// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/csv_columns.h"
#include "billet/material/rate_factor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace billet {

RateFactorType rate_curves_type();

namespace {

/// Measured curves of hardening at several rates, as a factor over the first curve, (H19) of doc/theory.md.
/// Curves are linear between points, and the factor in the logarithm of the rate; beyond both ends they are
/// constant.
class RateCurves final : public RateFactor {
public:
  /// `stresses[i][k]`: at strain i and rate k. Strains and rates increase strictly.
  RateCurves(std::vector<double> strains, const std::vector<double> &rates,
             std::vector<std::vector<double>> stresses)
      : strains_(std::move(strains)), stresses_(std::move(stresses)) {
    for (const double rate : rates)
      logarithms_.push_back(std::log(rate));
  }

  std::string description() const override {
    return "times curves at " + std::to_string(logarithms_.size()) + " rates";
  }
  double value(const double rate) const override { return value_at(0., rate); }
  double slope(const double rate) const override { return slopes_at(0., rate).first; }

  double value_at(const double alpha, const double rate) const override {
    const Place strain = find(strains_, alpha), speed = find(logarithms_, std::log(rate));
    return mix(speed, stress(strain, speed.i), stress(strain, speed.next)) / stress(strain, 0);
  }
  std::pair<double, double> slopes_at(const double alpha, const double rate) const override {
    const Place strain = find(strains_, alpha), speed = find(logarithms_, std::log(rate));
    const double slow = stress(strain, speed.i), fast = stress(strain, speed.next), first = stress(strain, 0);
    const double by_strain = mix(speed, hardening(strain, speed.i), hardening(strain, speed.next)) -
                             mix(speed, slow, fast) / first * hardening(strain, 0);
    return {speed.length > 0. ? (fast - slow) / (speed.length * rate * first) : 0., by_strain / first};
  }

private:
  /// Place between two numbers; at the ends, and beyond them, both are the same and the length is 0.
  struct Place {
    std::size_t i, next;
    double part, length;
  };
  static Place find(const std::vector<double> &numbers, const double x) {
    const auto above = std::upper_bound(numbers.begin(), numbers.end(), x);
    const auto i = static_cast<std::size_t>(above - numbers.begin());
    if (i == 0 || i == numbers.size()) {
      const std::size_t end = i == 0 ? 0 : i - 1;
      return {end, end, 0., 0.};
    }
    const double length = numbers[i] - numbers[i - 1];
    return {i - 1, i, (x - numbers[i - 1]) / length, length};
  }

  static double mix(const Place &place, const double from, const double to) {
    return (1. - place.part) * from + place.part * to;
  }
  double stress(const Place &strain, const std::size_t k) const {
    return mix(strain, stresses_[strain.i][k], stresses_[strain.next][k]);
  }
  double hardening(const Place &strain, const std::size_t k) const {
    return strain.length > 0. ? (stresses_[strain.next][k] - stresses_[strain.i][k]) / strain.length : 0.;
  }

  std::vector<double> strains_, logarithms_;
  std::vector<std::vector<double>> stresses_;
};

constexpr const char *rates_key = "Curve rates", *file_key = "Curves file", *columns_key = "Curves columns";

std::string print_strain(const double strain) { return "at the plastic strain " + std::to_string(strain); }

void check_stresses(const TypeInput &input, const std::vector<double> &row) {
  for (std::size_t k = 1; k < row.size(); ++k) {
    if (!(row[k] > 0.))
      input.reject(file_key, "yield stresses > 0, which it has not " + print_strain(row[0]));
    if (k > 1 && !(row[k] >= row[k - 1]))
      input.reject(file_key, "curves that do not fall with the rate, as one does " + print_strain(row[0]));
  }
}

std::shared_ptr<const RateFactor> make_curves(const TypeInput &input) {
  const std::vector<double> rates = input.numbers(rates_key);
  if (rates.size() < 2 || !(rates.front() > 0.) ||
      std::adjacent_find(rates.begin(), rates.end(), std::greater_equal<>()) != rates.end())
    input.reject(rates_key, "at least two rates > 0 that increase strictly");
  const std::string allowed = "the column of the plastic strain and one for each of the " +
                              std::to_string(rates.size()) + " 'Curve rates', from 1 to 1000";
  if (input.numbers(columns_key).size() != rates.size() + 1)
    input.reject(columns_key, allowed);
  std::vector<double> strains;
  std::vector<std::vector<double>> stresses;
  for (const auto &row : read_table(input, file_key, columns_key, allowed)) {
    if (strains.empty() ? row[0] != 0. : !(row[0] > strains.back()))
      input.reject(file_key,
                   "plastic strains that increase strictly from 0, as they do not " + print_strain(row[0]));
    strains.push_back(row[0]);
    check_stresses(input, row);
    stresses.emplace_back(row.begin() + 1, row.end());
  }
  return std::make_shared<const RateCurves>(std::move(strains), rates, std::move(stresses));
}

} // namespace

RateFactorType rate_curves_type() {
  using Kind = TypeParameter::Kind;
  return {
      "curves",
      "curves of hardening at several rates, over the first one",
      {{rates_key, "", Kind::text,
        "At least two rates > 0 that increase strictly, one for each curve. The factor is 1 up to the first "
        "one, and constant beyond the last one. [1/time]"},
       {file_key, "", Kind::text,
        "CSV file of the curves, relative to the scene file: plastic strains from 0, and yield stresses at "
        "each rate. Lines before the first number and comments after '#' are skipped."},
       {columns_key, "1, 2, 3", Kind::text,
        "Columns of that file, from 1: the plastic strain, and the yield stress at each of 'Curve rates'."}},
      &make_curves};
}

} // namespace billet
