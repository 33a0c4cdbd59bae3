// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_EXPLICIT_DYNAMICS_H
#define BILLET_SOLVE_EXPLICIT_DYNAMICS_H

#include "billet/contact/contacts.h"
#include "billet/discretization/held_motion.h"
#include "billet/errors.h"
#include "billet/forces/external_loads.h"
#include "billet/mechanics/explicit_block.h"
#include "billet/solve/free_tool.h"
#include "billet/solve/penalty_control.h"
#include "billet/solve/penalty_watch.h"
#include "billet/solve/restart.h"
#include "billet/usage.h"

#include <algorithm>
#include <memory>
#include <vector>

namespace billet {

/// What the scene says of a body's elements.
ExplicitFormulation make_formulation(const parameters::Scene &scene, const parameters::Body &body);

/// M a = F_ext + F_c − F_int by central differences with a lumped mass:
///   v_{n+½} = v_{n−½} + ½ (Δt_{n−1} + Δt_n) M⁻¹ F_n,   u_{n+1} = u_n + Δt_n v_{n+½}.
/// A step has two parts. prepare_step() computes the forces at t_n and the velocities after it: then the
/// state at t_n is complete. finish_step() moves on to t_{n+1}.
///
/// The energies are those that the scheme keeps: kinetic ½ v_{n−½}·M v_{n+½}, works by the trapezoidal rule.
/// In a linear system with equal steps their sum is constant to round-off.
class ExplicitDynamics final : public Solution {
public:
  ExplicitDynamics(const Scene &scene, const Discretization &discretization);

  /// Forces at the current time, then a step that is stable and leads to `event` in a whole number of equal
  /// steps, as long as they may stay equal; the velocities after it. Steps grow by 2 % at a
  /// time, faster while they are much shorter than they may be. Throws SolutionFailure where the state is not
  /// admissible.
  void prepare_step(double event);
  void finish_step();
  /// Steps are this part of what the safety factor allows, from now on.
  void shorten_steps(const double factor) { step_factor_ = factor; }

  double time() const { return time_; }
  double step_length() const { return step_; }
  /// What steps grow to as long as nothing comes through a surface.
  double usual_step() const {
    return std::max(step_, step_factor_ * parameters_.safety_factor * element_step_);
  }
  unsigned int n_steps() const { return n_steps_; }
  /// By mass scaling, on all ranks [mass].
  double added_mass() const { return added_mass_; }
  /// Of the bodies, without that, on all ranks [mass].
  double mass() const { return mass_; }

  /// The energies are to be brought up to date whenever so many steps have been taken: steps depend on them.
  static constexpr unsigned int steps_between_looks = 100;
  /// After prepare_step(): brings energies, momenta and tools in the state up to date. Collective.
  void update_ledger();
  /// The same, and the fields. Collective.
  void update_state();
  /// After prepare_step(): what the user should know of the penalties; lines. Collective.
  DiagnosticList check_penalties();
  /// After prepare_step(): what makes steps much shorter than they would be without, contact or flat
  /// elements; lines, each once. Collective.
  DiagnosticList check_steps() const;
  /// Whether it has said so of any pair, ever.
  bool has_soft_penalties() const { return soft_penalties_.has_soft_pairs(); }
  /// Part of the largest energy so far by which the energies of the last update fail to balance; of
  /// smallest_energy(), while that is larger.
  double relative_drift() const;

  /// After finish_step(): the state from which the next prepare_step() goes on.
  void save(StateWriter &writer) const;
  /// Goes on from such a state, in place of the start at time 0: prepare_step() comes next. From another
  /// method's, or another formulation's: its displacements, stresses and, if it has some, velocities.
  RestartReport load(StateReader &reader);
  /// After load(): steps that were planned before lead to this event from now on.
  void plan_to(double event);

