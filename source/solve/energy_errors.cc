// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/energy_errors.h"
#include "billet/usage.h"

#include <algorithm>
#include <cmath>

namespace billet {

namespace {

/// Constants of error control by energies; factors unless they say otherwise. See "Dynamics" under
/// "Target error" in doc/theory.md.
struct EnergyErrorFactors {
  /// Part of all energy below which energies that are not carried count as zero.
  static constexpr double rounding = 1e-9;
  /// Error by penetration over the energy E_c in springs: 2 E_c by the delay, and E_c that they
  /// store.
  static constexpr double late_and_stored = 3.;
  /// Waves carry the delay on after the springs have unloaded: measurements on tubes and bars show
  /// the same amount again.
  static constexpr double carried_on = 2.;
  /// Part of the tolerance above which drift by steps shortens them, ...
  static constexpr double matters = 0.2;
  /// ... if it grows by this factor since the last energies. Drift by first contact stays constant.
  static constexpr double growth = 1.1;
  /// Factor of steps each time, and its lower limit for all times together.
  static constexpr double shorter = 0.8, min_step = 0.5;
};

} // namespace

void EnergyErrors::add(const double time, const EnergyLedger &energies, const double carried) {
  Usage::count(Capability::error_control, 1);
  const double whole = std::max(energies.total(), std::abs(energies.initial)), at_stake = whole - carried;
  const bool is_something = at_stake > EnergyErrorFactors::rounding * whole;
  const double drift = is_something ? std::abs(energies.drift()) + std::abs(energies.numerical) : 0.,
               contact = is_something ? std::abs(energies.contact) : 0., total = is_something ? at_stake : 0.;
  if (has_begun_) {
    const double half = 0.5 * (time - time_);
    drift_ += half * (last_drift_ + drift);
    penetration_ += half * EnergyErrorFactors::carried_on * EnergyErrorFactors::late_and_stored *
                    (last_contact_ + contact);
    total_ += half * (last_total_ + total);
  }
  if (has_begun_ && total > 0. && drift > EnergyErrorFactors::matters * tolerance_ * total &&
      drift > EnergyErrorFactors::growth * last_drift_)
    step_factor_ = std::max(EnergyErrorFactors::min_step, EnergyErrorFactors::shorter * step_factor_);
  has_begun_ = true;
  time_ = time;
  last_drift_ = drift;
  last_contact_ = contact;
  last_total_ = total;
}

double carried_energy(const std::array<bool, 3> &free_directions, const dealii::Tensor<1, 3> &momentum,
                      const double mass) {
  double energy = 0.;
  for (unsigned int i = 0; i < 3; ++i)
    if (free_directions[i])
      energy += 0.5 * momentum[i] * momentum[i] / mass;
  return energy;
}

void EnergyErrors::save(StateWriter &writer) const {
  writer.write("errors", {has_begun_ ? 1. : 0., time_, last_drift_, last_contact_, last_total_, drift_,
                          penetration_, total_, step_factor_, start_});
}

void EnergyErrors::load(const StateReader &reader) {
  const std::vector<double> state = reader.read("errors", 10);
  has_begun_ = state.at(0) > 0.;
  time_ = state.at(1);
  last_drift_ = state.at(2);
  last_contact_ = state.at(3);
  last_total_ = state.at(4);
  drift_ = state.at(5);
  penetration_ = state.at(6);
  total_ = state.at(7);
  step_factor_ = state.at(8);
  start_ = state.at(9);
}

} // namespace billet
