// SPDX-License-Identifier: LGPL-2.1-or-later
// Hill's anisotropy against closed forms: yield stress and r-value in tension at an angle to the material
// axes, equibiaxial, plane strain and shear, for sheets of benchmark data; the same under a rotation of the
// sample and of its axes. Isotropic ratios are von Mises' law, also on paths whose axes turn. Moduli against
// differences along random paths, with backstress and without.

#include "point_driver.h"

#include "billet/material/flow_rule_plastic.h"
#include "billet/material/law_point.h"

namespace anisotropy_test {

using namespace billet;
using namespace billet::testing;

namespace {

using Law = FlowRulePlasticity<true, false>;
using Axes3 = std::array<Tensor<1, 3>, 3>;

Axes3 axes_of(const Tensor<2, 3> &Q) {
  Axes3 axes;
  for (unsigned int a = 0; a < 3; ++a)
    for (unsigned int i = 0; i < 3; ++i)
      axes[a][i] = Q[i][a];
  return axes;
}
Tensor<2, 3> about_z(const double angle) {
  return dealii::Physics::Transformations::Rotations::rotation_matrix_3d(Tensor<1, 3>({0., 0., 1.}), angle);
}

template <class Hardening>
Law make_law(const Hardening &hardening, const HillCoefficients &coefficients, const Axes3 &axes,
             std::vector<BackstressTerm> terms = {}, const ElasticModuli &elastic = steel) {
  FlowRule rule;
  rule.anisotropy = std::make_shared<const Anisotropy>(Anisotropy{coefficients, Axes(axes)});
  rule.backstress = std::move(terms);
  return Law(elastic, make_hardening(hardening), rule);
}

struct Sheet {
  std::string name;
  std::array<double, 3> r;
  std::array<double, 4> coefficients; ///< F, G, H, N
  std::array<double, 6> yield;        ///< at 15, 30, ... 90 degrees
  double biaxial, plane_strain;
};

const std::vector<Sheet> sheets = {{"mild steel",
                                    {1.79, 1.51, 2.27},
                                    {.28263, .35842, .64158, 1.28852},
                                    {1.0230, 1.0765, 1.1149, 1.1010, 1.0601, 1.0402},
                                    1.24897,
                                    1.34277},
                                   {"aluminium",
                                    {.71, .58, .70},
                                    {.59315, .58480, .41520, 1.27218},
                                    {1.0090, 1.0277, 1.0366, 1.0254, 1.0054, .9959},
                                    .92138,
                                    1.09828}};

constexpr double yield_stress = 200.;
const LinearHardening flat{yield_stress, 0.};
const ElasticModuli stiff = {1e3 * steel.bulk, 1e3 * steel.shear};

void test_sheet(const Sheet &sheet) {
  const auto hill = HillCoefficients::from_r_values(sheet.r[0], sheet.r[1], sheet.r[2]);
  WorstError known;
  known.add(std::abs(hill.F - sheet.coefficients[0]));
  known.add(std::abs(hill.G - sheet.coefficients[1]));
  known.add(std::abs(hill.H - sheet.coefficients[2]));
  known.add(std::abs(hill.N - sheet.coefficients[3]));
  check(sheet.name + ", coefficients", known.value(), 1e-5);
  check(sheet.name + ", convex", hill.is_convex());

  WorstError stress, r_value, table;
  for (unsigned int i = 0; i <= 6; ++i) {
    const double theta = i * M_PI / 12., s = std::sin(theta), c = std::cos(theta);
    // The tension is along 1, the material axes lie at −θ. For r, elastic strains, which do not commute with
    // those of flow, are small.
    const Axes3 axes = axes_of(about_z(-theta));
    const Law law = make_law(flat, hill, axes), stiff_law = make_law(flat, hill, axes, {}, stiff);
    const double exact = yield_stress /
                         std::sqrt(hill.F * s * s * s * s + hill.G * c * c * c * c +
                                   hill.H * (c * c - s * s) * (c * c - s * s) + 2. * hill.N * s * s * c * c),
                 r = (hill.H + (2. * hill.N - hill.F - hill.G - 4. * hill.H) * s * s * c * c) /
                     (hill.F * s * s + hill.G * c * c);
    DrivenPoint<Law> point(law), flowing(stiff_law);
    constexpr std::array<bool, 6> along = {true, false, false, false, false, false};
    point.move(along, {0.1});
    stress.add(std::abs(point.stress[0] / exact - 1.));
    flowing.move(along, {0.01});
    const auto before = flowing.strain;
    flowing.move(along, {0.1});
    r_value.add(std::abs((flowing.strain[1] - before[1]) / (flowing.strain[2] - before[2]) / r - 1.));
    if (i > 0)
      table.add(std::abs(exact / yield_stress - sheet.yield[i - 1]));
  }
  check(sheet.name + ", yield stress at all angles", stress.value(), 1e-10);
  check(sheet.name + ", r-value at all angles", r_value.value(), 1e-8);
  check(sheet.name + ", known yield stresses", table.value(), 1e-4);

  const Law law = make_law(flat, hill, axes_of(unit));
  DrivenPoint<Law> biaxial(law), plane(law), shear(law);
  // Equal stresses: given stresses below and beyond the limit.
  const double limit = yield_stress / std::sqrt(hill.F + hill.G);
  biaxial.move({}, {limit * (1. - 1e-9), limit * (1. - 1e-9)});
  check(sheet.name + ", equibiaxial, elastic below", biaxial.history.equivalent_plastic_strain, 0.);
  const Law hard = make_law(LinearHardening{yield_stress, 1000.}, hill, axes_of(unit));
  DrivenPoint<Law> yielding(hard);
  yielding.move({}, {limit * (1. + 1e-3), limit * (1. + 1e-3)});
  check(sheet.name + ", equibiaxial, flows beyond",
        std::abs(yielding.history.equivalent_plastic_strain - 1e-3 * yield_stress / 1000.), 1e-10);
  check(sheet.name + ", known equibiaxial stress", std::abs(limit / yield_stress - sheet.biaxial), 1e-5);

  // Plane strain: the elastic strain across fades over large strains.
  for (const double e : {0.3, 0.6, 0.9})
    plane.move({true, true, false, true, true, true}, {e, 0.});
  const double plane_exact = yield_stress / std::sqrt(1. - hill.H * hill.H / (hill.F + hill.H));
  check(sheet.name + ", plane strain", std::abs(plane.stress[0] / plane_exact - 1.), 1e-10);
  check(sheet.name + ", known plane strain", std::abs(plane_exact / yield_stress - sheet.plane_strain), 2e-5);
  shear.move({false, false, false, true, false, false}, {0., 0., 0., 0.02});
  check(sheet.name + ", shear", std::abs(shear.stress[3] * std::sqrt(2. * hill.N) / yield_stress - 1.),
        1e-10);
}

void test_stress_ratios() {
  // Those of the mild steel: R22, R33, R12 reproduce its r-values.
  const auto known = HillCoefficients::from_r_values(1.79, 1.51, 2.27),
             found = HillCoefficients::from_stress_ratios({1., 1.0402, 1.24897, 1.07895, 1., 1.});
  check("stress ratios and r-values",
        std::abs(known.F - found.F) + std::abs(known.G - found.G) + std::abs(known.H - found.H) +
            std::abs(known.N - found.N),
        1e-4);
  check("a ratio far off is not convex",
        !HillCoefficients::from_stress_ratios({0.4, 1., 1., 1., 1., 1.}).is_convex());
}

void test_isotropic() {
  Random random;
  const Law law = make_law(voce, HillCoefficients::from_stress_ratios({1., 1., 1., 1., 1., 1.}),
                           axes_of(random.rotation()));
  const HenckyPlasticity mises(steel, make_hardening(voce));
  WorstError stress, moduli;
  for (const double size : {1e-3, 1e-2, 0.3}) {
    Law::History history_n, history;
    HenckyPlasticity::History known_n, known;
    follow_path(size, 30, [&](const Tensor<2, 3> &F) {
      SymmetricTensor<2, 3> tau, expected;
      SpatialModuli c, d;
      if (!law.update(F, history_n, history, tau, &c) || !mises.update(F, known_n, known, expected, &d))
        return check("isotropic ratios fail", false);
      stress.add((tau - expected).norm() / expected.norm());
      moduli.add(distance(c, d) / norm(d));
      history_n = history;
      known_n = known;
    });
  }
  check("isotropic ratios, stress of von Mises", stress.value(), 1e-9);
  check("isotropic ratios, moduli of von Mises", moduli.value(), 1e-9);
}

/// R F has the turned stress; F Q with axes Qᵀ a has the same stress.
void test_objectivity() {
  Random random;
  const auto hill = HillCoefficients::from_r_values(1.79, 1.51, 2.27);
  const Tensor<2, 3> A = random.rotation();
  const Law law = make_law(voce, hill, axes_of(A), {{20000., 100.}});
  WorstError turned, moved;
  for (unsigned int i = 0; i < 20; ++i) {
    const Tensor<2, 3> F = unit + random.tensor(0.3), R = random.rotation(), Q = random.rotation();
    const Law other = make_law(voce, hill, axes_of(transpose(Q) * A), {{20000., 100.}});
    Law::History history;
    SymmetricTensor<2, 3> tau, after, same;
    law.update(F, {}, history, tau, nullptr);
    law.update(R * F, {}, history, after, nullptr);
    other.update(F * Q, {}, history, same, nullptr);
    turned.add((static_cast<Tensor<2, 3>>(after) - R * tau * transpose(R)).norm() / tau.norm());
    moved.add((same - tau).norm() / tau.norm());
  }
  check("a rotation turns stress and axes", turned.value(), 1e-9);
  check("axes that turn with the undeformed sample", moved.value(), 1e-9);
}

/// Cylindrical axes: each element has the law of a body whose axes are those at its centre.
void test_cylindrical_axes() {
  const Tensor<1, 3> on_line({1., 2., 0.}), along({0.6, 0., 0.8});
  const auto hill = HillCoefficients::from_stress_ratios({1., 1.4, 0.8, 1.1, 0.9, 1.2});
  const auto make = [&](const Axes &axes) {
    FlowRule rule;
    rule.anisotropy = std::make_shared<const Anisotropy>(Anisotropy{hill, axes});
    rule.backstress = {{20000., 100.}};
    return make_hencky_law(steel, make_hardening(voce), rule);
  };
  const SharedLaw law = make(Axes::about(on_line, along));
  Random random;
  WorstError same, axes;
  double elsewhere = 0.;
  for (unsigned int i = 0; i < 10; ++i) {
    const Tensor<1, 3> place = random.tensor(5.)[0];
    Tensor<1, 3> radius = place - on_line;
    radius -= (radius * along) * along;
    radius /= radius.norm();
    const SharedLaw fixed = make(Axes({radius, dealii::cross_product_3d(along, radius), along}));
    LawPoint point(*law, 0., place), expected(*fixed),
        other(*law, 0., on_line + dealii::cross_product_3d(along, radius) + 0.3 * radius);
    follow_path(0.05, 10, [&](const Tensor<2, 3> &F) {
      StressRates rates{}, expected_rates{};
      const auto tau = point.evaluate(F, 0.1, &rates),
                 tau_expected = expected.evaluate(F, 0.1, &expected_rates),
                 tau_other = other.evaluate(F, 0.1);
      if (!tau || !tau_expected || !tau_other)
        return check("cylindrical axes fail", false);
      same.add((*tau - *tau_expected).norm() / tau->norm());
      same.add(relative_difference(rates, expected_rates, false));
      elsewhere = std::max(elsewhere, (*tau_other - *tau).norm() / tau->norm());
      for (LawPoint *each : {&point, &expected, &other})
        each->commit();
    });
    const double *const numbers = point.state_n().data() + law->n_state() - 9;
    for (unsigned int k = 0; k < 3; ++k)
      axes.add(std::abs(numbers[k] - radius[k]));
  }
  check("cylindrical axes, stresses and moduli", same.value(), 1e-9);
  check("cylindrical axes, in the state", axes.value(), 1e-14);
  check("cylindrical axes, other stresses elsewhere", elsewhere > 0.05);
}

} // namespace

BILLET_TEST(anisotropy) {
  for (const Sheet &sheet : sheets)
    test_sheet(sheet);
  test_stress_ratios();
  test_isotropic();
  const Axes3 axes = axes_of(Random().rotation());
  PointStep step;
  step.dt = 0.1;
  const auto mild = HillCoefficients::from_r_values(1.79, 1.51, 2.27),
             strong = HillCoefficients::from_r_values(0.3, 3., 5.);
  test_moduli("mild steel", make_law(voce, mild, axes), step, 30, 40);
  test_moduli("strong anisotropy", make_law(power_law, strong, axes), step, 30, 40);
  test_moduli("with backstress", make_law(perfect, mild, axes, {{60000., 600.}, {1500., 0.}}), step, 30, 40);
  test_objectivity();
  test_cylindrical_axes();
}

} // namespace anisotropy_test
