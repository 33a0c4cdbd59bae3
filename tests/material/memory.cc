// SPDX-License-Identifier: LGPL-2.1-or-later
// What laws remember beside stress and plastic strain: a point that is made anew from stress, plastic strain
// and memory goes on as the point that it came from, with backstress, heat, rates, viscosity and anisotropy,
// also in cylindrical axes. Without memory it does not. A point at another deformation keeps its backstress
// in space. The heat of a law with backstress is the fraction of all its plastic work.

#include "rubber_laws.h"

#include "billet/material/flow_rule.h"
#include "billet/material/hardening.h"
#include "billet/material/law_point.h"
#include "billet/material/rate_factor.h"
#include "billet/material/thermal_factor.h"

namespace memory_test {

using namespace billet;
using namespace billet::testing;

namespace {

constexpr double dt = 0.01, temperature = 293., heating = 0.2;
const Tensor<1, 3> place({3., 1., 2.}); // of the element

SharedFlow flow_at_rates() {
  const auto rate = rate_factor_types()
                        .find("Johnson-Cook")
                        ->make(GivenValues({{"Rate coefficient", 0.02}, {"Lowest rate", 0.1}}));
  return at_rate(LinearHardening{300., 1000.}, rate);
}

FlowRule kinematic() {
  FlowRule rule;
  rule.backstress = {{20000., 100.}, {3000., 0.}};
  return rule;
}

FlowRule thermal(FlowRule rule) {
  rule.thermal = thermal_factor_types()
                     .find("Johnson-Cook")
                     ->make(Texts({{"Reference temperature", "293"},
                                   {"Melting temperature", "1793"},
                                   {"Thermal exponent", "1"}}));
  rule.heating = heating;
  return rule;
}

FlowRule anisotropic(FlowRule rule) {
  const double c = std::cos(0.4), s = std::sin(0.4);
  rule.anisotropy = std::make_shared<const Anisotropy>(
      Anisotropy{HillCoefficients::from_r_values(1.8, 1.3, 2.2),
                 Axes({Tensor<1, 3>({c, s, 0.}), Tensor<1, 3>({-s, c, 0.}), Tensor<1, 3>({0., 0., 1.})})});
  return rule;
}

FlowRule cylindrical(FlowRule rule) {
  rule.anisotropy = std::make_shared<const Anisotropy>(
      Anisotropy{rule.anisotropy->coefficients, Axes::about({}, Tensor<1, 3>({0., 0.6, 0.8}))});
  return rule;
}

/// Deformations of a path in steps.
std::vector<Tensor<2, 3>> path(const unsigned int n) {
  Random random;
  std::vector<Tensor<2, 3>> result;
  Tensor<2, 3> F = unit;
  for (unsigned int i = 0; i < n; ++i) {
    F = (unit + random.tensor(0.02)) * F;
    F /= std::cbrt(dealii::determinant(F));
    result.push_back(F);
  }
  return result;
}

void follow(LawPoint &point, const std::vector<Tensor<2, 3>> &deformations) {
  for (const Tensor<2, 3> &F : deformations) {
    AssertThrow(point.evaluate(F, dt), dealii::ExcInternalError());
    point.commit();
  }
}

/// Makes a point anew from the stress of another, with or without memory.
LawPoint renewed(const PointLaw &law, LawPoint &point, const Tensor<2, 3> &F, const bool remembers) {
  LawPoint result(law, temperature, place);
  const double *const state = point.state_n().data();
  law.set_stress(F, dealii::deviator(*point.evaluate(F, 0.)), law.equivalent_plastic_strain(state),
                 result.state_n().data());
  if (remembers)
    law.remember(F, law.memory(F, state), result.state_n().data());
  return result;
}

void test_continuation(const std::string &name, const PointLaw &law) {
  constexpr unsigned int n = 20;
  const auto all = path(2 * n);
  const std::vector<Tensor<2, 3>> before(all.begin(), all.begin() + n), after(all.begin() + n, all.end());
  LawPoint point(law, temperature, place);
  follow(point, before);
  LawPoint same = renewed(law, point, before.back(), true), other = renewed(law, point, before.back(), false);
  const double dissipated = law.dissipated_energy(point.state_n().data());
  check(name + ", dissipated energy",
        std::abs(law.dissipated_energy(same.state_n().data()) / dissipated - 1.), 1e-10);
  double error = 0., without = 0.;
  for (const Tensor<2, 3> &F : after) {
    const auto expected = *point.evaluate(F, dt);
    error = std::max(error, (*same.evaluate(F, dt) - expected).norm() / expected.norm());
    without = std::max(without, (*other.evaluate(F, dt) - expected).norm() / expected.norm());
    for (LawPoint *each : {&point, &same, &other})
      each->commit();
  }
  check(name + ", stresses", error, 1e-8);
  check(
      name + ", dissipated energy at the end",
      std::abs(law.dissipated_energy(same.state_n().data()) / law.dissipated_energy(point.state_n().data()) -
               1.),
      1e-8);
  check(name + ", other ones without memory",
        without > 1e-3 || std::abs(law.dissipated_energy(other.state_n().data()) /
                                       law.dissipated_energy(point.state_n().data()) -
                                   1.) > 1e-3);
}

/// Another deformation, as an element with other strains has it.
void test_other_deformation() {
  const SharedLaw law = make_hencky_law(steel, make_hardening(LinearHardening{300., 1000.}), kinematic());
  const auto all = path(20);
  LawPoint point(*law);
  follow(point, all);
  Random random;
  const Tensor<2, 3> F = (unit + random.tensor(0.1)) * all.back();
  LawPoint moved(*law);
  law->set_stress(F, {}, 0.1, moved.state_n().data());
  const std::vector<double> memory = law->memory(all.back(), point.state_n().data());
  law->remember(F, memory, moved.state_n().data());
  const std::vector<double> again = law->memory(F, moved.state_n().data());
  double error = 0., size = 0.;
  for (std::size_t k = 0; k < memory.size(); ++k) {
    error = std::max(error, std::abs(again[k] - memory[k]));
    size = std::max(size, std::abs(memory[k]));
  }
  check("backstress stays at another deformation", size > 1e-3 && again.size() == memory.size());
  check("to round-off", error / size, 1e-10);
}

/// Cycles with backstress: the heat is the fraction of the plastic work, stored energy of backstress
/// included.
void test_heat() {
  const SharedLaw law =
      make_hencky_law(steel, make_hardening(LinearHardening{300., 1000.}), thermal(kinematic()));
  std::size_t place = 0;
  for (const StateField &field : law->fields()) {
    if (field.name == "temperature rise")
      break;
    place += field.n_components;
  }
  LawPoint point(*law, temperature);
  double work = 0., last_strain = 0.;
  SymmetricTensor<2, 3> last;
  constexpr unsigned int n = 4000;
  for (unsigned int i = 1; i <= n; ++i) {
    const double strain = 0.02 * std::sin(6. * dealii::numbers::PI * i / n);
    Tensor<2, 3> F;
    F[0][0] = std::exp(strain);
    F[1][1] = F[2][2] = std::exp(-0.5 * strain);
    const SymmetricTensor<2, 3> tau = *point.evaluate(F, dt);
    point.commit();
    const auto mean = 0.5 * (tau + last);
    work += (strain - last_strain) * (mean[0][0] - 0.5 * (mean[1][1] + mean[2][2]));
    last = tau;
    last_strain = strain;
  }
  const double elastic = dealii::deviator(last) * dealii::deviator(last) / (4. * steel.shear);
  check("heat is the fraction of the plastic work",
        std::abs(point.state_n()[place] / (heating * (work - elastic)) - 1.), 2e-3);
}

} // namespace

BILLET_TEST(memory) {
  const SharedFlow linear = make_hardening(LinearHardening{300., 1000.});
  test_continuation("rate", *make_hencky_law(steel, flow_at_rates()));
  test_continuation("rate, hypoelastic", *make_hypoelastic_law(steel, flow_at_rates()));
  test_continuation("backstress", *make_hencky_law(steel, linear, kinematic()));
  test_continuation("heat", *make_hencky_law(steel, linear, thermal({})));
  test_continuation("all", *make_hencky_law(steel, flow_at_rates(), anisotropic(thermal(kinematic()))));
  test_continuation("cylindrical axes",
                    *make_hencky_law(steel, flow_at_rates(), cylindrical(anisotropic(thermal(kinematic())))));
  test_continuation("viscosity",
                    ViscoelasticLaw(HyperelasticLaw("test", mooney_energy(), volume(logarithmic)),
                                    {{0.3, 0.25, 0.1}, {0.02, 1., 30.}}));
  test_other_deformation();
  test_heat();
}

} // namespace memory_test
