// SPDX-License-Identifier: LGPL-2.1-or-later
// Curves of hardening at several rates, (H19): values between curves and points, slopes against differences,
// the flow stress of a step with the first curve as hardening, and files that are refused. Tables of rates
// and temperatures from files are those of the scene.
#include "billet/material/rate_factor.h"
#include "billet/material/thermal_factor.h"

#include "../testing.h"
#include "texts.h"

#include <cmath>
#include <fstream>

namespace rate_curves_test {

using namespace billet;
using namespace billet::testing;

namespace {

using Map = std::map<std::string, std::string>;

const std::string head = "strain,slow,fast,fastest\n",
                  body = "0,100,120,150\n0.1,150,165,180\n0.5,200,210,220\n";

std::shared_ptr<const RateFactor> make_curves(const std::string &text,
                                              const std::string &rates = "0.01, 1, 1000",
                                              const std::string &columns = "1, 2, 3, 4") {
  std::ofstream("curves.csv") << text;
  return rate_factor_types().find("curves")->make(
      Texts(Map{{"Curve rates", rates}, {"Curves file", "curves.csv"}, {"Curves columns", columns}}));
}

void check_factor() {
  const auto factor = make_curves(head + body);
  WorstError values;
  for (const auto &[alpha, rate, stress, slow] :
       std::vector<std::array<double, 4>>{{0., 0., 100., 100.},
                                          {0., 0.001, 100., 100.},
                                          {0.1, 1., 165., 150.},
                                          {0.1, std::sqrt(1000.), 172.5, 150.},
                                          {0.5, 1e6, 220., 200.},
                                          {2., 0.1, 205., 200.}})
    values.add(std::abs(factor->value_at(alpha, rate) - stress / slow));
  check("points of the curves", values.value(), 1e-14);
  check("between points, curves are linear in the strain",
        std::abs(factor->value_at(0.05, 1.) - 142.5 / 125.), 1e-14);
  check("the value at no strain", std::abs(factor->value(1000.) - 1.5) + std::abs(factor->value(1e-9) - 1.),
        1e-14);
  WorstError slopes;
  constexpr double h = 1e-6;
  for (const double alpha : {0.03, 0.3, 0.9})
    for (const double rate : {0.001, 0.2, 30., 1e5}) {
      const auto [by_rate, by_strain] = factor->slopes_at(alpha, rate);
      slopes.add(std::abs(
          by_rate * rate -
          (factor->value_at(alpha, rate * (1. + h)) - factor->value_at(alpha, rate * (1. - h))) / (2. * h)));
      slopes.add(std::abs(
          by_strain - (factor->value_at(alpha + h, rate) - factor->value_at(alpha - h, rate)) / (2. * h)));
    }
  check("slopes against differences", slopes.value(), 1e-8);
}

/// A return map ends on the measured curve of its rate.
void check_flow() {
  const auto flow = make_flow_stress(make_hardening(TabulatedHardening({0., 0.1, 0.5}, {100., 150., 200.})),
                                     make_curves(head + body));
  constexpr double m = 3e5, h = 1e-6;
  WorstError error, slope;
  for (const double alpha_n : {0., 0.02, 0.0995, 0.3})
    for (const double rate : {0.1, 1., 50.}) {
      const double delta = 1e-3, dt = delta / rate, alpha = alpha_n + delta;
      const double s = rate <= 1. ? std::log(rate / 0.01) / std::log(100.) : std::log(rate) / std::log(1000.);
      const auto curve = [&](const std::size_t k) {
        constexpr double stresses[3][3] = {{100., 150., 200.}, {120., 165., 210.}, {150., 180., 220.}};
        const auto &at = stresses[k];
        return alpha < 0.1 ? at[0] + (at[1] - at[0]) * alpha / 0.1
                           : at[1] + (at[2] - at[1]) * (alpha - 0.1) / 0.4;
      };
      const std::size_t k = rate <= 1. ? 0 : 1;
      const double q = (1. - s) * curve(k) + s * curve(k + 1) + m * delta;
      const PlasticIncrement found = flow->solve(q, m, alpha_n, dt);
      error.add(std::abs(found.strain / delta - 1.));
      const double more = flow->solve(q * (1. + h), m, alpha_n, dt).strain,
                   less = flow->solve(q * (1. - h), m, alpha_n, dt).strain;
      if (rate != 1.) // no kink
        slope.add(std::abs((more - less) / (2. * h * q) * (m + found.slope) - 1.));
    }
  check("increments of the return map", error.value(), 1e-10);
  check("slope of the flow stress in a step", slope.value(), 1e-5);
}

template <class Action> bool refuses(const Action &action) {
  try {
    action();
  } catch (const std::invalid_argument &) {
    return true;
  }
  return false;
}

void check_refusals() {
  for (const char *rates : {"", "1", "0, 1, 2", "1, 1, 2", "2, 1, 3", "1, 2"})
    check(std::string("refuses the rates '") + rates + "'",
          refuses([&] { make_curves(head + body, rates); }));
  for (const char *columns : {"1, 2", "1, 2, 3, 9", "0, 1, 2, 3"})
    check(std::string("refuses the columns ") + columns,
          refuses([&] { make_curves(head + body, "0.01, 1, 1000", columns); }));
  const std::vector<std::pair<std::string, std::string>> files = {
      {"no number", ""},
      {"strains from 0.1", "0.1,100,120,150\n"},
      {"strains that stay", body + "0.5,210,220,230\n"},
      {"a curve below a slower one", "0,100,99,150\n"},
      {"a yield stress of 0", "0,0,99,150\n"}};
  for (const auto &[name, text] : files)
    check("refuses " + name, refuses([&, &content = text] { make_curves(head + content); }));
}

void check_tables() {
  std::ofstream("table.csv") << "x;y;z\n10;7;1.5\n1000;7;2\n";
  const auto rate = rate_factor_types().find("table"); // a table with its own columns
  const auto from_file =
                 rate->make(Texts(Map{{"Rate table file", "table.csv"}, {"Rate table columns", "1, 3"}})),
             from_scene = rate->make(Texts("Rate table", "10 : 1.5, 1000 : 2"));
  check("a table of rates from a file", from_file->value(505.) == from_scene->value(505.));
  const auto thermal = thermal_factor_types().find("table");
  const auto heat_file = thermal->make(
                 Texts(Map{{"Thermal table file", "table.csv"}, {"Thermal table columns", "1, 3"}})),
             heat_scene = thermal->make(Texts("Thermal table", "10 : 1.5, 1000 : 2"));
  check("a table of temperatures from a file", heat_file->value(505.) == heat_scene->value(505.));
  check(
      "a file and a table are refused", refuses([&] {
        rate->make(Texts(
            {{"Rate table file", "table.csv"}, {"Rate table columns", "1, 3"}, {"Rate table", "10 : 1.5"}}));
      }));
  check("columns without a file are refused", refuses([&] {
          rate->make(Texts(Map{{"Rate table columns", "1, 3"}, {"Rate table", "10 : 1.5"}}));
        }));
}

} // namespace

BILLET_TEST(rate_curves) {
  check_factor();
  check_flow();
  check_refusals();
  check_tables();
}

} // namespace rate_curves_test
