// SPDX-License-Identifier: LGPL-2.1-or-later
// A hardening law that the library does not know, registered here and named by a scene: uniaxial tension with
// every elasticity, element and scheme against the closed form. Then a restart with every hardening law that
// there is.

#include "../scenes/restart_run.h"
#include "pulled_cube.h"

#include "billet/material/hardening.h"

namespace added_hardening_test {

using namespace billet;
using billet::testing::check;

namespace {

/// σ_0 + (σ_∞ − σ_0) a/(a + r).
struct HyperbolicHardening {
  double yield_stress, limit, strain;

  static std::string description() { return "hyperbolic hardening"; }
  double stress(const double a) const { return limit - (limit - yield_stress) * strain / (a + strain); }
  double slope(const double a) const {
    return (limit - yield_stress) * strain / ((a + strain) * (a + strain));
  }
  double work(const double a) const {
    return limit * a - (limit - yield_stress) * strain * std::log1p(a / strain);
  }
  static bool is_bounded() { return true; }
};

HardeningType hyperbolic_type() {
  using Kind = TypeParameter::Kind;
  return {"hyperbolic",
          "Sy + (Sl - Sy) e/(e + r)",
          {yield_stress_parameter,
           {"Limit stress", "0", Kind::number, "Sl > 0. [stress]"},
           {"Half strain", "0", Kind::number, "r > 0."}},
          [](const TypeInput &input) {
            return make_hardening(HyperbolicHardening{input.positive("Yield stress"),
                                                      input.positive("Limit stress"),
                                                      input.positive("Half strain")});
          }};
}

const HyperbolicHardening sample{300., 500., 0.05};

std::string material(const std::string &elasticity) {
  return "set Young modulus = 200e3\nset Poisson ratio = 0.3\nset Elasticity = " + elasticity +
         "\nset Hardening = hyperbolic\nset Yield stress = 300\nset Limit stress = 500\nset Half strain = "
         "0.05";
}

/// Hencky: E (ε − α) = σ_y(α).
double exact_plastic_strain(const double strain) {
  double low = 0., high = strain;
  for (unsigned int i = 0; i < 100; ++i) {
    const double a = 0.5 * (low + high);
    (testing::cube_young * (strain - a) > sample.stress(a) ? low : high) = a;
  }
  return low;
}

void test_tension() {
  constexpr double stretch = 1.3, duration = 2e-4; // some 200 times the slowest vibration
  const double alpha = exact_plastic_strain(std::log(stretch)), stress = sample.stress(alpha),
               elastic = 0.5 * stress * stress / testing::cube_young, plastic = sample.work(alpha);
  for (const std::string element : testing::all_element_names) {
    for (const std::string elasticity : {"Hencky", "neo-Hookean", "hypoelastic"}) {
      // The return of Hencky's law is exact in tension, those of the others by the order of the step.
      const bool is_exact = elasticity == "Hencky";
      const auto found = testing::pull(element, material(elasticity), stretch, 1., is_exact ? 20 : 200);
      const double allowed = is_exact ? 1e-9 : 3e-3;
      check(element + ", " + elasticity + ", elastic energy", std::abs(found.elastic / elastic - 1.),
            2. * allowed);
      check(element + ", " + elasticity + ", plastic work", std::abs(found.plastic / plastic - 1.), allowed);
    }
    const auto found = testing::pull_explicitly(element, material("Hencky"), stretch, duration);
    check(element + ", explicit, plastic work", std::abs(found.plastic / plastic - 1.), 1e-2);
  }
}

/// The second half of a run from a checkpoint, against that without one.
void test_restart(const std::string &name, const std::string &parameters) {
  const auto scene = testing::read_pulled_cube(
      "assumed strain", "set Young modulus = 200e3\nset Poisson ratio = 0.3\n" + parameters, 1.1, 1., false,
      10);
  testing::History whole, rest;
  testing::ImplicitSolutionRun first(scene, MPI_COMM_WORLD);
  first.run(0.5, whole);
  first.save("half.h5");
  whole.clear();
  first.run(1., whole);
  testing::ImplicitSolutionRun second(scene, MPI_COMM_WORLD);
  const RestartReport report = second.load("half.h5");
  second.run(1., rest);
  check("restart, " + name + ", to the last bit", report.is_exact && testing::are_same_bits(whole, rest));
}

} // namespace

BILLET_MPI_TEST(added_hardening) {
  hardening_types().add(hyperbolic_type());
  test_tension();
  const std::map<std::string, std::string> constants = {
      {"linear", "set Yield stress = 300\nset Hardening modulus = 500"},
      {"Voce", "set Yield stress = 300\nset Saturation stress = 500\nset Saturation rate = 10"},
      {"power law", "set Strength coefficient = 500\nset Prestrain = 0.01\nset Hardening exponent = 0.2"},
      {"Ludwik", "set Yield stress = 300\nset Hardening coefficient = 400\nset Hardening exponent = 0.3"},
      {"table", "set Table = 0 : 300, 0.05 : 400"},
      {"hyperbolic", "set Yield stress = 300\nset Limit stress = 500\nset Half strain = 0.05"}};
  for (const HardeningType &type : hardening_types()) {
    check("constants of " + type.name, constants.count(type.name) == 1);
    test_restart(type.name, "set Hardening = " + type.name + "\n" + constants.at(type.name));
  }
}

} // namespace added_hardening_test
