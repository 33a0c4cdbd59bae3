// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/hypoelastic.h"

#include <cmath>

namespace billet {

using dealii::SymmetricTensor;
using dealii::Tensor;

bool compute_increment(const Tensor<2, 3> &F_n, const Tensor<2, 3> &F, MidpointIncrement &increment) {
  const Tensor<2, 3> middle = 0.5 * (F_n + F);
  const double det = dealii::determinant(middle);
  if (!(det > 0.) || !std::isfinite(det))
    return false;
  increment.gradient = (F - F_n) * dealii::invert(middle);
  const Tensor<2, 3> &L = increment.gradient;
  Tensor<1, 3> &w = increment.spin;
  for (unsigned int i = 0; i < 3; ++i)
    w[i] = 0.5 * (L[(i + 2) % 3][(i + 1) % 3] - L[(i + 1) % 3][(i + 2) % 3]);
  // R = 1 + (W + W²/2)/(1 + w²/4), W² = w⊗w − w² 1
  const double w2 = w * w, a = 1. / (1. + 0.25 * w2);
  for (unsigned int i = 0; i < 3; ++i) {
    for (unsigned int j = 0; j < 3; ++j)
      increment.rotation[i][j] = 0.5 * a * w[i] * w[j];
    increment.rotation[i][i] += 1. - 0.5 * a * w2;
  }
  for (unsigned int i = 0; i < 3; ++i) {
    increment.rotation[(i + 2) % 3][(i + 1) % 3] += a * w[i];
    increment.rotation[(i + 1) % 3][(i + 2) % 3] -= a * w[i];
  }
  return std::isfinite(increment.rotation.norm());
}

SymmetricTensor<2, 3> turn(const Tensor<2, 3> &R, const SymmetricTensor<2, 3> &s) {
  return dealii::symmetrize(R * static_cast<Tensor<2, 3>>(s) * dealii::transpose(R));
}

SymmetricTensor<2, 3> compute_trial_deviator(const MidpointIncrement &increment, const double shear,
                                             const SymmetricTensor<2, 3> &deviator_n) {
  return turn(increment.rotation, deviator_n) +
         2. * shear * dealii::deviator(dealii::symmetrize(increment.gradient));
}

GradientModuli compute_trial_moduli(const MidpointIncrement &increment, const double shear,
                                    const SymmetricTensor<2, 3> &deviator_n) {
  constexpr unsigned int rows[6] = {0, 1, 2, 0, 0, 1}, columns[6] = {0, 1, 2, 1, 2, 2};
  const SymmetricTensor<2, 3> s = turn(increment.rotation, deviator_n);
  const Tensor<1, 3> &w = increment.spin;
  const double a = 1. / (1. + 0.25 * (w * w));
  Tensor<2, 3> left = -0.5 * increment.gradient, right = 0.5 * increment.gradient;
  for (unsigned int i = 0; i < 3; ++i) {
    left[i][i] += 1.;
    right[i][i] += 1.;
  }
  GradientModuli moduli;
  for (unsigned int j = 0; j < 3; ++j)
    for (unsigned int k = 0; k < 3; ++k) {
      Tensor<2, 3> D; // ΔL' for L = e_j ⊗ e_k
      for (unsigned int p = 0; p < 3; ++p)
        for (unsigned int r = 0; r < 3; ++r)
          D[p][r] = left[p][j] * right[k][r];
      Tensor<1, 3> spin;
      for (unsigned int i = 0; i < 3; ++i)
        spin[i] = 0.5 * (D[(i + 2) % 3][(i + 1) % 3] - D[(i + 1) % 3][(i + 2) % 3]);
      spin = a * (spin + 0.5 * dealii::cross_product_3d(w, spin));
      Tensor<2, 3> turned; // spin × s; the rotation adds twice its symmetric part
      for (unsigned int c = 0; c < 3; ++c)
        for (unsigned int i = 0; i < 3; ++i)
          turned[i][c] = spin[(i + 1) % 3] * s[(i + 2) % 3][c] - spin[(i + 2) % 3] * s[(i + 1) % 3][c];
      const double mean = (D[0][0] + D[1][1] + D[2][2]) / 3.;
      for (unsigned int i = 0; i < 6; ++i) {
        const unsigned int p = rows[i], r = columns[i];
        moduli[i][3 * j + k] =
            turned[p][r] + turned[r][p] + shear * (D[p][r] + D[r][p] - (i < 3 ? 2. * mean : 0.));
      }
    }
  return moduli;
}

bool HypoelasticPlasticity::update(const dealii::Tensor<2, 3> &F, const double J, const History &history_n,
                                   History &history, dealii::SymmetricTensor<2, 3> &tau,
                                   GradientModuli *moduli, const PointStep &step) const {
  if (!elastic_law_.update(F, J, history_n, history, tau, moduli))
    return false;
  const double alpha_n = history_n.equivalent_plastic_strain;
  history.equivalent_plastic_strain = alpha_n;
  history.flow = history_n.flow;
  const dealii::SymmetricTensor<2, 3> s = history.deviator;
  const double q =
      std::sqrt(1.5 * (s * s) + (step.shared != nullptr ? 6. * elastic_.shear * step.shared->energy : 0.));
  const double yield_stress = flow_->stress(alpha_n);
  if (q > yield_stress * (1. + step.yield_slack)) {
    const double three_g = 3. * elastic_.shear;
    const PlasticIncrement increment = flow_->solve(q, three_g, alpha_n, step.dt);
    const double delta_alpha = increment.strain;
    const double reduction = three_g * delta_alpha / q, beta = 1. - reduction;
    history.equivalent_plastic_strain += delta_alpha;
    flow_->advance(alpha_n, delta_alpha, step.dt, history_n.flow, history.flow);
    history.deviator = beta * s;
    tau -= reduction * s;
    const double k = increment.slope / (three_g + increment.slope);
    if (step.shared != nullptr) {
      step.shared->share = beta;
      step.shared->slope = three_g * (k - beta) / (q * q);
    }
    if (moduli != nullptr) {
      const double factor = 1.5 * (k - beta) / (q * q);
      for (unsigned int j = 0; j < 9; ++j) {
        double projection = 0.; // s : A
        for (unsigned int i = 0; i < 6; ++i)
          projection += (i < 3 ? 1. : 2.) * s.access_raw_entry(i) * (*moduli)[i][j];
        if (step.shared != nullptr)
          step.shared->rate[j / 3][j % 3] = factor * projection;
        for (unsigned int i = 0; i < 6; ++i)
          (*moduli)[i][j] = beta * (*moduli)[i][j] + factor * projection * s.access_raw_entry(i);
      }
    }
  }
  return true;
}

} // namespace billet
