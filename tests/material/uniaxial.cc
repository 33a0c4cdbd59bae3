// SPDX-License-Identifier: LGPL-2.1-or-later
// Uniaxial stress at large strain against the closed form. Principal axes stay, so the law integrates exactly
// in logarithmic strain and the result may not depend on the number of steps.

#include "../sample_laws.h"
#include "../testing.h"

#include "billet/material/elastic.h"

namespace uniaxial_test {

using namespace billet;
using namespace billet::testing;
using dealii::Tensor;

/// The exact answer to monotone pieces of axial log strain e: τ = E (e − e_p), |τ| ≤ σ_y(α), lateral log
/// strain −ν τ/E − e_p/2 (plastic flow keeps the volume).
struct UniaxialSolution {
  double plastic_strain = 0., alpha = 0., stress = 0., lateral_strain = 0.;

  template <class YieldStress> void advance(const double e, const YieldStress &yield_stress) {
    const double trial = young * (e - plastic_strain);
    const double delta = exact_plastic_strain(yield_stress, std::abs(trial), young, alpha);
    alpha += delta;
    plastic_strain += std::copysign(delta, trial);
    stress = young * (e - plastic_strain);
    lateral_strain = -poisson * stress / young - 0.5 * plastic_strain;
  }
};

/// A bar along the first axis of `frame`, driven by the axial log strain; its lateral strain is found by
/// Newton on the law's own stress and moduli.
template <class Law> class Bar {
public:
  Bar(const Law &law, const Tensor<2, 3> &frame) : law_(law), frame_(frame) {}

  void stretch_to(const double e) {
    typename Law::History history;
    dealii::SymmetricTensor<2, 3> tau;
    SpatialModuli moduli;
    for (unsigned int i = 0; i < 50; ++i) {
      Tensor<2, 3> U;
      U[0][0] = std::exp(e);
      U[1][1] = U[2][2] = std::exp(lateral_strain);
      // In the bar's frame: the frame goes with the history, F = Q U Qᵀ.
      if (!law_.update(frame_ * U * transpose(frame_), history_, history, tau, &moduli))
        break;
      const Tensor<2, 3> local = transpose(frame_) * static_cast<Tensor<2, 3>>(tau) * frame_;
      stress = local[0][0];
      const double residual = 0.5 * (local[1][1] + local[2][2]);
      lateral_difference = std::abs(local[1][1] - local[2][2]);
      // τ̇ = c : d + L τ + τ Lᵀ for L = d = P = n2⊗n2 + n3⊗n3, and its lateral part ½ P : τ̇.
      const Tensor<2, 3> P = frame_ * lateral_projector() * transpose(frame_);
      const double derivative = 0.5 * quadratic_form(moduli, P) + 2. * residual;
      const double change = -residual / derivative;
      lateral_strain += change;
      if (std::abs(change) < 1e-15)
        break;
    }
    history_ = history;
  }

  double equivalent_plastic_strain() const { return law_.equivalent_plastic_strain(history_); }

  double stress = 0., lateral_strain = 0., lateral_difference = 0.;

private:
  static Tensor<2, 3> lateral_projector() {
    Tensor<2, 3> P;
    P[1][1] = P[2][2] = 1.;
    return P;
  }
  static double quadratic_form(const SpatialModuli &c, const Tensor<2, 3> &d) {
    const std::array<double, 6> v = {d[0][0], d[1][1], d[2][2], 2. * d[0][1], 2. * d[0][2], 2. * d[1][2]};
    double sum = 0.;
    for (unsigned int i = 0; i < 6; ++i)
      for (unsigned int j = 0; j < 6; ++j)
        sum += v[i] * c[i][j] * v[j];
    return sum;
  }

  const Law &law_;
  Tensor<2, 3> frame_;
  typename Law::History history_;
};

/// Visits `turns` in order, each in n_steps equal steps, and compares at every step. Errors are relative to
/// the values at the first turn, since a path may cross zero.
template <class Law, class YieldStress>
void test_path(const std::string &name, const Law &law, const YieldStress &yield_stress,
               const std::vector<double> &turns, const unsigned int n_steps) {
  Random random;
  WorstError error;
  for (const Tensor<2, 3> &frame : {Tensor<2, 3>(dealii::unit_symmetric_tensor<3>()), random.rotation()}) {
    Bar<Law> bar(law, frame);
    UniaxialSolution exact, turn;
    turn.advance(turns[0], yield_stress);
    double from = 0.;
    for (const double to : turns) {
      for (unsigned int step = 1; step <= n_steps; ++step) {
        const double e = from + (to - from) * step / n_steps;
        bar.stretch_to(e);
        exact.advance(e, yield_stress);
        error.add(std::abs(bar.stress - exact.stress) / std::abs(turn.stress));
        error.add(std::abs(bar.lateral_strain - exact.lateral_strain) / std::abs(turn.lateral_strain));
        error.add(bar.lateral_difference / std::abs(turn.stress));
        error.add(std::abs(bar.equivalent_plastic_strain() - exact.alpha) / (exact.alpha + 1e-300));
      }
      from = to;
    }
  }
  check(name, error.value(), 1e-10);
}

BILLET_TEST(uniaxial) {
  const auto never = [](const double) { return 1e300; };
  const HenckyElasticity elastic(steel);
  for (const unsigned int n_steps : {1, 5, 100}) {
    const std::string steps = ", " + std::to_string(n_steps) + (n_steps == 1 ? " step" : " steps");
    test_path("elastic, to log strain 1" + steps, elastic, never, {1.}, n_steps);
    test_path("elastic, to log strain -1" + steps, elastic, never, {-1.}, n_steps);
    for_each_hardening([&](const std::string &name, const auto &hardening) {
      const HenckyPlasticity law(steel, make_hardening(hardening));
      const auto yield_stress = [&](const double alpha) { return hardening.stress(alpha); };
      test_path(name + ", elastic range" + steps, law, yield_stress, {2e-4, -1e-4, 3e-4}, n_steps);
      test_path(name + ", to log strain 1" + steps, law, yield_stress, {1.}, n_steps);
      test_path(name + ", to log strain -1" + steps, law, yield_stress, {-1.}, n_steps);
      test_path(name + ", loading, unloading, reverse loading" + steps, law, yield_stress,
                {0.4, 0.399, -0.3, -0.299, 0.1}, n_steps);
    });
  }
}

} // namespace uniaxial_test
