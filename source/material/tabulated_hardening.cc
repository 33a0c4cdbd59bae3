// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/csv_columns.h"
#include "billet/material/hardening.h"

#include <algorithm>
#include <array>
#include <sstream>

namespace billet {

HardeningType tabulated_hardening_type();

TabulatedHardening::TabulatedHardening(std::vector<double> strains, std::vector<double> stresses)
    : strains_(std::move(strains)), stresses_(std::move(stresses)), works_(strains_.size(), 0.) {
  for (std::size_t i = 1; i < strains_.size(); ++i)
    works_[i] = works_[i - 1] + 0.5 * (stresses_[i] + stresses_[i - 1]) * (strains_[i] - strains_[i - 1]);
}

double TabulatedHardening::stress(const double a) const {
  const std::size_t i = segment(a);
  return stresses_[i] + slope_of(i) * (a - strains_[i]);
}

double TabulatedHardening::slope(const double a) const { return slope_of(segment(a)); }

double TabulatedHardening::work(const double a) const {
  const std::size_t i = segment(a);
  const double da = a - strains_[i];
  return works_[i] + (stresses_[i] + 0.5 * slope_of(i) * da) * da;
}

std::size_t TabulatedHardening::segment(const double a) const {
  const auto second = strains_.begin() + 1;
  return static_cast<std::size_t>(std::upper_bound(second, strains_.end(), a) - second);
}

double TabulatedHardening::slope_of(const std::size_t i) const {
  return i + 1 < strains_.size() ? (stresses_[i + 1] - stresses_[i]) / (strains_[i + 1] - strains_[i]) : 0.;
}

namespace {

using Points = std::vector<std::array<double, 2>>;

Points read_points(const TypeInput &input) {
  if (!input.text("Table file").empty()) {
    if (input.is_set("Table"))
      input.reject("Table", "no value: the points come from 'Table file'");
    return read_columns(input, "Table file", "Table columns");
  }
  if (input.is_set("Table columns"))
    input.reject("Table columns", "no value: there is no 'Table file'");
  return read_pairs(input, "Table", "strain : stress");
}

std::string print(const double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

std::shared_ptr<const HardeningLaw> make_table(const TypeInput &input) {
  const std::string key = input.text("Table file").empty() ? "Table" : "Table file";
  std::vector<double> strains, stresses;
  for (const auto &[strain, stress] : read_points(input)) {
    if (strains.empty() && strain != 0.)
      input.reject(key, "a curve that starts at plastic strain 0");
    if (!(stress > 0.))
      input.reject(key, "yield stresses > 0");
    if (!strains.empty() && !(strain > strains.back()))
      input.reject(key, "a monotonic curve: plastic strain " + print(strain) +
                            " does not increase on the one before");
    if (!strains.empty() && !(stress >= stresses.back()))
      input.reject(
          key, no_softening("a monotonic curve: stress " + print(stress) + " falls below the one before"));
    strains.push_back(strain);
    stresses.push_back(stress);
  }
  if (strains.empty())
    input.reject(key, "at least one 'strain : stress' pair");
  return make_hardening(TabulatedHardening(std::move(strains), std::move(stresses)));
}

} // namespace

HardeningType tabulated_hardening_type() {
  return {
      "table",
      "linear interpolation between points",
      {{"Table", "", TypeParameter::Kind::text,
        "Points 'strain : stress', separated by commas. Plastic strains increase strictly from 0; yield "
        "stresses > 0 do not decrease. The stress is constant beyond the last point. [- : stress]"},
       {"Table file", "", TypeParameter::Kind::text,
        "CSV file of these points, relative to the scene file, instead of 'Table'. Lines before the first "
        "number and comments after '#' are skipped."},
       {"Table columns", "1, 2", TypeParameter::Kind::text,
        "Columns of that file with plastic strain and yield stress, from 1."}},
      &make_table};
}

} // namespace billet
