// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_ENERGY_ERRORS_H
#define BILLET_SOLVE_ENERGY_ERRORS_H

#include "billet/solve/solution.h"
#include "billet/state.h"
#include "billet/usage.h"

#include <array>

namespace billet {

/// Error estimate for the energies of explicit or implicit dynamics, ∫|E − E*| dt over ∫Σ E* dt.
/// Errors by steps follow from the drift of the energies and the dissipation of the integration.
/// Errors by penalties follow from the energy in their springs. Steps become shorter while the
/// errors by steps exceed their part of the tolerance and grow.
///
/// Energies exclude `carried`, the energy of a common motion that nothing constrains: it depends on
/// the observer, and no error affects it.
///
/// A node with penetration g is late by g/v, v its velocity. The kinetic energy, which falls by F v
/// in a unit of time, is off by F g = 2 E_c, and the springs store E_c themselves.
class EnergyErrors {
public:
  /// `tolerance`: part of the energies.
  explicit EnergyErrors(const double tolerance) : tolerance_(tolerance) { memory_.set(sizeof(*this)); }

  /// Begins at this time.
  void begin(const double time) { start_ = time; }
  double start() const { return start_; }
  /// Whether there has been any energy to normalise errors by.
  bool has_energies() const { return total_ > 0.; }

  /// Adds the energies at a later time than the last ones. `carried`: their part of
  /// carried_energy().
  void add(double time, const EnergyLedger &energies, double carried);
  /// Returns the factor for all further step lengths, from 0.5 to 1.
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

/// Returns ½ Σ p_i²/m over the free directions: the kinetic energy of a motion that all bodies
/// share. `momentum` and `mass` are those of all bodies; see Scene::free_directions().
double carried_energy(const std::array<bool, 3> &free_directions, const dealii::Tensor<1, 3> &momentum,
                      double mass);

} // namespace billet

#endif
