// SPDX-License-Identifier: LGPL-2.1-or-later
// Shear paths against closed forms: with fixed principal axes, with fixed axes under a growing rotation, and
// simple shear, whose axes turn through the material.

#include "../sample_laws.h"
#include "../testing.h"

#include "billet/material/elastic.h"

namespace shear_test {

using namespace billet;
using namespace billet::testing;
using dealii::SymmetricTensor;
using dealii::Tensor;
using dealii::Physics::Transformations::Rotations::rotation_matrix_3d;

/// Isochoric plane strain diag(λ, 1/λ, 1), e = |ln λ|: the deviatoric log strain is (e, −e, 0), of von Mises
/// measure (2/√3) e. Yielding or not, α + q/(3G) = (2/√3) e with q = σ_y(α) or α = 0; τ = (q/√3)(1, −1, 0).
struct PlaneShear {
  double alpha = 0., q = 0.;

  template <class YieldStress> PlaneShear(const double e, const YieldStress &yield_stress) {
    const double measure = 2. / std::sqrt(3.) * e, three_g = 3. * steel.shear;
    alpha = exact_plastic_strain(yield_stress, three_g * measure, three_g, 0.);
    q = three_g * (measure - alpha);
  }
};

/// diag(λ, 1/λ, 1) in the frame Q, turned by a rotation that grows to `turns` revolutions about another axis.
template <class Law, class YieldStress>
void test_fixed_axes(const std::string &name, const Law &law, const YieldStress &yield_stress,
                     const double turns) {
  Random random;
  const Tensor<2, 3> Q = random.rotation();
  const Tensor<1, 3> axis = Tensor<1, 3>({2. / 7., 3. / 7., 6. / 7.});
  WorstError error;
  for (const unsigned int n_steps : {1, 5, 100, 2000}) {
    typename Law::History history_n, history;
    for (unsigned int step = 1; step <= n_steps; ++step) {
      const double e = 0.8 * step / n_steps;
      Tensor<2, 3> U, S;
      U[0][0] = std::exp(e);
      U[1][1] = std::exp(-e);
      U[2][2] = 1.;
      const Tensor<2, 3> R = rotation_matrix_3d(axis, 2. * M_PI * turns * step / n_steps);
      SymmetricTensor<2, 3> tau;
      if (!law.update(R * Q * U * transpose(Q), history_n, history, tau, nullptr))
        return check(name, false);
      history_n = history;

      const PlaneShear exact(e, yield_stress);
      S[0][0] = exact.q / std::sqrt(3.);
      S[1][1] = -S[0][0];
      const Tensor<2, 3> exact_tau = R * Q * S * transpose(R * Q);
      error.add((static_cast<Tensor<2, 3>>(tau) - exact_tau).norm() / exact_tau.norm());
      error.add(std::abs(law.equivalent_plastic_strain(history) - exact.alpha) / (exact.alpha + 1e-300));
    }
  }
  check(name, error.value(), 1e-10);
}

Tensor<2, 3> simple_shear(const double gamma) {
  Tensor<2, 3> F = dealii::unit_symmetric_tensor<3>();
  F[0][1] = gamma;
  return F;
}

/// Simple shear F = 1 + γ e1⊗e2: b has the principal stretches λ, 1/λ, 1 with ln λ = asinh(γ/2), the first
/// along the angle θ, tan 2θ = 2/γ. With q from PlaneShear, τ11 = −τ22 = (q/√3) γ/√(4+γ²), τ12 = (q/√3)
/// 2/√(4+γ²). For Hencky elasticity that is τ12 = 4 G asinh(γ/2)/√(4+γ²) at any step size; for plasticity it
/// holds for one single step.
template <class YieldStress>
SymmetricTensor<2, 3> exact_simple_shear(const double gamma, const YieldStress &yield_stress) {
  const double s = PlaneShear(std::asinh(0.5 * std::abs(gamma)), yield_stress).q / std::sqrt(3.);
  SymmetricTensor<2, 3> tau;
  tau[0][0] = s * std::abs(gamma) / std::sqrt(4. + gamma * gamma);
  tau[1][1] = -tau[0][0];
  tau[0][1] = std::copysign(2. * s / std::sqrt(4. + gamma * gamma), gamma);
  return tau;
}

template <class Law, class YieldStress>
double simple_shear_error(const Law &law, const YieldStress &yield_stress, const double gamma,
                          const unsigned int n_steps) {
  typename Law::History history_n, history;
  SymmetricTensor<2, 3> tau;
  for (unsigned int step = 1; step <= n_steps; ++step) {
    if (!law.update(simple_shear(gamma * step / n_steps), history_n, history, tau, nullptr))
      return std::nan("");
    history_n = history;
  }
  const SymmetricTensor<2, 3> exact = exact_simple_shear(gamma, yield_stress);
  return (tau - exact).norm() / exact.norm();
}

/// Perfect plasticity in steady simple shear. The elastic strain stands still: 2 γ̇_p n b_e = L b_e + b_e Lᵀ
/// with b_e of stretches exp(±s/2G), s = σ_y/√3. Its off-diagonal part in principal axes gives tan θ =
/// exp(−s/G), hence τ12 = s / cosh(s/G), τ11 = s tanh(s/G), dα/dγ = 1/(√3 cosh(s/G)). Backward Euler gets
/// there with an error of first order in the step, which extrapolation removes.
void test_steady_simple_shear() {
  const double G = 100., s = 30.;
  const HenckyPlasticity law(ElasticModuli{250., G}, make_hardening(LinearHardening{s * std::sqrt(3.), 0.}));
  const auto run = [&](const unsigned int steps_per_unit) {
    HenckyPlasticity::History history_n, history;
    SymmetricTensor<2, 3> tau;
    double rate = 0.;
    for (unsigned int step = 1; step <= 8 * steps_per_unit; ++step) {
      law.update(simple_shear(1. * step / steps_per_unit), history_n, history, tau, nullptr);
      rate = (history.equivalent_plastic_strain - history_n.equivalent_plastic_strain) * steps_per_unit;
      history_n = history;
    }
    return Tensor<1, 3>({tau[0][1] / (s / std::cosh(s / G)) - 1., tau[0][0] / (s * std::tanh(s / G)) - 1.,
                         rate * std::sqrt(3.) * std::cosh(s / G) - 1.});
  };
  const Tensor<1, 3> coarse = run(100), middle = run(200), fine = run(400);
  check("steady simple shear of perfect plasticity, 400 steps per unit", fine.norm(), 5e-3);
  check("steady simple shear, first order", std::abs(coarse.norm() / middle.norm() - 2.), 0.05);
  check("steady simple shear, extrapolated", (8. / 3. * fine - 2. * middle + 1. / 3. * coarse).norm(), 1e-7);
}

BILLET_TEST(shear) {
  const auto never = [](const double) { return 1e300; };
  const HenckyElasticity elastic(steel);
  test_fixed_axes("elastic, fixed axes", elastic, never, 0.);
  test_fixed_axes("elastic, growing rotation", elastic, never, 1.3);
  WorstError error;
  for (const double gamma : {-3., -0.1, 1e-4, 0.01, 0.5, 1., 4.})
    error.add(simple_shear_error(elastic, never, gamma, 7));
  check("elastic, simple shear", error.value(), 1e-10);

  for_each_hardening([&](const std::string &name, const auto &hardening) {
    const HenckyPlasticity law(steel, make_hardening(hardening));
    const auto yield_stress = [&](const double alpha) { return hardening.stress(alpha); };
    test_fixed_axes(name + ", fixed axes", law, yield_stress, 0.);
    test_fixed_axes(name + ", growing rotation", law, yield_stress, 1.3);
    // q = 2√3 G asinh(γ/2)
    const double gamma_yield = 2. * std::sinh(hardening.stress(0.) / (2. * std::sqrt(3.) * steel.shear));
    check(name + ", simple shear to just below yield in 50 steps",
          simple_shear_error(law, never, 0.9999 * gamma_yield, 50), 1e-10);
    check(name + ", simple shear in one step", simple_shear_error(law, yield_stress, 0.7, 1), 1e-10);
  });
  test_steady_simple_shear();
}

} // namespace shear_test
