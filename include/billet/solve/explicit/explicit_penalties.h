// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_EXPLICIT_EXPLICIT_PENALTIES_H
#define BILLET_SOLVE_EXPLICIT_EXPLICIT_PENALTIES_H

#include "billet/solve/explicit/explicit_parts.h"
#include "billet/solve/penalty_control.h"
#include "billet/solve/penalty_watch.h"

namespace billet {

/// Penalties of explicit scenes: raises automatic ones, and warns of those that are too low.
class ExplicitPenalties {
public:
  /// Collective.
  explicit ExplicitPenalties(ExplicitParts &parts);

  /// Whether there is a pair with an automatic penalty.
  bool are_controlled() const { return control_.is_used(); }
  /// Raises penalties if penetration is too large a part of the deformation. `solution` has the
  /// energies of this time. Energy that the raise adds to springs is added to `external_work`.
  /// Collective.
  void raise(const Solution &solution, double &external_work);
  /// Returns messages about penalties, at the last forces. Collective.
  DiagnosticList check(const EnergyLedger &energies);
  /// Whether check() has ever found a penalty too low.
  bool has_low_penalties() const { return watch_.has_low_penalties(); }

  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

private:
  ExplicitParts &parts_;
  PenaltyControl control_;
  PenaltyWatch watch_{PenaltyWatch::Motion::sudden};
};

} // namespace billet

#endif
