// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_MATERIAL_RUBBER_LAWS_H
#define BILLET_TESTS_MATERIAL_RUBBER_LAWS_H

#include "moduli.h"
#include "texts.h"

#include "billet/material/viscoelastic.h"

#include <functional>
#include <utility>
#include <vector>

/// Laws of rubber, and what a test does with a law at a point.
namespace billet::testing {

/// Ogden's fit of Treloar's data (Ogden 1972), N/mm²; the same constants in the manuals of ANSYS (VM234).
inline const std::vector<double> ogden_moduli = {0.63, 0.0012, -0.01}, ogden_exponents = {1.3, 5., -2.};
inline const std::vector<double> yeoh_constants = {0.184343, -0.0021273, 4.95955e-5};
constexpr double mooney_10 = 0.293, mooney_01 = 0.177;

inline SharedEnergy mooney_energy() {
  return make_ogden_energy({2. * mooney_10, -2. * mooney_01}, {2., -2.});
}

using NamedEnergy = std::pair<std::string, SharedEnergy>;
inline std::vector<NamedEnergy> rubber_energies() {
  return {{"Mooney-Rivlin", mooney_energy()},
          {"Yeoh", make_invariant_energy(yeoh_constants)},
          {"Ogden", make_ogden_energy(ogden_moduli, ogden_exponents)},
          {"Ogden, one term of a half", make_ogden_energy({2.}, {0.5})},
          {"Hencky", make_hencky_energy(0.4)}};
}

/// Ogden's volumetric law has its default exponent.
inline VolumetricEnergy volume(const std::string &name, const double bulk = 20.) {
  return {volumetric_law_types().find(name)->make(Texts("Volumetric exponent", "9")), bulk};
}
inline const std::string logarithmic = "logarithmic";

/// A point of a law, its state and its stress.
class Point {
public:
  explicit Point(const SpatialLaw &law) : law_(law), state_n_(law.n_state()), state_(law.n_state()) {
    law.initialize(state_n_.data());
    state_ = state_n_;
  }

  SymmetricTensor<2, 3> evaluate(const Tensor<2, 3> &F, const double dt, SpatialModuli *moduli = nullptr) {
    PointStep step;
    step.dt = dt;
    SymmetricTensor<2, 3> tau;
    AssertThrow(law_.update(F, determinant(F), step, state_n_.data(), state_.data(), tau, moduli),
                dealii::ExcInternalError());
    return tau;
  }
  SymmetricTensor<2, 3> step(const Tensor<2, 3> &F, const double dt) {
    const auto tau = evaluate(F, dt);
    state_n_ = state_;
    return tau;
  }
  double stored(const Tensor<2, 3> &F) const { return law_.stored_energy(F, determinant(F), state_.data()); }
  double dissipated() const { return law_.dissipated_energy(state_.data()); }
  std::vector<double> &state() { return state_n_; }

private:
  const SpatialLaw &law_;
  std::vector<double> state_n_, state_;
};

/// Largest error of the moduli at F over those of nine directions, over their norm.
inline double moduli_error(Point &point, const Tensor<2, 3> &F, const double dt) {
  SpatialModuli c;
  const SymmetricTensor<2, 3> tau = point.evaluate(F, dt, &c);
  WorstError error;
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j) {
      Tensor<2, 3> L;
      L[i][j] += 1.;
      L[j][i] += i <= j ? 1. : -1.;
      const SymmetricTensor<2, 3> difference =
          central_difference([&](const double e) { return point.evaluate((unit + e * L) * F, dt); }, 2e-4);
      error.add((predict(c, tau, L) - static_cast<Tensor<2, 3>>(difference)).norm() / norm(c));
    }
  error.add(asymmetry(c) * 1e6);
  return error.value();
}

/// F with these logarithmic strains in random directions.
inline Tensor<2, 3> strained(Random &random, const Tensor<1, 3> &log_strains) {
  const Tensor<2, 3> Q = random.rotation(), R = random.rotation();
  Tensor<2, 3> V;
  for (unsigned int i = 0; i < 3; ++i)
    V[i][i] = std::exp(log_strains[i]);
  return Q * V * transpose(Q) * R;
}

/// States with distinct, nearly equal and equal stretches.
inline std::vector<Tensor<2, 3>> sampled_gradients() {
  Random random;
  std::vector<Tensor<2, 3>> result;
  const Tensor<1, 3> apart({0., 0.5, -0.5});
  for (const double size : {1e-3, 0.3, 1.2, -0.6}) {
    for (const double factor : {0., 1e-12, 1e-8, 1e-4, 0.03})
      result.push_back(strained(random, two_equal(size) + factor * apart));
    result.push_back(strained(random, distinct(size)));
  }
  for (const double mean : {-0.1, 0., 0.1})
    for (const double factor : {0., 1e-12, 1e-8, 1e-4})
      result.push_back(strained(random, Tensor<1, 3>({mean, mean + factor, mean - 2. * factor})));
  return result;
}

} // namespace billet::testing

#endif
