// SPDX-License-Identifier: LGPL-2.1-or-later
// A volumetric law of rubber that the library does not know, registered here and named by a scene: its form
// against differences; uniaxial tension with every element and both schemes against the closed form; refusals
// of scenes that cannot use it.

#include "pulled_cube.h"

#include "billet/material/volumetric_law.h"

namespace added_volumetric_law_test {

using namespace billet;
using billet::testing::check;

namespace {

/// u = ½ (½ (J² − 1) − ln J) (Simo and Miehe 1992).
class MixedVolume final : public VolumetricLaw {
public:
  double energy(const double J) const override { return 0.5 * (0.5 * (J * J - 1.) - std::log(J)); }
  double mean_stress(const double J) const override { return 0.5 * (J * J - 1.); }
  double slope(const double J) const override { return J * J; }
  double bound_slope(const double p) const override { return std::max(1. + 2. * p, 0.); }
};

VolumetricLawType mixed_type() {
  return {"Simo-Miehe", "K/2 ((J^2 - 1)/2 - ln J)", {}, [](const TypeInput &) -> SharedVolumetricLaw {
            return std::make_shared<const MixedVolume>();
          }};
}

constexpr double bulk = 6., shear = 2.;

std::string material(const std::string &law) {
  return "set Elasticity = Mooney-Rivlin\nset C10 = 1\nset Bulk modulus = 6\nset Volumetric law = " + law;
}

/// Energy of uniaxial tension, κ u(J) + ½ G (tr b̄ − 3); the lateral stretch l by bisection of the lateral
/// stress.
double exact_energy(const double stretch) {
  const MixedVolume u;
  double low = 0.3, high = 1.5, J = 1., trace = 3.;
  for (unsigned int i = 0; i < 100; ++i) {
    const double l = 0.5 * (low + high);
    J = l * l * stretch;
    const double scale = std::pow(J, -2. / 3.);
    trace = (2. * l * l + stretch * stretch) * scale;
    (bulk * u.mean_stress(J) + shear * (l * l * scale - trace / 3.) > 0. ? high : low) = l;
  }
  return bulk * u.energy(J) + 0.5 * shear * (trace - 3.);
}

std::string refusal_of(const std::string &material) {
  return testing::refusal([&] { testing::read_pulled_cube("assumed strain", material, 1.1, 1., false, 1); });
}

} // namespace

BILLET_MPI_TEST(added_volumetric_law) {
  volumetric_law_types().add(mixed_type());
  const double exact = exact_energy(1.8);
  for (const std::string element : testing::all_element_names) {
    const auto found = testing::pull(element, material("Simo-Miehe"), 1.8, 1., 8);
    check(element + ", energy", std::abs(found.elastic / exact - 1.), 1e-9);
    check(element + ", at most seven Newton iterations a step", found.n_iterations <= 56);
    check(element + ", another law has another energy",
          std::abs(testing::pull(element, material("logarithmic"), 1.8, 1., 8).elastic / exact - 1.) > 1e-2);
    check(element + ", explicit",
          std::abs(testing::pull_explicitly(element, material("Simo-Miehe"), 1.8, 2e-2).elastic / exact - 1.),
          1e-2);
  }
  check("Hencky's elasticity refuses it",
        testing::has(refusal_of("set Young modulus = 1\nset Volumetric law = Simo-Miehe"),
                     "'Elasticity = Hencky' does not use it"));
  check("an exponent without Ogden's volumetric law is refused",
        testing::has(refusal_of(material("Simo-Miehe") + "\nset Volumetric exponent = 3"),
                     "'Volumetric law = Simo-Miehe' does not use it"));
  check("an unknown law is refused", testing::has(refusal_of(material("cubic")), "Simo-Miehe"));
}

} // namespace added_volumetric_law_test
