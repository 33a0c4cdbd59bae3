// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_ENERGY_WATCH_H
#define BILLET_OUTPUT_ENERGY_WATCH_H

#include "billet/diagnostics.h"
#include "billet/solve/solution.h"

#include <functional>
#include <optional>
#include <string>

namespace billet {

/// Checks whether the energies of accepted steps balance in implicit dynamics (explicit runs check that
/// themselves). The energy of the one-point elements' stabilisation is that of bending: ElementWatch judges
/// it.
class EnergyWatch {
public:
  /// What becomes of energies that fail to balance: nothing, a word, or the end of the run.
  enum class Balance { is_left, is_told, is_kept };
  /// Of the largest energy, where the scene allows no part of its own.
  static constexpr double doubtful_drift = 0.05;

  /// Why energies may fail to balance: what can be done differs.
  enum class Cause {
    steps,
    soft_penalties,
    sticking_overlaps,
    contact_edges,
    unstable_law,
    inexact_dissipation
  };
  /// In words, and what to do.
  static std::string advise(Cause cause);

  explicit EnergyWatch(const Balance balance, const double allowed_drift = doubtful_drift)
      : balance_(balance), allowed_drift_(allowed_drift) {}

  /// Messages about the energies at this time. `find_cause` is asked for the likely one where energies fail
  /// to balance, on all ranks.
  DiagnosticList check(
      double time, const EnergyLedger &energies,
      const std::function<Cause()> &find_cause = [] { return Cause::steps; });
  /// Why the run has to end after the last check(); empty if it may go on.
  const std::string &imbalance() const { return imbalance_; }

private:
  Balance balance_;
  double allowed_drift_;
  double largest_ = 0.;
  std::string imbalance_;
  std::optional<Cause> cause_; ///< of the first imbalance
};

} // namespace billet

#endif
