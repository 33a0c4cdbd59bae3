// SPDX-License-Identifier: LGPL-2.1-or-later
// The comparison of elements: closed forms of bending of one brick, agreement where nothing bends, rigid
// rotation, and the deformation theory's energy.
#include "billet/mechanics/element_comparison.h"

#include "../sample_formulations.h"
#include "../testing.h"

#include <cmath>

namespace element_comparison_test {

using namespace billet;
using billet::testing::check;
using billet::testing::LawFormulation;
using billet::testing::MaterialLaw;
using Element = ElementFormulation::Element;

namespace {

constexpr double young = 1000.;

MaterialLaw elastic(const double poisson) { return {ElasticModuli::from_young_poisson(young, poisson), {}}; }

/// A box, its edges along x sheared by `skew` of the height.
ElementVectors brick(const std::array<double, 3> &lengths, const double skew = 0.) {
  ElementVectors x;
  for (unsigned int a = 0; a < n_element_nodes; ++a) {
    for (unsigned int i = 0; i < 3; ++i)
      x[3 * a + i] = ((a >> i) & 1U) != 0U ? lengths[i] : 0.;
    x[3 * a] += skew * x[3 * a + 2];
  }
  return x;
}

template <class Function> ElementVectors move(const ElementVectors &x, const Function &u) {
  ElementVectors result;
  for (unsigned int a = 0; a < n_element_nodes; ++a) {
    const dealii::Tensor<1, 3> moved = u(dealii::Tensor<1, 3>({x[3 * a], x[3 * a + 1], x[3 * a + 2]}));
    for (unsigned int i = 0; i < 3; ++i)
      result[3 * a + i] = moved[i];
  }
  return result;
}

ElementEnergies compare(const MaterialLaw &law, const Element element, const ElementVectors &x,
                        const ElementVectors &u) {
  LawFormulation formulation;
  formulation.element = element;
  ElementEnergies energies;
  if (!ElementComparison(make_law(law, formulation.elasticity), formulation).compare(x, u, energies))
    energies.used = std::nan("");
  return energies;
}

/// Bending in x and z about the middle: u_x = κ (x − l/2)(z − h/2).
ElementVectors bend(const ElementVectors &x, const std::array<double, 3> &l, const double curvature) {
  return move(x, [&](const dealii::Tensor<1, 3> &p) {
    return dealii::Tensor<1, 3>({curvature * (p[0] - l[0] / 2) * (p[2] - l[2] / 2), 0., 0.});
  });
}

} // namespace

BILLET_TEST(element_comparison) {
  const auto relative = [](const double a, const double b) { return std::abs(a / b - 1.); };
  const std::array<double, 3> l = {{5., 3., 1.}};
  for (const double poisson : {0., 0.3, 0.49}) {
    const MaterialLaw law = elastic(poisson);
    const double shear = law.elastic.shear, curvature = 1e-5;
    const auto u = bend(brick(l), l, curvature);
    // Bending of a plate that cannot bend across: E/(1 − ν²) κ² I/2 per length.
    const double exact =
        young / (1. - poisson * poisson) * curvature * curvature * l[0] * l[1] * std::pow(l[2], 3) / 24.;
    const std::string name = "nu = " + std::to_string(poisson).substr(0, 4);
    const ElementEnergies accurate = compare(law, Element::assumed_strain, brick(l), u);
    check("bending is exact, " + name, relative(accurate.accurate, exact), 1e-4);
    check("and of one point, " + name, relative(accurate.one_point, exact), 1e-4);
    check("the accurate element is not too stiff, " + name, accurate.factor() == 1.);
    // dev F has σ_xx by 4/3 G, and the shear κ (x − l/2) besides.
    const ElementEnergies mean = compare(law, Element::mean_dilatation, brick(l), u);
    const double mean_locked = curvature * curvature * l[0] * l[1] * l[2] / 24. *
                               (4. / 3. * shear * l[2] * l[2] + shear * l[0] * l[0]);
    check("mean dilatation locks as it should, " + name, relative(mean.factor(), mean_locked / exact), 1e-3);
  }
  const MaterialLaw law = elastic(0.3);
  {
    const auto linear = [](const dealii::Tensor<1, 3> &p) {
      return dealii::Tensor<1, 3>(
          {0.2 * p[0] + 0.1 * p[1], 0.3 * p[2] - 0.1 * p[1], 0.05 * p[0] - 0.1 * p[2]});
    };
    auto x = brick(l);
    for (unsigned int k = 0; k < n_element_dofs; ++k)
      x[k] += 0.2 * std::sin(1. + 3. * k);
    for (const Element element : all_elements()) {
      const ElementEnergies energies = compare(law, element, x, move(x, linear));
      check("where strain is constant all agree, on any brick",
            relative(energies.used, energies.accurate) + relative(energies.one_point, energies.accurate),
            1e-10);
    }
  }
  {
    // The same bending, turned by far.
    const double angle = 1.1;
    const auto x = brick(l), u = bend(x, l, 0.02);
    ElementVectors turned = u;
    for (unsigned int a = 0; a < n_element_nodes; ++a) {
      const double p = x[3 * a] + u[3 * a], q = x[3 * a + 2] + u[3 * a + 2];
      turned[3 * a] = std::cos(angle) * p - std::sin(angle) * q - x[3 * a];
      turned[3 * a + 2] = std::sin(angle) * p + std::cos(angle) * q - x[3 * a + 2];
    }
    const ElementEnergies a = compare(law, Element::mean_dilatation, x, u),
                          b = compare(law, Element::mean_dilatation, x, turned);
    check("rotation changes nothing", relative(a.used, b.used) + relative(a.accurate, b.accurate), 1e-10);
    check("without strain there is nothing", compare(law, Element::mean_dilatation, x, {}).factor() == 1.);
  }
  {
    const auto x = brick(l), u = bend(x, l, 1e-5);
    const auto skew = brick(l, 0.5);
    const double curvature = 1e-5;
    const ElementEnergies skewed =
        compare(law, Element::one_point, skew, move(skew, [&](const dealii::Tensor<1, 3> &p) {
                  const double along = p[0] - 0.5 * l[0] - 0.25 * l[2], up = p[2] - 0.5 * l[2];
                  return curvature * dealii::Tensor<1, 3>({along * up, 0., -0.5 * along * along});
                }));
    const double modulus = young / (1. - 0.3 * 0.3);
    check("one point bends as it should, also where edges are skew",
          relative(skewed.hourglass, modulus * curvature * curvature * l[0] * l[1] * std::pow(l[2], 3) / 24.),
          1e-3);

    const ElementEnergies bent = compare(law, Element::one_point, x, u);
    check("bending is a hourglass mode", relative(bent.hourglass, bent.used), 1e-6);
    check("elastic bodies dissipate nothing", bent.plastic == 0.);
    const auto stretched = move(x, [](const dealii::Tensor<1, 3> &p) {
      return 0.05 * dealii::Tensor<1, 3>({p[0], -0.5 * p[1], -0.5 * p[2]});
    });
    MaterialLaw plastic = law;
    plastic.hardening = LinearHardening{2., 0.};
    const ElementEnergies pulled = compare(plastic, Element::one_point, x, stretched);
    check("stretch is none", std::abs(pulled.hourglass) < 1e-9 * pulled.used);
    check("what flow dissipates is most of it",
          pulled.plastic > 0.9 * pulled.used && pulled.plastic < pulled.used);
    const ElementEnergies pulled_points = compare(plastic, Element::assumed_strain, x, stretched);
    check("points see all of what stretch dissipates",
          relative(pulled_points.plastic_within, pulled_points.plastic), 1e-10);
    // 1.5 times the strain of first yield in the outer fibres, 0.87 of it at the points.
    const ElementEnergies outer =
        compare(plastic, Element::assumed_strain, x, bend(x, l, 3. * 2. / young / l[2]));
    check("points do not see flow in outer fibres",
          outer.plastic == 0. && outer.plastic_within > 0.05 * outer.used);
    const ElementEnergies hinge = compare(plastic, Element::assumed_strain, x, bend(x, l, 0.2));
    check("in a hinge they see 2/√3 of it",
          relative(hinge.plastic / hinge.plastic_within, 2. / std::sqrt(3.)), 0.05);
    const ElementEnergies folded = compare(plastic, Element::one_point, x, bend(x, l, 0.02));
    check("so it is where bending yields",
          folded.plastic > 0.5 * folded.used && folded.hourglass > 0.9 * folded.used);
  }
  {
    // A tapered brick with the displacements of a bent beam: it stores 3 (l τ/h)² of them once more, (L4).
    const double curvature = 1e-5;
    const auto bend_tapered = [&](const unsigned int axis, const double taper, const Element element) {
      auto x = brick(l);
      for (unsigned int a = 0; a < n_element_nodes; ++a)
        x[3 * a] += taper * (x[3 * a] > 0.5 * l[0] ? 1. : -1.) * (x[3 * a + axis] - 0.5 * l[axis]);
      return compare(elastic(0.), element, x, move(x, [&](const dealii::Tensor<1, 3> &p) {
                       const double along = p[0] - 0.5 * l[0], up = p[2] - 0.5 * l[2];
                       return curvature * dealii::Tensor<1, 3>({along * up, 0., -0.5 * along * along});
                     }));
    };
    for (const double taper : {0.02, 0.05, 0.1}) {
      const double exact = 1. + 3. * std::pow(l[0] * taper / l[2], 2);
      check("tapered by " + std::to_string(taper).substr(0, 4) + " it is too stiff",
            relative(bend_tapered(2, taper, Element::assumed_strain).factor(), exact), 0.02);
      check("with one point, too", relative(bend_tapered(2, taper, Element::one_point).factor(), exact),
            0.05);
    }
    // Tapered across the plane in which it bends, (L5): ends that are not square to it tilt.
    for (const double taper : {0.02, 0.05, 0.1}) {
      const double exact = 1. + 1.5 * std::pow(l[0] * taper / l[2], 2); // 3 G/E
      check("tapered across by " + std::to_string(taper).substr(0, 4) + " it is too stiff",
            relative(bend_tapered(1, taper, Element::assumed_strain).factor(), exact), 0.02);
      check("with one point, too", relative(bend_tapered(1, taper, Element::one_point).factor(), exact),
            0.05);
    }
  }
  {
    const double yield = 2., modulus = 50.;
    MaterialLaw plastic = law;
    plastic.hardening = LinearHardening{yield, modulus};
    const ElementComparison comparison(make_law(plastic, LawFormulation().elasticity), {});
    const double stiffness = 3. * law.elastic.shear;
    const auto energy = [&](const double strain) {
      return comparison.energy(0., 0.5 * stiffness * strain * strain);
    };
    const double strain = 0.02, alpha = (stiffness * strain - yield) / (stiffness + modulus);
    check("energy of total strain",
          relative(energy(strain), 0.5 * std::pow(stiffness * (strain - alpha), 2) / stiffness +
                                       (yield + 0.5 * modulus * alpha) * alpha),
          1e-10);
    const double slope =
        billet::testing::central_difference([&](const double d) { return energy(strain + d); }, 1e-4);
    check("its slope is the stress", relative(slope, yield + modulus * alpha), 1e-7);
    check("below the yield stress it is elastic",
          relative(energy(0.5 * yield / stiffness), 0.125 * yield * yield / stiffness), 1e-12);
  }
}

} // namespace element_comparison_test
