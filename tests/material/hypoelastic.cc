// SPDX-License-Identifier: LGPL-2.1-or-later
// The hypoelastic laws: rotations of any size turn the stress and do nothing else; simple shear against the
// closed form of the steps and, with many of them, Jaumann's G sin γ; uniaxial steps; the return map; the
// tangent, which is not symmetric, against differences.

#include "../sample_laws.h"
#include "../testing.h"

#include "billet/material/hypoelastic.h"

#include <complex>

namespace hypoelastic_test {

using namespace billet;
using namespace billet::testing;
using dealii::SymmetricTensor;
using dealii::Tensor;
using dealii::Physics::Transformations::Rotations::rotation_matrix_3d;

const Tensor<2, 3> unit = dealii::unit_symmetric_tensor<3>();

/// The elastic and the plastic law by one interface, pressure from det F.
template <class Law>
bool update(const Law &law, const Tensor<2, 3> &F, const typename Law::History &history_n,
            typename Law::History &history, SymmetricTensor<2, 3> &tau, GradientModuli *moduli = nullptr) {
  return law.update(F, determinant(F), history_n, history, tau, moduli);
}

template <class Law> void test_rotations(const std::string &name, const Law &law) {
  Random random;
  typename Law::History start, history_n, history;
  SymmetricTensor<2, 3> tau_0, tau;
  const Tensor<2, 3> F = unit + random.tensor(0.1);
  if (!update(law, F, {}, start, tau_0))
    return check(name, false);
  history_n = start;
  WorstError turned, plastic;
  Tensor<2, 3> Q = unit;
  for (unsigned int step = 0; step < 200; ++step) {
    // By π the middle of the step is flat: not admissible.
    Tensor<1, 3> axis = random.vector(1.);
    Q = rotation_matrix_3d(Tensor<1, 3>(axis / axis.norm()), random(0., 2.5)) * Q;
    if (!update(law, Q * F, history_n, history, tau))
      return check(name, false);
    turned.add((static_cast<Tensor<2, 3>>(tau) - Q * static_cast<Tensor<2, 3>>(tau_0) * transpose(Q)).norm() /
               tau_0.norm());
    plastic.add(std::abs(law.equivalent_plastic_strain(history) - law.equivalent_plastic_strain(start)));
    history_n = history;
  }
  check(name + ", rotations turn the stress", turned.value(), 1e-11);
  check(name + ", rotations make no plastic strain", plastic.value(), 1e-12);
}

/// In a step of Δγ ΔL = Δγ e1⊗e2, and R turns by −φ, tan(φ/2) = Δγ/4: z = τ11 + i τ12 becomes
/// z e^{−2iφ} + i G Δγ. In the limit z = G (1 − e^{−iγ}).
void test_simple_shear() {
  const HypoelasticElasticity law(steel);
  for (const unsigned int n_steps : {1, 7, 2000}) {
    const double gamma = 3., step = gamma / n_steps, G = steel.shear;
    HypoelasticElasticity::History history_n, history;
    SymmetricTensor<2, 3> tau;
    for (unsigned int i = 1; i <= n_steps; ++i) {
      Tensor<2, 3> F = unit;
      F[0][1] = i * step;
      update(law, F, history_n, history, tau);
      history_n = history;
    }
    const std::complex<double> turn = std::polar(1., -4. * std::atan(0.25 * step));
    const std::complex<double> z =
        std::complex<double>(0., G * step) * (std::pow(turn, n_steps) - 1.) / (turn - 1.);
    check("simple shear in " + std::to_string(n_steps) + " steps",
          std::abs(std::complex<double>(tau[0][0], tau[0][1]) - z) / std::abs(z) +
              std::abs(tau[0][0] + tau[1][1]) / G,
          1e-10);
    // The strain of a step is not turned by its half: first order.
    const std::complex<double> limit = G * (1. - std::polar(1., -gamma));
    if (n_steps == 2000)
      check("simple shear, limit, but for half a step's turn",
            std::abs(std::complex<double>(tau[0][0], tau[0][1]) * std::polar(1., -0.5 * step) - limit) /
                std::abs(limit),
            1e-6);
  }
}

/// Coaxial stretches: ε = Σ 2 (λ − λ_n)/(λ + λ_n), dev τ = 2 G dev ε, and with perfect plasticity q = σ_y, α
/// = what the strain q/3G leaves over.
void test_stretch() {
  const HypoelasticElasticity elastic(steel);
  const HypoelasticPlasticity plastic(steel, make_hardening(perfect));
  HypoelasticElasticity::History elastic_n, elastic_history;
  HypoelasticPlasticity::History plastic_n, plastic_history;
  SymmetricTensor<2, 3> tau, plastic_tau;
  Tensor<1, 3> strain;
  std::array<double, 3> last = {1., 1., 1.};
  constexpr unsigned int n_steps = 5;
  for (unsigned int i = 1; i <= n_steps; ++i) {
    Tensor<2, 3> F;
    const double t = static_cast<double>(i) / n_steps;
    const std::array<double, 3> stretch = {1. + t, 1. - 0.3 * t, 1. - 0.3 * t};
    for (unsigned int k = 0; k < 3; ++k) {
      F[k][k] = stretch[k];
      strain[k] += 2. * (stretch[k] - last[k]) / (stretch[k] + last[k]);
    }
    last = stretch;
    update(elastic, F, elastic_n, elastic_history, tau);
    update(plastic, F, plastic_n, plastic_history, plastic_tau);
    elastic_n = elastic_history;
    plastic_n = plastic_history;
  }
  const double difference = strain[0] - strain[1]; // uniaxial: q = 2 G |difference|
  const double pressure = steel.bulk * std::log(2. * 0.7 * 0.7);
  check("stretch, elastic",
        std::abs((tau[0][0] - tau[1][1]) / (2. * steel.shear * difference) - 1.) +
            std::abs(trace(tau) / 3. / pressure - 1.),
        1e-12);
  check("stretch, perfectly plastic, stress",
        std::abs((plastic_tau[0][0] - plastic_tau[1][1]) / perfect.yield_stress - 1.), 1e-12);
  check("stretch, perfectly plastic, plastic strain",
        std::abs(plastic_history.equivalent_plastic_strain -
                 (2. / 3. * difference - perfect.yield_stress / (3. * steel.shear))),
        1e-12);
}

/// δτ by A : L and, at fixed J, no pressure; in a second step, with a turn between the two.
template <class Law> void test_moduli(const std::string &name, const Law &law, const double size) {
  WorstError error, stiffness;
  Random random;
  double max_asymmetry = 0.;
  for (unsigned int path = 0; path < 10; ++path) {
    const Tensor<2, 3> F_n = unit + random.tensor(size),
                       F = (path % 2 == 0 ? random.rotation() : unit) * (unit + random.tensor(size)) * F_n;
    typename Law::History first, second;
    SymmetricTensor<2, 3> tau;
    if (!update(law, F_n, {}, first, tau) || !update(law, F, first, second, tau))
      continue; // turned by nearly π
    GradientModuli A;
    law.update(F, 1., first, second, tau, &A);
    for (unsigned int i = 0; i < 50; ++i) { // with changes of volume alone as the first
      const Tensor<2, 3> L = i == 0 ? unit : random.tensor(1.);
      double work = A.volumetric * trace(L) * trace(L) -
                    scalar_product(static_cast<Tensor<2, 3>>(tau) * transpose(L), L);
      for (unsigned int row = 0; row < 9; ++row)
        for (unsigned int column = 0; column < 9; ++column)
          work += L[row / 3][row % 3] *
                  A[SymmetricTensor<2, 3>::component_to_unrolled_index({row / 3, row % 3})][column] *
                  L[column / 3][column % 3];
      stiffness.add(work / L.norm_square() / bound_by_moduli(A, tau));
    }
    double scale = 0., skew = 0.;
    for (unsigned int i = 0; i < 6; ++i)
      for (unsigned int j = 0; j < 9; ++j)
        scale = std::max(scale, std::abs(A[i][j]));
    for (unsigned int i = 0; i < 3; ++i) // of the normal components
      for (unsigned int j = 0; j < 3; ++j)
        skew = std::max(skew, std::abs(A[i][std::size_t{4} * j] - A[j][std::size_t{4} * i]) / scale);
    max_asymmetry = std::max(max_asymmetry, skew);
    for (unsigned int j = 0; j < 9; ++j) {
      Tensor<2, 3> L;
      L[j / 3][j % 3] = 1.;
      const SymmetricTensor<2, 3> difference = central_difference(
          [&](const double e) {
            typename Law::History ignored;
            SymmetricTensor<2, 3> moved;
            law.update((unit + e * L) * F, 1., first, ignored, moved, nullptr);
            return moved;
          },
          1e-5);
      for (unsigned int i = 0; i < 6; ++i)
        error.add(std::abs(A[i][j] - difference.access_raw_entry(i)) / scale);
    }
  }
  check(name + ", differences", error.value(), 1e-8);
  check(name + ", not symmetric", max_asymmetry > 1e-6);
  check(name + ", stiffness is below the bound of the moduli", stiffness.value(), 1.);
  check(name + ", and above a quarter of it", stiffness.value() > 0.25);
}

BILLET_TEST(hypoelastic) {
  test_simple_shear();
  test_stretch();
  const HypoelasticElasticity elastic(steel);
  test_rotations("elastic", elastic);
  test_moduli("elastic", elastic, 0.1);
  for_each_hardening([](const std::string &name, const auto &hardening) {
    const HypoelasticPlasticity law(steel, make_hardening(hardening));
    test_rotations(name, law);
    test_moduli(name, law, 0.1);
  });
}

} // namespace hypoelastic_test