  const SolutionState &state() const override { return state_; }
  const Discretization &discretization() const override { return discretization_; }
  std::vector<ElementSummary> summarize(std::size_t body) const override;
  std::vector<std::vector<ContactNodeReport>> report_contacts() const override;
  std::array<std::size_t, 2> history_sizes() const override;
  std::string method() const override;
  DiagnosticList initial_diagnostics() const override { return contacts_.check_start(); }

private:
  std::vector<std::unique_ptr<ExplicitBlock>> make_blocks() const;
  void count_memory();
  void make_masses();
  void set_initial_motion();
  void find_touched_nodes();
  /// F_n into forces_, and bounds on the step. Any failure shows on all ranks.
  void compute_forces();
  void compute_internal_forces();
  /// Returns why nodes of this rank have gone through a tool; empty if none has. Collective.
  std::string compute_contact_forces();
  std::vector<Placement> placements_of(const Placement &(FreeTool::*get)() const) const;
  void remove_tools();
  /// Now and then, with the forces at hand. Collective.
  void raise_penalties();
  double stable_step();
  /// The step in which nodes that come through surfaces make too large an error of energy; infinite if there
  /// is none. Collective.
  double crossing_step() const;
  /// What tools with a mass, which is not infinite, add to ω² of the contacts. Collective.
  double tools_share() const;
  /// Below this, the round-off of positions alone makes energies fail to balance by the allowed part. With
  /// coordinates up to R they are known to ε R; an error of that size in the fastest oscillation, ω = 2/Δt of
  /// the bound Δt on the step, of amplitude a makes up 2 ε R/a of its energy, ½ m ω² a² at most.
  double smallest_energy() const;
  void choose_step(double event);
  void kick();
  /// What this step's forces do in the half step at velocities `v` that is `half` long.
  void add_works(const NodalVectors &v, double half);
  // Of save() and load(), in solve/explicit_state.cc:
  void load_nodal_state(StateReader &reader, const NodeKeys &keys, bool is_exact);
  void load_clock(StateReader &reader);
  void load_tools(StateReader &reader, const NodeKeys &keys, bool is_exact);
  void load_contacts(StateReader &reader, const NodeKeys &keys);
  std::string describe_flat_elements() const;
  SolutionFailure failure(const std::string &why) const;
  [[noreturn]] void fail(const std::string &why) const;

  const Scene &scene_;
  const Discretization &discretization_;
  const parameters::ExplicitDynamics &parameters_;
  LocalNodes nodes_;
  HeldMotion held_;
  std::vector<std::unique_ptr<ExplicitBlock>> blocks_; ///< by body
  std::unique_ptr<ExternalLoads> loads_;
  Contacts contacts_;
  std::vector<FreeTool> tools_;
  std::vector<ContactLoad> tool_loads_; ///< at t_n, of this rank
  std::vector<double> tool_stiffness_;  ///< against free tools, of this rank
  bool has_free_tools_ = false;
  std::vector<std::unique_ptr<NodalVectors>> fading_forces_; ///< of removed tools, of this rank, as they were

  std::vector<double> masses_;         ///< of the nodes, on all their ranks alike
  std::vector<double> inverse_masses_; ///< of the nodes
  NodalVectors u_, v_, v_before_;      ///< displacements at t_n, velocities after and before it
  NodalVectors forces_;   ///< F_n, of all ranks, from compute_forces() to kick(); zero in between
  NodalVectors external_; ///< part of F_n by loads and removed tools, of this rank; zero but at loaded_nodes_
  NodalVectors supports_; ///< what the supports add to F_n, of all ranks; zero but at held nodes
  NodalVectors bounds_;   ///< beside the elements' own: of stiffness, of damping; zero but at bounded_nodes_
  std::vector<unsigned int> loaded_nodes_, bounded_nodes_; ///< of this rank; of all ranks
  bool has_bounds_ = false;                                ///< contacts, springs or dashpots on any rank
  double element_step_ = 0.;                     ///< stable step, with what else bounds it, of all ranks
  double free_step_ = 0., first_free_step_ = 0.; ///< that of the elements alone, of all ranks; at the start
  Crossings crossings_;                          ///< of this rank, at t_n
  double crossing_step_ = 0.;
  double time_ = 0., step_ = 0., step_before_ = 0.;
  double step_factor_ = 1.; ///< beside the safety factor
  bool is_growing_ = false; ///< steps were much shorter than they may be, and are not yet long
  double event_ = 0.;       ///< that the planned steps lead to
  unsigned int n_steps_ = 0, n_planned_ = 0; ///< steps taken; steps of the present length before the event
  double time_before_ = 0.;                  ///< of the last forces, after finish_step()
  std::exception_ptr late_failure_;          ///< of this rank, since the last compute_forces()
  double mass_ = 0., added_mass_ = 0.;
  double largest_energy_ = 0.;
  double energy_of_steps_ = 0.; ///< the largest at every steps_between_looks steps
  PenaltyControl penalties_;
  PenaltyWatch soft_penalties_{PenaltyWatch::Motion::sudden};
  double extent_ = 0.; ///< largest coordinate of the nodes of all ranks, at the last update [length]
  struct Works {
    double external = 0., plastic = 0., friction = 0., viscous = 0.;
  };
  HeldMemory plastic_memory_{Capability::plasticity}, stabilised_memory_{Capability::stabilisation},
      inertia_memory_{Capability::inertia}, tool_memory_{Capability::driven_tools};
  Works works_;                                        ///< since time 0, of this rank
  double elastic_energy_ = 0., hourglass_energy_ = 0.; ///< at t_n, of this rank
  SolutionState state_;
};

} // namespace billet

#endif
