// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FRICTION_ACCOUNT_H
#define BILLET_CONTACT_FRICTION_ACCOUNT_H

#include <array>

namespace billet {

struct FrictionAccount;
struct FrictionStep;
struct FrictionRule;

/// Rule by which the works of friction in a step are counted: one of those below, chosen by the
/// scheme.
struct FrictionAccounting {
  FrictionAccount (*compute)(const FrictionStep &, const FrictionRule &);
  /// Whether a load that nodes which leave hand over to others counts by
  /// FrictionAccount::handed_over().
  bool counts_hand_over;

  /// Accounting by the rule with which an integrator computes works.
  static const FrictionAccounting of_motion;
  /// Accounting for the path between two equilibria, whose works no integrator uses.
  static const FrictionAccounting of_equilibria;
};

/// Weights of the tractions at the ends of a step in its works, and storage in a node's tangential
/// springs.
struct FrictionRule {
  double stiffness;          ///< k_t [stress/length]
  double start_weight = 0.5; ///< θ: ½ is the trapezoidal rule, 0 the value at the end of the step
  const FrictionAccounting *accounting = &FrictionAccounting::of_motion;
  /// Whether springs store energy, at the start and at the end: multipliers do not stretch them.
  bool stores_n = true, stores = true;
};

/// Tangential state of a node over a step, on two axes that rotate with the touched surface.
struct FrictionStep {
  std::array<double, 2> traction_n; ///< 0 where the node did not touch
  std::array<double, 2> traction;   ///< 0 where it does not touch any longer
  /// Δg_t of the whole step, relative to the touched or left surface.
  std::array<double, 2> motion;
  bool touches; ///< at the end
  // Only of_equilibria uses these:
  double part_in_contact = 1.; ///< φ: part of the step, if it enters or leaves in it
  /// τ_n: friction limit at the start, |t| p_n/p; 0 where the node does not slip in the step.
  double limit_n = 0.;
};

/// Work of a node's friction in a step, eq. (E4) of doc/theory.md, with A the area of the node and
/// Ψ = |t|²/(2 k_t):
///   W = −(θ A_n t_n + (1 − θ) A t)·Δg_t = D + L + A Ψ − A_n Ψ_n.
/// For θ = ½, L = 0: work that is not stored is dissipated. For θ = 0, D = −A t·γ is the
/// dissipation of the return map over the slip γ = Δg_t + (t − t_n)/k_t. L = A |t − t_n|²/(2 k_t)
/// is the additional loss of the end value; a node that leaves dissipates the energy of its spring.
/// If springs store nothing, L = 0.
///
/// In statics dissipation never decreases, (I6): D = ½ A_n max(−t_n·γ, τ_n |γ|) + ½ A <−t·γ>, with
/// φ Δg_t in γ. A node that sticks at the start slips once it bears τ_n, and not with t_n. In
/// steady sliding this equals W above, except for the change of stored energy by a change of area.
///
/// A node that leaves has D = A_n <Ψ_n − ½ φ t_n·Δg_t>. `beyond` is the work of mean forces on the
/// rest of the motion of nodes that enter or leave. `missed` is the friction work that mean forces
/// omit for nodes that begin to slip.
///
/// Where a pair presses at both ends of a step, nodes that leave transfer its load to nodes that
/// enter. The gaps do not show the time of the transfer: they are small compared with the slip, and
/// stiff penalties leave no penetration. The transfer is then linear, with φ = 1: the sum is
/// correct for any time.
struct FrictionAccount {
  // Parts of D and L per area at the start and at the end of the step [energy/length²].
  double dissipation_n = 0., dissipation = 0.;
  double damping = 0.;
  double beyond_n = 0., beyond = 0.;
  double missed_n = 0.; ///< friction, beside dissipation_n

  double dissipated(const double area_n, const double area) const {
    return area_n * (dissipation_n + missed_n) + area * dissipation;
  }
  double missed(const double area_n) const { return area_n * missed_n; }
  double taken_beyond(const double area_n, const double area) const {
    return area_n * beyond_n + area * beyond;
  }

  /// Returns the account with φ = 1: for a node that enters or leaves in a transfer of load.
  FrictionAccount handed_over() const;
};

/// Returns φ of a node with the penetration `penetration` that has since moved by `opening` along
/// the normal.
inline double part_before_leaving(const double penetration, const double opening) {
  return opening > penetration ? penetration / opening : 1.;
}

inline FrictionAccount compute_friction_account(const FrictionStep &step, const FrictionRule &rule) {
  return rule.accounting->compute(step, rule);
}

} // namespace billet

#endif
