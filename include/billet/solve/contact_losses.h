// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_CONTACT_LOSSES_H
#define BILLET_SOLVE_CONTACT_LOSSES_H

#include "billet/diagnostics.h"

#include <array>
#include <vector>

namespace billet {

/// Energy that contact has removed from a scene of implicit dynamics beside friction, by cause.
class ContactLosses {
public:
  enum Cause {
    /// Steps damped by (I4): springs that close, open or change their length within a step.
    impacts,
    friction, ///< the tangential springs in such steps, (E4) with θ = 0
    /// Undamped steps: nodes that enter or leave within a step, areas and facets that change.
    crossings,
    n_causes
  };

  void add(const Cause cause, const double energy) { energies_[cause] += energy; }
  /// Subtracts up to this energy from the losses by crossings, then from those by impacts. Returns
  /// the energy that was subtracted.
  double give_back(double energy);
  double of(const Cause cause) const { return energies_[cause]; }
  double total() const;

  /// Returns a warning if the total exceeds a twentieth of the largest energy, and again whenever
  /// its part has doubled.
  DiagnosticList watch(double max_energy, double time);

  std::vector<double> save() const;
  void load(const std::vector<double> &numbers);

private:
  std::array<double, n_causes> energies_{};
  double reported_ = 0.; ///< part of the largest energy
};

} // namespace billet

#endif
