// SPDX-License-Identifier: LGPL-2.1-or-later
// The least stiffness of waves (M7): of a dilatation, in closed form; of a bar, where it is lost; of
// Hencky's law within the range that is known to be stable; and against second differences of the stored
// energy.

#include "moduli.h"

#include "billet/material/neo_hookean.h"
#include "billet/material/stability.h"

namespace stability_test {

using namespace billet;
using namespace billet::testing;

const ElasticModuli rubber = ElasticModuli::from_young_poisson(1000., 0.3);

/// λ in all directions: along a wave κ + 4/3 G − κ ln J, across it G, of both laws.
template <class Law> double dilatation_error(const Law &law) {
  WorstError error;
  for (const double stretch : {0.2, 1., 1.3, 2., 4.}) {
    const double J = stretch * stretch * stretch, G = rubber.shear;
    const double exact = std::min(1., (rubber.bulk * (1. - std::log(J)) + 4. / 3. * G) / G);
    error.add(std::abs(min_wave_stiffness(law, G, {stretch, stretch, stretch}) - exact));
  }
  return error.value();
}

Stretches bar(const double strain) {
  const double across = std::exp(-0.3 * strain);
  return {std::exp(strain), across, across};
}

/// The least of d²ψ(F + s a⊗Fᵀn)/ds² over many pairs of directions: no less than the least stiffness, and
/// near.
template <class Law> double min_difference(const Law &law, const Stretches &stretches) {
  typename Law::History none;
  double minimum = 1e300;
  const auto direction = [](const unsigned int i, const unsigned int j) {
    constexpr unsigned int n = 12;
    const double a = std::acos(-1.) * i / n, b = std::acos(-1.) * j / n;
    return Tensor<1, 3>({std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)});
  };
  Tensor<2, 3> F;
  for (unsigned int i = 0; i < 3; ++i)
    F[i][i] = stretches[i];
  for (unsigned int i = 0; i <= 12; ++i)
    for (unsigned int j = 0; j < 12; ++j)
      for (unsigned int k = 0; k <= 12; ++k)
        for (unsigned int l = 0; l < 12; ++l) {
          const Tensor<2, 3> D = outer_product(direction(i, j), direction(k, l) * F);
          constexpr double s = 1e-3;
          const auto energy = [&](const double x) { return law.elastic_energy(F + x * D, none); };
          minimum = std::min(minimum, (energy(s) - 2. * energy(0.) + energy(-s)) / (s * s));
        }
  return minimum / rubber.shear;
}

template <class Law> bool agrees(const Law &law, const Stretches &stretches) {
  const double minimum = min_wave_stiffness(law, rubber.shear, stretches),
               difference = min_difference(law, stretches);
  return std::abs(minimum - difference) < 0.02 * std::max(1., std::abs(minimum)) &&
         minimum < difference + 1e-3;
}

BILLET_TEST(stability) {
  const HenckyElasticity hencky(rubber);
  const NeoHookeanElasticity neo_hookean(rubber);
  const auto of_hencky = [&](const Stretches &s) { return min_wave_stiffness(hencky, rubber.shear, s); };
  const auto of_neo_hookean = [&](const Stretches &s) {
    return min_wave_stiffness(neo_hookean, rubber.shear, s);
  };
  check("a dilatation, Hencky", dilatation_error(hencky), 1e-6);
  check("a dilatation, neo-Hookean", dilatation_error(neo_hookean), 1e-6);
  check("Hencky's bar is stable to ln -1.55", of_hencky(bar(-1.55)) > 0.);
  check("and not at ln -1.65", of_hencky(bar(-1.65)) < 0.);
  check("the neo-Hookean one is, at ln -3", of_neo_hookean(bar(-3.)) > 0.);
  bool is_stable = true;
  for (const double a : {0.2117, 0.5, 1., 1.3956})
    for (const double b : {0.2117, 0.5, 1., 1.3956})
      for (const double c : {0.2117, 0.5, 1., 1.3956})
        is_stable = is_stable && of_hencky({a, b, c}) > 0.;
  check("Hencky's law where Bruhns, Xiao and Meyers have it", is_stable);
  check("as second differences of the energy, Hencky", agrees(hencky, bar(-1.)) && agrees(hencky, bar(-2.5)));
  check("and neo-Hookean", agrees(neo_hookean, bar(-2.5)) && agrees(neo_hookean, {1.2, 0.4, 2.}));
  check("rates of stress, sheared by more than 2 G", min_wave_stiffness_of_rates(rubber, bar(-0.76)) > 0. &&
                                                         min_wave_stiffness_of_rates(rubber, bar(0.78)) < 0.);
  check("and dilated to five times the volume",
        min_wave_stiffness_of_rates(rubber, {1.70, 1.70, 1.70}) > 0. &&
            min_wave_stiffness_of_rates(rubber, {1.72, 1.72, 1.72}) < 0.);
  check("without a stress there is none", of_hencky({0., 1., 1.}) < 0.);
}

} // namespace stability_test
