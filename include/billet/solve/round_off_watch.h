// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_ROUND_OFF_WATCH_H
#define BILLET_SOLVE_ROUND_OFF_WATCH_H

#include "billet/diagnostics.h"

#include <vector>

namespace billet {

/// Part of the forces that round-off may reach without a warning, whatever tolerance the scene
/// sets.
constexpr double notable_round_off = 1e-8;

/// Compares the round-off of contact forces by positions with the largest forces of the run. At
/// first contact the forces are small, and their round-off is irrelevant.
class RoundOffWatch {
public:
  /// Adds an accepted step; both are in the same unit of force. `round_off`: 0 if contact bears no
  /// force.
  void add(double time, double round_off, double forces);
  /// Returns a message at the end of the run. `tolerance`: 'Force tolerance'. `accepts_all`:
  /// whether steps may converge at any round-off, as in dynamics, where inertia balances the
  /// residual.
  DiagnosticList finish(double tolerance, bool accepts_all) const;

  std::vector<double> save() const { return {time_, round_off_, forces_}; }
  void load(const std::vector<double> &numbers);

private:
  double time_ = 0.;                    ///< of the largest round-off
  double round_off_ = 0., forces_ = 0.; ///< largest of the run
};

} // namespace billet

#endif
