// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_LAW_POINT_H
#define BILLET_MATERIAL_LAW_POINT_H

#include "billet/material/point_law.h"

#include <array>
#include <optional>
#include <vector>

namespace billet {

/// Derivatives of all of the Kirchhoff stress by the velocity gradient: rows are 11, 22, 33, 12,
/// 13, 23, columns L11, L12, L13, L21, ... L33 [stress].
using StressRates = std::array<std::array<double, 9>, 6>;

/// Point of any law that is driven through deformation gradients, for checks of laws.
class LawPoint {
public:
  /// `centre`: for laws whose material axes depend on it.
  explicit LawPoint(const PointLaw &law, double temperature = 0., const dealii::Tensor<1, 3> &centre = {});

  /// Returns the Kirchhoff stress at F, at the end of a step of length dt from the committed state;
  /// nothing if the law refuses. Overwrites `rates`, unless it is null, with what the law's moduli
  /// promise.
  std::optional<dealii::SymmetricTensor<2, 3>> evaluate(const dealii::Tensor<2, 3> &F, double dt,
                                                        StressRates *rates = nullptr);
  /// Returns central differences of the stress at F, with relative changes of F of `h`. Returns
  /// nothing if the law refuses, or at a kink: one-sided differences disagree by more than `kink`
  /// of the norm. The state of the last evaluation remains.
  std::optional<StressRates> differentiate(const dealii::Tensor<2, 3> &F, double dt, double h, double kink);

  /// Makes the state of the last evaluation the start of the next step.
  void commit() { state_n_ = state_; }

  const PointLaw &law() const { return law_; }
  /// State at the start of the step.
  std::vector<double> &state_n() { return state_n_; }
  /// State of the last evaluation.
  const std::vector<double> &state() const { return state_; }
  double stored_energy(const dealii::Tensor<2, 3> &F) const {
    return law_.stored_energy(F, dealii::determinant(F), state_.data());
  }
  double dissipated_energy() const { return law_.dissipated_energy(state_.data()); }

private:
  const PointLaw &law_;
  double temperature_;
  std::vector<double> state_n_, state_;
};

/// Returns the norm of the difference of `a` and `b` over that of `b`; for symmetric velocity
/// gradients alone if `is_symmetric`. The deviators of the stress by isochoric velocity gradients
/// count by their own norm, so that a large bulk modulus hides no error of theirs. The result is
/// the larger of both.
double relative_difference(const StressRates &a, const StressRates &b, bool is_symmetric);

/// Largest difference between the moduli of a law and differences of its stress.
struct TangentError {
  double error = 0.;     ///< relative to the norm of the derivatives
  double strain = 0.;    ///< at this strain
  double asymmetry = 0.; ///< largest UserSubroutine::lost_asymmetry()
};

/// Pulls points of the law along straight paths up to a strain of 1 %, in steps of length dt.
/// Compares the moduli at the ends of the steps for symmetric velocity gradients. It takes a few
/// hundred updates.
TangentError find_tangent_error(const PointLaw &law, double dt, double temperature);

} // namespace billet

#endif
