// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_EXPLICIT_EXPLICIT_LEDGER_H
#define BILLET_SOLVE_EXPLICIT_EXPLICIT_LEDGER_H

#include "billet/solve/explicit/explicit_parts.h"
#include "billet/solve/solution.h"

#include <vector>

namespace billet {

/// Energies, works and momenta of an explicit scene, and their balance. Energies are those that the
/// scheme conserves: kinetic ½ v_{n−½}·M v_{n+½}, works by the trapezoidal rule.
class ExplicitLedger {
public:
  explicit ExplicitLedger(const ExplicitParts &parts) : parts_(parts) {}

  /// Number of steps between updates of the ledger, on which steps depend.
  static constexpr unsigned int steps_between_updates = 100;
  bool is_due() const { return parts_.clock.n_steps() % steps_between_updates == 0; }

  /// Returns the works of this rank, to which others add.
  ExplicitWorks &works() { return works_; }
  /// Adds the works of loads, supports and tools in a half step of length `half` at velocities `v`.
  void add_works(const NodalVectors &v, double half);

  /// Updates energies, momenta, loads and placements of `state`. Collective.
  void update(SolutionState &state);
  /// Returns the largest energy so far at steps when an update was due.
  double max_energy_when_due() const { return max_energy_when_due_; }
  /// Returns the part of the largest energy so far by which `energies` fail to balance. If
  /// min_energy() is larger, it is the reference.
  double relative_drift(const EnergyLedger &energies, double stable_step) const;

  /// Returns the energy that the refinement of bodies has made, (R6) of doc/theory, after the first
  /// update(). Counts it as initial energy, so that the drift remains the one `before`, on the
  /// coarser mesh at the same time.
  double count_refinement(SolutionState &state, const EnergyLedger &before);

  /// `energies`: those of the last update. Collective.
  void save(StateWriter &writer, EnergyLedger energies) const;
  /// Resumes with works of all ranks so far, and with `energies` read from the checkpoint.
  EnergyLedger load(const StateReader &reader, bool is_exact);

private:
  /// Returns sums over this rank, and sets extent_ to its largest coordinate.
  std::vector<double> sum_own();
  void add_tools(SolutionState &state) const;
  double kinetic_energy() const;
  /// Returns the energy below which round-off of positions alone violates the balance by the
  /// allowed part. With coordinates up to R, round-off of positions is ε R. The fastest oscillation
  /// has ω = 2/Δt for the bound Δt on the step. With amplitude a its energy is at most ½ m ω² a²,
  /// of which round-off is the part 2 ε R/a.
  double min_energy(double stable_step) const;

  const ExplicitParts &parts_;
  ExplicitWorks works_;
  double max_energy_ = 0., max_energy_when_due_ = 0.;
  double drift_ = 0.; ///< at the last update(), also before a restart [energy]
  /// Largest coordinate of the nodes of all ranks, at the last update [length].
  double extent_ = 0.;
};

} // namespace billet

#endif
