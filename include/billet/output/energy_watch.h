// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_ENERGY_WATCH_H
#define BILLET_OUTPUT_ENERGY_WATCH_H

#include "billet/solve/solution.h"

#include <string>

namespace billet {

/// Looks at the energies of accepted steps, and says once each what makes them doubtful, and what to do:
/// energies of implicit dynamics that fail to balance (explicit runs end there), hourglass energy of
/// one-point elements.
class EnergyWatch {
public:
  enum class Balance { is_told, is_left }; ///< whether to look at the balance at all

  explicit EnergyWatch(Balance balance) : balance_(balance) {}

  /// A message for the console, empty if there is nothing to tell.
  std::string look(double time, const EnergyLedger &energies);

private:
  Balance balance_;
  double largest_ = 0.;
  bool told_balance_ = false, told_hourglass_ = false;
};

} // namespace billet

#endif
