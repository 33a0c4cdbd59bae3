// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_EXPLICIT_EXPLICIT_DYNAMICS_H
#define BILLET_SOLVE_EXPLICIT_EXPLICIT_DYNAMICS_H

#include "billet/solve/explicit/crossing_limit.h"
#include "billet/solve/explicit/explicit_ledger.h"
#include "billet/solve/explicit/explicit_penalties.h"

#include <algorithm>
#include <vector>

namespace billet {

/// M a = F_ext + F_c − F_int by central differences with a lumped mass:
///   v_{n+½} = v_{n−½} + ½ (Δt_{n−1} + Δt_n) M⁻¹ F_n,   u_{n+1} = u_n + Δt_n v_{n+½}.
/// A step has two parts. prepare_step() computes the forces at t_n and the velocities after it: then the
/// state at t_n is complete. finish_step() moves on to t_{n+1}.
///
/// In a linear system with equal steps the sum of the energies of ExplicitLedger is constant to round-off.
class ExplicitDynamics final : public Solution {
public:
  ExplicitDynamics(const Scene &scene, const Discretization &discretization);

  /// Forces at the current time, then a step that is stable and leads to `event`, see ExplicitClock; the
  /// velocities after it. Throws SolutionFailure where the state is not admissible.
  void prepare_step(double event);
  void finish_step();
  /// Steps are this part of what the safety factor allows, from now on.
  void shorten_steps(const double factor) { stable_step_.shorten(factor); }

  double time() const { return parts_.clock.time(); }
  double step_length() const { return parts_.clock.step(); }
  /// What steps grow to as long as nothing comes through a surface.
  double usual_step() const { return std::max(step_length(), stable_step_.usual()); }
  unsigned int n_steps() const { return parts_.clock.n_steps(); }
  /// By mass scaling, on all ranks [mass].
  double added_mass() const { return parts_.masses.added(); }
  /// Of the bodies, without that, on all ranks [mass].
  double mass() const { return parts_.masses.of_bodies(); }

  /// The energies are to be brought up to date whenever so many steps have been taken: steps depend on them.
  static constexpr unsigned int steps_between_looks = ExplicitLedger::steps_between_updates;
  /// After prepare_step(): brings energies, momenta and tools in the state up to date. Collective.
  void update_ledger();
  /// The same, and the fields. Collective.
  void update_state();
  /// After prepare_step(): what the user should know of the penalties; lines. Collective.
  DiagnosticList check_penalties() { return penalties_.check(state_.energies); }
  /// After prepare_step(): what makes steps much shorter than they would be without, contact or flat
  /// elements; lines, each once. Collective.
  DiagnosticList check_steps() const;
  /// Whether it has said so of any pair, ever.
  bool has_soft_penalties() const { return penalties_.has_soft_pairs(); }
  /// Part of the largest energy so far by which the energies of the last update fail to balance, see
  /// ExplicitLedger.
  double relative_drift() const { return ledger_.relative_drift(state_.energies, stable_step_.value()); }

  /// After finish_step(): the state from which the next prepare_step() goes on.
  void save(StateWriter &writer) const;
  /// Goes on from such a state, in place of the start at time 0: prepare_step() comes next. From another
  /// method's, or another formulation's: its displacements, stresses and, if it has some, velocities.
  RestartReport load(StateReader &reader);
  /// After load(): steps that were planned before lead to this event from now on.
  void plan_to(const double event) { parts_.clock.plan_to(event); }

  const SolutionState &state() const override { return state_; }
  const Discretization &discretization() const override { return parts_.discretization; }
  std::vector<ElementSummary> summarize(const std::size_t body) const override {
    return parts_.elements.summarize(body, parts_.motion.displacements());
  }
  std::vector<std::vector<ContactNodeReport>> report_contacts() const override {
    return parts_.contacts.report();
  }
  std::array<std::size_t, 2> history_sizes() const override;
  std::string method() const override;
  DiagnosticList initial_diagnostics() const override { return parts_.contacts.check_start(); }

private:
  /// Forces and bounds on the step at t_n. Any failure shows on all ranks.
  void compute_forces();
  /// Now and then, with the forces at hand. Collective.
  void raise_penalties();
  void load_contacts(StateReader &reader, const NodeKeys &keys);

  ExplicitParts parts_;
  ExplicitLedger ledger_;
  StableStep stable_step_;
  CrossingLimit crossing_limit_;
  ExplicitPenalties penalties_;
  SolutionState state_;
};

} // namespace billet

#endif
