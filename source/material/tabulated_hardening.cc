// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/csv_columns.h"
#include "billet/material/hardening.h"

#include <algorithm>
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

/// Not a constant of the file: other files may ask for the type before it is made.
PointTable hardening_table() {
  return {"Table", "strain : stress",
          "Plastic strains increase strictly from 0; yield stresses > 0 do not decrease. The "
          "stress is constant beyond the last point. [- : stress]"};
}

std::string print(const double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

std::shared_ptr<const HardeningLaw> make_hardening_table(const TypeInput &input) {
  std::string key;
  std::vector<double> strains, stresses;
  for (const auto &[strain, stress] : hardening_table().read(input, key)) {
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
  return {"table", "linear interpolation between points", hardening_table().parameters(),
          &make_hardening_table};
}

} // namespace billet
