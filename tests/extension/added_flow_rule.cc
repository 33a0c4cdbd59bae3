// SPDX-License-Identifier: LGPL-2.1-or-later
// A thermal factor and an anisotropy that the library does not know, registered here and named by scenes. At
// a constant temperature the factor is that of the yield stress and the modulus. A yield function that is von
// Mises' times 1/k is a yield stress times k; α, which is conjugate to it, is k times the strain.

#include "pulled_cube.h"

#include "billet/material/flow_rule.h"

namespace added_flow_rule_test {

using namespace billet;
using billet::testing::check;

namespace {

/// exp(−T/100).
class ExponentialFactor final : public ThermalFactor {
public:
  std::string description() const override { return "times an exponential of the temperature"; }
  double value(const double temperature) const override { return std::exp(-temperature / 100.); }
  double slope(const double temperature) const override { return -0.01 * value(temperature); }
};

std::string material(const double yield_stress, const double modulus, const std::string &more) {
  std::ostringstream text;
  text.precision(17);
  text << "set Young modulus = 200e3\nset Poisson ratio = 0.3\nset Yield stress = " << yield_stress
       << "\nset Hardening modulus = " << modulus << "\n"
       << more;
  return text.str();
}

void compare(const std::string &name, const std::string &added, const double of_stress,
             const double of_modulus) {
  for (const std::string element : testing::all_element_names) {
    const auto found = testing::pull(element, material(300., 500., added), 1.2, 1., 5),
               expected =
                   testing::pull(element, material(300. * of_stress, 500. * of_modulus, ""), 1.2, 1., 5);
    check(name + ", " + element + ", elastic energy", std::abs(found.elastic / expected.elastic - 1.), 1e-9);
    check(name + ", " + element + ", plastic work", std::abs(found.plastic / expected.plastic - 1.), 1e-9);
  }
}

} // namespace

BILLET_MPI_TEST(added_flow_rule) {
  thermal_factor_types().add({"exponential", "exp(-T/100)", {}, [](const TypeInput &) {
                                return std::make_shared<const ExponentialFactor>();
                              }});
  anisotropy_types().add({"weak",
                          "von Mises' function, times 1/k",
                          {{"Weakness", "1", TypeParameter::Kind::number, "k > 0."}},
                          [](const TypeInput &input) {
                            const double square = 1. / std::pow(input.positive("Weakness"), 2);
                            const Anisotropy weak{{0.5 * square, 0.5 * square, 0.5 * square, 1.5 * square,
                                                   1.5 * square, 1.5 * square},
                                                  Axes()};
                            return std::make_shared<const Anisotropy>(weak);
                          }});
  compare("thermal factor", "set Thermal factor = exponential\nset Temperature = 40\n", std::exp(-0.4),
          std::exp(-0.4));
  compare("anisotropy", "set Anisotropy = weak\nset Weakness = 0.5\n", 0.5, 0.25);
}

} // namespace added_flow_rule_test
