// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_EXPLICIT_EXPLICIT_DYNAMICS_H
#define BILLET_SOLVE_EXPLICIT_EXPLICIT_DYNAMICS_H

#include "billet/solve/element_points.h"
#include "billet/solve/explicit/crossing_limit.h"
#include "billet/solve/explicit/explicit_ledger.h"
#include "billet/solve/explicit/explicit_penalties.h"
#include "billet/solve/explicit/explicit_reactions.h"
#include "billet/solve/start_gap_watch.h"

#include <algorithm>
#include <vector>

namespace billet {

/// M a = F_ext + F_c − F_int by central differences with a lumped mass:
///   v_{n+½} = v_{n−½} + ½ (Δt_{n−1} + Δt_n) M⁻¹ F_n,   u_{n+1} = u_n + Δt_n v_{n+½}.
/// A step has two parts. The first, prepare_step(), computes the forces at t_n and the velocities
/// after it, which completes the state at t_n. The second, finish_step(), moves on to t_{n+1}.
///
/// In a linear system with equal steps the sum of the energies of ExplicitLedger is constant to
/// round-off.
class ExplicitDynamics final : public Solution, public HasElementPoints {
public:
  ExplicitDynamics(const Scene &scene, const Discretization &discretization);
  ~ExplicitDynamics() override;

  /// Computes the forces at the current time, a stable step that leads to `event` (see
  /// ExplicitClock), and the velocities after the forces. Throws SolutionFailure if the state is
  /// not admissible.
  void prepare_step(double event);
  void finish_step();
  /// Multiplies all further steps by this factor, beside the safety factor.
  void shorten_steps(const double factor) { stable_step_.shorten(factor); }

  double time() const { return parts_.clock.time(); }
  double step_length() const { return parts_.clock.step(); }
  /// Returns the maximum step while no node comes through a surface.
  double usual_step() const { return std::max(step_length(), stable_step_.usual()); }
  /// Returns the maximum step, as usual_step(), if at time t the bodies had moved without
  /// deformation by these translations. It is for forecasts, after which there are no further
  /// steps. Collective.
  double usual_step_at(double t, const std::vector<dealii::Tensor<1, 3>> &translations);
  unsigned int n_steps() const { return parts_.clock.n_steps(); }
  /// Returns this rank's element with the shortest stable step at the start.
  LimitingElement find_limiting_element() const {
    return parts_.elements.find_limiting_element(parts_.settings().scaled_step /
                                                 parts_.settings().safety_factor);
  }
  /// Returns the mass that mass scaling adds, on all ranks [mass].
  double added_mass() const { return parts_.masses.added(); }
  /// Returns the mass of the bodies without added mass, on all ranks [mass].
  double mass() const { return parts_.masses.of_bodies(); }

  /// Number of steps between updates of the energies, on which steps depend.
  static constexpr unsigned int steps_between_checks = ExplicitLedger::steps_between_updates;
  /// Updates energies, momenta, tools and reactions, after prepare_step(). Collective.
  void update_ledger();
  /// Updates these and the fields. Collective.
  void update_state();
  /// Returns the energy that the refinement of bodies has made, and counts it as initial energy,
  /// after the first update_ledger() [energy]. `before`: on the coarser mesh at the same time.
  double count_refinement(const EnergyLedger &before) { return ledger_.count_refinement(state_, before); }
  /// Returns warnings about penalties, after prepare_step(). Collective.
  DiagnosticList check_penalties() { return penalties_.check(state_.energies); }
  /// Returns messages about causes of much shorter steps, contact or flat elements, each once,
  /// after prepare_step(). Collective.
  DiagnosticList check_steps() const;
  /// Returns messages at the end of the run, about pairs that close initial gaps.
  DiagnosticList finish() const { return start_gaps_.judge(); }
  /// Whether check_penalties() has ever found a penalty too low.
  bool has_low_penalties() const { return penalties_.has_low_penalties(); }
  /// Returns the part of the largest energy so far by which the energies of the last update fail to
  /// balance; see ExplicitLedger.
  double relative_drift() const { return ledger_.relative_drift(state_.energies, stable_step_.value()); }

  /// Saves the state from which the next prepare_step() resumes, after finish_step().
  void save(StateWriter &writer) const;
  /// Resumes from such a state instead of starting at time 0: prepare_step() comes next. From
  /// another method or formulation it takes displacements, stresses and, if present, velocities.
  RestartReport load(StateReader &reader);
  /// Makes steps that were planned earlier lead to this event, after load().
  void plan_to(const double event) { parts_.clock.plan_to(event); }

  const SolutionState &state() const override { return state_; }
  const Discretization &discretization() const override { return parts_.discretization; }
  std::vector<ElementSummary> summarize(std::size_t body) const override {
    return parts_.elements.summarize(body, parts_.motion.displacements());
  }
  std::vector<StateAverages> average_states(std::size_t body) const override {
    return parts_.elements.average_states(body, parts_.motion.displacements());
  }
  std::vector<ElementPoints> element_points(std::size_t body) const override {
    return parts_.elements.element_points(body, parts_.motion.displacements());
  }
  std::vector<std::vector<ContactNodeReport>> report_contacts() const override {
    return parts_.contacts.report();
  }
  std::array<std::size_t, 2> history_sizes() const override;
  std::string method() const override;
  DiagnosticList initial_diagnostics() const override { return parts_.contacts.check_start(); }
  const Reactions &reactions() const override { return reactions_.values(); }

private:
  /// Computes forces and bounds on the step at t_n. Throws any failure on all ranks.
  void compute_forces();
  /// Adds the works in a half step of length `half` at these velocities.
  void add_works(const NodalVectors &velocities, double half);
  /// Raises penalties now and then, with the present forces. Collective.
  void raise_penalties();
  void load_contacts(StateReader &reader, const NodeKeys &keys);

  ExplicitParts parts_;
  ExplicitLedger ledger_;
  StableStep stable_step_;
  StartGapWatch start_gaps_;
  CrossingLimit crossing_limit_;
  ExplicitPenalties penalties_;
  SolutionState state_;
  ExplicitReactions reactions_;
};

} // namespace billet

#endif
