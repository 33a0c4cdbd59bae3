// SPDX-License-Identifier: LGPL-2.1-or-later
// Hyperelastic laws of rubber at a point: closed forms of four modes, volumetric laws, moduli against
// differences, objectivity, energy against work, the bound of explicit steps, Drucker's range and refusals.

#include "rubber_laws.h"

#include <map>

namespace rubber_test {

using namespace billet;
using namespace billet::testing;

namespace {

Tensor<2, 3> diagonal(const double a, const double b, const double c) {
  Tensor<2, 3> F;
  F[0][0] = a;
  F[1][1] = b;
  F[2][2] = c;
  return F;
}

/// Nominal stresses of an incompressible solid at a stretch.
struct Nominal {
  double uniaxial, equibiaxial, planar;
};
Nominal nominal(const SharedEnergy &energy, const double l) {
  const HyperelasticLaw law("test", energy, volume(logarithmic));
  Point point(law);
  const auto one = point.evaluate(diagonal(l, 1. / std::sqrt(l), 1. / std::sqrt(l)), 0.),
             two = point.evaluate(diagonal(l, l, 1. / (l * l)), 0.),
             plane = point.evaluate(diagonal(l, 1., 1. / l), 0.);
  return {(one[0][0] - one[1][1]) / l, (two[0][0] - two[2][2]) / l, (plane[0][0] - plane[2][2]) / l};
}

bool has_text(const std::string &text, const std::string &part) {
  return text.find(part) != std::string::npos;
}

double relative(const double a, const double b) { return std::abs(a - b) / std::max(1., std::abs(b)); }

void test_closed_forms() {
  WorstError mooney, yeoh, ogden, shear;
  for (const double l : {0.3, 0.5, 0.9, 1.001, 1.5, 2., 4., 7.}) {
    const Nominal m = nominal(mooney_energy(), l);
    mooney.add(relative(m.uniaxial, 2. * (l - std::pow(l, -2.)) * (mooney_10 + mooney_01 / l)));
    mooney.add(relative(m.equibiaxial, 2. * (l - std::pow(l, -5.)) * (mooney_10 + l * l * mooney_01)));
    mooney.add(relative(m.planar, 2. * (l - std::pow(l, -3.)) * (mooney_10 + mooney_01)));
    const Nominal y = nominal(make_invariant_energy(yeoh_constants), l);
    const auto slope = [](const double x) {
      return yeoh_constants[0] + 2. * yeoh_constants[1] * x + 3. * yeoh_constants[2] * x * x;
    };
    yeoh.add(relative(y.uniaxial, 2. * (l - std::pow(l, -2.)) * slope(l * l + 2. / l - 3.)));
    yeoh.add(
        relative(y.equibiaxial, 2. * (l - std::pow(l, -5.)) * slope(2. * l * l + std::pow(l, -4.) - 3.)));
    yeoh.add(relative(y.planar, 2. * (l - std::pow(l, -3.)) * slope(l * l + 1. / (l * l) - 2.)));
    const Nominal o = nominal(make_ogden_energy(ogden_moduli, ogden_exponents), l);
    Nominal exact{};
    for (std::size_t p = 0; p < 3; ++p) {
      const double mu = ogden_moduli[p], a = ogden_exponents[p];
      exact.uniaxial += mu * (std::pow(l, a - 1.) - std::pow(l, -0.5 * a - 1.));
      exact.equibiaxial += mu * (std::pow(l, a - 1.) - std::pow(l, -2. * a - 1.));
      exact.planar += mu * (std::pow(l, a - 1.) - std::pow(l, -a - 1.));
    }
    ogden.add(relative(o.uniaxial, exact.uniaxial));
    ogden.add(relative(o.equibiaxial, exact.equibiaxial));
    ogden.add(relative(o.planar, exact.planar));
    // simple shear by l − 1
    const double gamma = l - 1., stretch = 0.5 * gamma + std::sqrt(1. + 0.25 * gamma * gamma);
    Tensor<2, 3> F = unit;
    F[0][1] = gamma;
    const HyperelasticLaw rivlin("", mooney_energy(), volume(logarithmic)),
        of_ogden("", make_ogden_energy(ogden_moduli, ogden_exponents), volume(logarithmic));
    const auto tau = Point(rivlin).evaluate(F, 0.);
    shear.add(relative(tau[0][1], 2. * (mooney_10 + mooney_01) * gamma));
    shear.add(relative(tau[0][0] - tau[2][2], 2. * mooney_10 * gamma * gamma));
    shear.add(relative(tau[2][2] - tau[1][1], 2. * mooney_01 * gamma * gamma));
    double of_shear = 0.;
    for (std::size_t p = 0; p < 3; ++p)
      of_shear += ogden_moduli[p] *
                  (std::pow(stretch, ogden_exponents[p]) - std::pow(stretch, -ogden_exponents[p])) /
                  (stretch + 1. / stretch);
    shear.add(relative(Point(of_ogden).evaluate(F, 0.)[0][1], of_shear));
  }
  check("uniaxial, equibiaxial, planar tension, Mooney-Rivlin", mooney.value(), 1e-10);
  check("the same, Yeoh", yeoh.value(), 1e-10);
  check("the same, Ogden", ogden.value(), 1e-10);
  check("simple shear, with normal stresses", shear.value(), 1e-10);
  // Separate evaluations of the formulas, to the digits that they have.
  const SharedEnergy treloar = make_ogden_energy(ogden_moduli, ogden_exponents);
  check("Ogden's fit of Treloar's data at a stretch of 7, uniaxial",
        std::abs(nominal(treloar, 7.).uniaxial - 3.9952), 6e-5);
  check("and planar", std::abs(nominal(treloar, 7.).planar - 4.0735), 6e-5);
  check("and equibiaxial at 4", std::abs(nominal(treloar, 4.).equibiaxial - 1.8977), 6e-5);
}

std::shared_ptr<const SpatialLaw> make_law(const std::string &name,
                                           const std::map<std::string, double> &values,
                                           const std::map<std::string, std::vector<double>> &lists = {},
                                           const std::map<std::string, std::string> &texts = {}) {
  class Values final : public TypeInput {
  public:
    Values(std::map<std::string, double> values, std::map<std::string, std::vector<double>> lists,
           std::map<std::string, std::string> texts)
        : numbers_(std::move(values)), lists_(std::move(lists)), texts_(std::move(texts)) {}
    bool is_set(const std::string &key) const override {
      return numbers_.count(key) + lists_.count(key) + texts_.count(key) > 0;
    }
    double number(const std::string &key) const override {
      const auto found = numbers_.find(key);
      return found != numbers_.end() ? found->second : key == "Volumetric exponent" ? 9. : 0.;
    }
    double positive(const std::string &key) const override {
      if (!(number(key) > 0.))
        reject(key, "a number > 0");
      return number(key);
    }
    double not_negative(const std::string &key) const override { return number(key); }
    std::string text(const std::string &key) const override {
      const auto found = texts_.find(key);
      return found != texts_.end() ? found->second : "logarithmic";
    }
    std::vector<double> numbers(const std::string &key) const override {
      const auto found = lists_.find(key);
      return found != lists_.end() ? found->second : std::vector<double>();
    }
    bool flag(const std::string &key) const override { reject(key, "no flag"); }
    Tensor<1, 3> vector(const std::string &key) const override { reject(key, "no vector"); }
    Tensor<1, 3> direction(const std::string &key) const override { reject(key, "no direction"); }
    std::vector<std::string> parts(const std::string &key, char) const override { reject(key, "no parts"); }
    std::string file(const std::string &key) const override { reject(key, "no file"); }
    std::string origin(const std::string &key) const override { return "'" + key + "'"; }
    [[noreturn]] void reject(const std::string &key, const std::string &allowed) const override {
      throw std::invalid_argument("'" + key + "': allowed is " + allowed);
    }

  private:
    std::map<std::string, double> numbers_;
    std::map<std::string, std::vector<double>> lists_;
    std::map<std::string, std::string> texts_;
  };
  return std::dynamic_pointer_cast<const SpatialLaw>(
      elasticity_types().find(name)->make(Values(values, lists, texts))->make_elastic_law());
}

/// W = M Σ_i C_i/L^{2i−2} (I1^i − 3^i) as Arruda and Boyce have it.
void test_arruda_boyce() {
  constexpr double mu = 0.27, limit = 3.5;
  const auto law =
      make_law("Arruda-Boyce", {{"Chain modulus", mu}, {"Locking stretch", limit}, {"Bulk modulus", 50.}});
  constexpr std::array<double, 5> C = {1. / 2., 1. / 20., 11. / 1050., 19. / 7000., 519. / 673750.};
  WorstError error;
  for (const double l : {0.4, 0.99, 1.3, 2.5, 5.}) {
    const double I = l * l + 2. / l;
    double slope = 0., energy = 0.;
    for (unsigned int i = 1; i <= 5; ++i) {
      const double factor = mu * C[i - 1] / std::pow(limit, 2. * i - 2.);
      slope += factor * i * std::pow(I, i - 1.);
      energy += factor * (std::pow(I, i) - std::pow(3., i));
    }
    const Tensor<2, 3> F = diagonal(l, 1. / std::sqrt(l), 1. / std::sqrt(l));
    Point point(*law);
    const auto tau = point.evaluate(F, 0.);
    error.add(relative((tau[0][0] - tau[1][1]) / l, 2. * slope * (l - 1. / (l * l))));
    error.add(relative(point.stored(F), energy));
  }
  check("uniaxial tension and energy, Arruda-Boyce", error.value(), 1e-10);
  const double N = limit * limit;
  check("its shear modulus",
        std::abs(law->elastic().shear / mu - 1. - 3. / (5. * N) - 99. / (175. * N * N) -
                 513. / (875. * N * N * N) - 42039. / (67375. * N * N * N * N)),
        1e-12);
}

void test_volume() {
  WorstError difference, slope, bound;
  for (const auto &type : volumetric_law_types())
    for (const double J : {0.5, 0.9, 1., 1.1, 1.6}) {
      const VolumetricEnergy U = volume(type.name);
      difference.add(std::abs(J * central_difference([&](const double e) { return U.energy(J + e); }, 2e-4) -
                              U.mean_stress(J)) /
                     U.bulk_modulus());
      slope.add(std::abs(J * central_difference([&](const double e) { return U.mean_stress(J + e); }, 2e-4) -
                         U.slope(J)) /
                (U.bulk_modulus() + std::abs(U.slope(J))));
      bound.add(U.slope(J) / U.bound_slope(U.mean_stress(J)) - 1.);
    }
  check("pressures are derivatives of volumetric energies", difference.value(), 1e-8);
  check("and slopes those of pressures", slope.value(), 1e-8);
  check("slopes are below their bound", bound.value(), 1e-12);
  check("Ogden's volumetric energy with its exponent",
        std::abs(volume("Ogden").mean_stress(0.5) - 20. / 9. * (1. - std::pow(2., 9.))), 1e-10);
}

/// The greatest eigenvalue of the stiffness c + τ by squared velocity gradients, by the power method.
double greatest_stiffness(const SpatialModuli &c, const SymmetricTensor<2, 3> &tau) {
  const auto apply = [&](const Tensor<2, 3> &L) { // P with P : M the second variation
    const Tensor<2, 3> of_moduli = predict(c, SymmetricTensor<2, 3>(), L);
    return of_moduli + L * static_cast<Tensor<2, 3>>(tau);
  };
  Random random;
  Tensor<2, 3> L = random.tensor(1.);
  const double shift = norm(c) + 3. * tau.norm();
  double value = 0.;
  for (unsigned int i = 0; i < 2000; ++i) {
    const Tensor<2, 3> next = apply(L) + shift * L;
    value = next.norm() / L.norm() - shift;
    L = next / next.norm();
  }
  return value;
}

void test_points() {
  for (const auto &[name, energy] : rubber_energies()) {
    WorstError tangent, energy_error, turned, bound, bound_of_moduli, excess;
    for (const auto &type : volumetric_law_types()) {
      const HyperelasticLaw law("test", energy, volume(type.name));
      for (const Tensor<2, 3> &F : sampled_gradients()) {
        Point point(law);
        tangent.add(moduli_error(point, F, 0.));
        Random random;
        const Tensor<2, 3> R = random.rotation(), L = random.tensor(1.);
        SpatialModuli c;
        const auto tau = point.evaluate(F, 0., &c);
        turned.add((static_cast<Tensor<2, 3>>(point.evaluate(R * F, 0.)) - R * tau * transpose(R)).norm() /
                   (tau.norm() + 1.));
        energy_error.add(
            std::abs(
                central_difference([&](const double e) { return point.stored((unit + e * L) * F); }, 1e-3) -
                scalar_product(static_cast<Tensor<2, 3>>(tau), L)) /
            norm(c));
        const double greatest = greatest_stiffness(c, tau), by_moduli = bound_by_moduli(c, tau);
        bound.add(greatest / law.bound_stiffness(tau) - 1.);
        bound_of_moduli.add(greatest / by_moduli - 1.);
        excess.add(by_moduli / greatest);
      }
    }
    check(name + ", moduli", tangent.value(), 1e-7);
    check(name + ", stress is the derivative of the energy", energy_error.value(), 1e-8);
    check(name + ", stress turns", turned.value(), 1e-12);
    check(name + ", stiffness is below its bound", bound.value(), 1e-12);
    check(name + ", and below that of the moduli", bound_of_moduli.value(), 1e-12);
    check(name + ", which is at most four times as large", excess.value(), 4.);
  }
}

/// Energy along a random closed path is the work of the stress.
void test_work() {
  WorstError error;
  for (const auto &[name, energy] : rubber_energies()) {
    const HyperelasticLaw law("test", energy, volume("quadratic"));
    Point point(law);
    Random random;
    const Tensor<2, 3> A = random.tensor(0.5), B = random.tensor(0.5);
    double work = 0.;
    constexpr unsigned int n = 2000;
    const auto at = [&](const double s) {
      return static_cast<Tensor<2, 3>>(unit + std::sin(1.5 * s) * A + s * s * B);
    };
    for (unsigned int i = 0; i < n; ++i) // Gauss' rule of two points
      for (const double place : {0.5 - 0.5 / std::sqrt(3.), 0.5 + 0.5 / std::sqrt(3.)}) {
        const double s = (i + place) / n;
        const Tensor<2, 3> F = at(s), rate = 1.5 * std::cos(1.5 * s) * A + 2. * s * B;
        work += 0.5 / n * scalar_product(static_cast<Tensor<2, 3>>(point.evaluate(F, 0.)), rate * invert(F));
      }
    error.add(std::abs(work / point.stored(at(1.)) - 1.));
  }
  check("energy is the work along a path", error.value(), 1e-8);
}

void test_stability() {
  const auto ranges = find_stable_ranges(*make_ogden_energy(ogden_moduli, ogden_exponents));
  check("Ogden's fit of Treloar's data is stable everywhere",
        ranges[0].lowest == 0.1 && ranges[0].highest == 10. && ranges[1].highest == 10. &&
            ranges[2].highest == 10.);
  check("and nothing is said of it",
        describe_stability(*make_ogden_energy(ogden_moduli, ogden_exponents)).empty());
  // W = C10 (I1 − 3) − c (I1 − 3)²: in pure shear, e = (x, 0, −x), the limit is the root of a scalar
  // function.
  const SharedEnergy softening = make_invariant_energy({1., -0.1});
  const auto planar = find_stable_ranges(*softening)[2];
  const auto stiffness = [&](const double l) {
    // along e = (x, 0, -x): W'' = w1 I'' + w11 I'^2, I = l^2 + l^-2 + 1
    const double I = l * l + 1. / (l * l) + 1., first = 2. * (l * l - 1. / (l * l)),
                 second = 4. * (l * l + 1. / (l * l)), w1 = 1. - 0.2 * (I - 3.);
    return w1 * second - 0.2 * first * first;
  };
  check("a law that softens loses stability where its shear stress falls, at most",
        stiffness(planar.highest) > -0.05 && planar.highest < 2. && planar.highest > 1.2);
  check("and it is said", has_text(describe_stability(*softening), "stable (Drucker) at stretches of "));
  check("Mooney's law with a negative constant",
        find_stable_ranges(*make_ogden_energy({1.2, 0.2}, {2., -2.}))[1].highest < 3.);
}

std::string refusal(const std::string &name, const std::map<std::string, double> &values,
                    const std::map<std::string, std::vector<double>> &lists = {},
                    const std::map<std::string, std::string> &texts = {}) {
  try {
    make_law(name, values, lists, texts);
  } catch (const std::invalid_argument &error) {
    return error.what();
  }
  return "";
}

void test_refusals() {
  const auto is_refused = [](const std::string &what, const std::string &message, const std::string &part) {
    check(what + " is refused", has_text(message, part));
  };
  is_refused("a negative shear modulus", refusal("Mooney-Rivlin", {{"C10", -1.}, {"Bulk modulus", 1.}}),
             "initial shear modulus > 0; it is -2");
  is_refused("no volumetric constant", refusal("Yeoh", {{"C10", 1.}}), "exactly one");
  is_refused("two of them", refusal("Yeoh", {{"C10", 1.}, {"Bulk modulus", 1.}, {"Poisson ratio", 0.4}}),
             "exactly one");
  is_refused("a Poisson ratio of 0.499991", refusal("Yeoh", {{"C10", 1.}, {"Poisson ratio", 0.499991}}),
             "<= 0.49999");
  is_refused(
      "fewer exponents than moduli",
      refusal("Ogden", {{"Bulk modulus", 1.}}, {{"Ogden moduli", {1., 2.}}, {"Ogden exponents", {2.}}}),
      "Ogden exponents");
  is_refused("a locking stretch of 1",
             refusal("Arruda-Boyce", {{"Chain modulus", 1.}, {"Locking stretch", 1.}, {"Bulk modulus", 1.}}),
             "> 1");
  is_refused("a volumetric exponent of 0",
             refusal("Yeoh", {{"C10", 1.}, {"Bulk modulus", 1.}, {"Volumetric exponent", 0.}}, {},
                     {{"Volumetric law", "Ogden"}}),
             "a number other than 0");
  is_refused("Prony's series that relaxes all",
             refusal("Yeoh", {{"C10", 1.}, {"Bulk modulus", 1.}},
                     {{"Prony moduli", {0.5, 0.5}}, {"Prony times", {1., 2.}}}),
             "sum is < 1");
  const auto law = make_law("Ogden", {{"Poisson ratio", 0.49999}},
                            {{"Ogden moduli", ogden_moduli}, {"Ogden exponents", ogden_exponents}},
                            {{"Volumetric law", "quadratic"}});
  check("Poisson's ratio gives the bulk modulus", std::abs(law->elastic().poisson_ratio() - 0.49999), 1e-12);
  check("and half the sum of products the shear modulus", std::abs(law->elastic().shear - 0.4225), 1e-12);
}

} // namespace

BILLET_TEST(rubber) {
  test_closed_forms();
  test_arruda_boyce();
  test_volume();
  test_points();
  test_work();
  test_stability();
  test_refusals();
}

} // namespace rubber_test
