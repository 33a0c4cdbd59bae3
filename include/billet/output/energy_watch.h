// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_ENERGY_WATCH_H
#define BILLET_OUTPUT_ENERGY_WATCH_H

#include "billet/diagnostics.h"
#include "billet/solve/solution.h"

#include <functional>
#include <optional>
#include <string>

namespace billet {

/// Checks the energy balance of accepted steps in implicit dynamics; explicit runs have a check of
/// their own. The stabilisation energy of one-point elements is that of bending: ElementWatch
/// checks it.
class EnergyWatch {
public:
  /// Reaction to an energy imbalance: none, a warning, or the end of the run.
  enum class Balance { is_left, is_reported, is_kept };
  /// Default of the allowed drift, relative to the maximum energy.
  static constexpr double doubtful_drift = 0.05;

  /// Causes of an energy imbalance, with different remedies.
  enum class Cause {
    steps,
    low_penalties,
    sticking_overlaps,
    contact_edges,
    unstable_law,
    inexact_dissipation,
    softening
  };
  /// Returns a description of the cause and its remedy, as sentences without the last full stop.
  static std::string advise(Cause cause);

  explicit EnergyWatch(const Balance balance, const double allowed_drift = doubtful_drift)
      : balance_(balance), allowed_drift_(allowed_drift) {}

  /// Returns messages about the energies at this time. In an imbalance, calls `find_cause` on all
  /// ranks for the likely cause.
  DiagnosticList check(
      double time, const EnergyLedger &energies,
      const std::function<Cause()> &find_cause = [] { return Cause::steps; });
  /// Explains why the run has to end after the last check(); empty if it may continue.
  const Explanation &imbalance() const { return imbalance_; }

private:
  Balance balance_;
  double allowed_drift_;
  double maximum_ = 0.;
  Explanation imbalance_;
  std::optional<Cause> cause_; ///< cause of the first imbalance
};

} // namespace billet

#endif
