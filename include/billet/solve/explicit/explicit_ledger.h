// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_EXPLICIT_EXPLICIT_LEDGER_H
#define BILLET_SOLVE_EXPLICIT_EXPLICIT_LEDGER_H

#include "billet/solve/explicit/explicit_parts.h"
#include "billet/solve/solution.h"

#include <vector>

namespace billet {

/// Energies, works and momenta of an explicit scene, and how well they balance. Energies are those that the
/// scheme keeps: kinetic ½ v_{n−½}·M v_{n+½}, works by the trapezoidal rule.
class ExplicitLedger {
public:
  explicit ExplicitLedger(const ExplicitParts &parts) : parts_(parts) {}

  /// The ledger is to be updated whenever so many steps have been taken: steps depend on it.
  static constexpr unsigned int steps_between_updates = 100;
  bool is_due() const { return parts_.clock.n_steps() % steps_between_updates == 0; }

  /// Returns works of this rank, to which others add theirs.
  ExplicitWorks &works() { return works_; }
  /// Adds what loads, supports and tools do in the half step at velocities `v` that is `half` long.
  void add_works(const NodalVectors &v, double half);

  /// Brings energies, momenta, loads and placements of `state` up to date. Collective.
  void update(SolutionState &state);
  /// Returns the largest energy so far at steps when an update was due.
  double max_energy_when_due() const { return max_energy_when_due_; }
  /// Returns the part of the largest energy so far by which `energies` fail to balance; of min_energy(),
  /// while that is larger.
  double relative_drift(const EnergyLedger &energies, double stable_step) const;

  /// `energies`: those of the last update. Collective.
  void save(StateWriter &writer, EnergyLedger energies) const;
  /// Resumes with works of all ranks so far, and with `energies` read from the checkpoint.
  EnergyLedger load(const StateReader &reader, bool is_exact);

private:
  /// Returns sums of this rank, and sets extent_ to its largest coordinate.
  std::vector<double> sum_own();
  void add_tools(SolutionState &state) const;
  double kinetic_energy() const;
  /// Below this, the round-off of positions alone makes energies fail to balance by the allowed part. With
  /// coordinates up to R they are known to ε R; an error of that size in the fastest oscillation, ω = 2/Δt of
  /// the bound Δt on the step, of amplitude a makes up 2 ε R/a of its energy, ½ m ω² a² at most.
  double min_energy(double stable_step) const;

  const ExplicitParts &parts_;
  ExplicitWorks works_;
  double max_energy_ = 0., max_energy_when_due_ = 0.;
  double extent_ = 0.; ///< largest coordinate of the nodes of all ranks, at the last update [length]
};

} // namespace billet

#endif
