// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/hardening.h"

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <stdexcept>

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

HardeningType tabulated_hardening_type() {
  return {"table",
          "linear interpolation between points",
          {{"Table", "", TypeParameter::Kind::text,
            "Points 'strain : stress', separated by commas. Plastic strains increase strictly from 0; yield "
            "stresses > 0 do not decrease. The stress is constant beyond the last point. [- : stress]"}},
          [](const TypeInput &input) {
            std::vector<double> strains, stresses;
            for (const auto &part : input.parts("Table", ',')) {
              const auto pair = dealii::Utilities::split_string_list(part, ':');
              try {
                if (pair.size() != 2)
                  throw std::invalid_argument("pair");
                strains.push_back(parse_number(pair[0]));
                stresses.push_back(parse_number(pair[1]));
              } catch (const std::invalid_argument &) {
                input.reject("Table", "'strain : stress' pairs, separated by commas");
              }
              const std::size_t n = strains.size();
              if (n == 1 && strains[0] != 0.)
                input.reject("Table", "a curve that starts at plastic strain 0");
              if (!(stresses.back() > 0.))
                input.reject("Table", "yield stresses > 0");
              if (n > 1 && !(strains[n - 1] > strains[n - 2]))
                input.reject("Table", "a monotonic curve: plastic strain " + pair[0] +
                                          " does not increase on the one before");
              if (n > 1 && !(stresses[n - 1] >= stresses[n - 2]))
                input.reject("Table", no_softening("a monotonic curve: stress " + pair[1] +
                                                   " falls below the one before"));
            }
            if (strains.empty())
              input.reject("Table", "at least one 'strain : stress' pair");
            return make_hardening(TabulatedHardening(std::move(strains), std::move(stresses)));
          }};
}

} // namespace billet
