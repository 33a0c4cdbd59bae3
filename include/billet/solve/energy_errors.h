// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_ENERGY_ERRORS_H
#define BILLET_SOLVE_ENERGY_ERRORS_H

#include "billet/solve/solution.h"
#include "billet/state.h"
#include "billet/usage.h"

#include <array>

namespace billet {

/// What a run of explicit or implicit dynamics believes its energies to be off, ∫|E − E*| dt over ∫Σ E* dt:
/// by steps, from the drift of the energies and what the integration dissipates, and by penalties, from what
/// their springs hold. Steps get shorter while the first is more than its part of the tolerance, and grows.
///
/// Energies are those without `carried`, of a motion that all share and nothing holds: an observer who moves
/// along would not see it, nor is it at stake.
///
/// A node that is g deep in is late by g/v, v its velocity: kinetic energy, which falls by F v in a unit of
/// time, is off by F g = 2 E_c, and the springs hold E_c themselves.
class EnergyErrors {
public:
  /// `tolerance`: part of the energies.
  explicit EnergyErrors(const double tolerance) : tolerance_(tolerance) { memory_.set(sizeof(*this)); }

  /// Begins at this time.
  void begin(const double time) { start_ = time; }
  double start() const { return start_; }
  /// Whether there has been energy that errors can be parts of.
  bool has_energies() const { return total_ > 0.; }

  /// The energies at a later time than the last ones; of them `carried`, see carried_energy().
  void add(double time, const EnergyLedger &energies, double carried);
  /// What the step's length should be multiplied by from now on, from 0.5 to 1.
  double step_factor() const { return step_factor_; }

  double steps() const { return total_ > 0. ? drift_ / total_ : 0.; }
  double penetration() const { return total_ > 0. ? penetration_ / total_ : 0.; }

  void save(StateWriter &writer) const;
  void load(const StateReader &reader);

private:
  double tolerance_;
  bool has_begun_ = false;
  double start_ = 0., time_ = 0., last_drift_ = 0., last_contact_ = 0., last_total_ = 0.;
  double drift_ = 0., penetration_ = 0., total_ = 0.; ///< integrals
  double step_factor_ = 1.;
  HeldMemory memory_{Capability::error_control};
};

/// ½ Σ p_i²/m over the directions that are free: the kinetic energy of a motion that all bodies share. The
/// momentum and the mass of all of them; see Scene::free_directions().
double carried_energy(const std::array<bool, 3> &free_directions, const dealii::Tensor<1, 3> &momentum,
                      double mass);

} // namespace billet

#endif
