// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_ENERGY_WATCH_H
#define BILLET_OUTPUT_ENERGY_WATCH_H

#include "billet/solve/solution.h"

#include <functional>
#include <string>

namespace billet {

/// Looks at the energies of accepted steps, and says once what makes them doubtful, and what to do: energies
/// of implicit dynamics that fail to balance (explicit runs look at them themselves). The energy of the
/// one-point elements' stabilisation is that of bending: whether it is right, ElementWatch finds.
class EnergyWatch {
public:
  /// What becomes of energies that fail to balance: nothing, a word, or the end of the run.
  enum class Balance { is_left, is_told, is_kept };
  /// Of the largest energy, where the scene allows no part of its own.
  static constexpr double doubtful_drift = 0.05;

  /// Why energies may fail to balance: what can be done differs.
  enum class Cause { steps, soft_penalties, sticking_overlaps, unstable_law, inexact_dissipation };
  /// In words, and what to do.
  static std::string advise(Cause cause);

  explicit EnergyWatch(const Balance balance, const double allowed_drift = doubtful_drift)
      : balance_(balance), allowed_drift_(allowed_drift) {}

  /// A message for the console, empty if there is nothing to tell. `find_cause` is asked for the likely one
  /// where energies fail to balance, on all ranks.
  std::string look(
      double time, const EnergyLedger &energies,
      const std::function<Cause()> &find_cause = [] { return Cause::steps; });
  /// Why the run has to end after the last look(); empty if it may go on.
  const std::string &imbalance() const { return imbalance_; }

private:
  Balance balance_;
  double allowed_drift_;
  double largest_ = 0.;
  bool told_balance_ = false;
  std::string imbalance_;
};

} // namespace billet

#endif
