// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FRICTION_ACCOUNT_H
#define BILLET_CONTACT_FRICTION_ACCOUNT_H

#include <array>

namespace billet {

/// How works of a step weigh the tractions at its ends, and what the tangential springs of a node store.
struct FrictionRule {
  double stiffness;          ///< k_t [stress/length]
  double start_weight = 0.5; ///< θ: ½ is the trapezoidal rule, 0 the value at the end of the step
  /// In statics no integrator takes works by this rule: it is one of the path between two equilibria.
  bool is_static = false;
  /// Whether springs store energy, at the start and at the end: what augmentation holds is no stretch.
  bool stores_n = true, stores = true;
};

/// Tangential state of a node over a step, on two axes that turn with what it touches.
struct FrictionStep {
  std::array<double, 2> traction_n; ///< 0 where the node did not touch
  std::array<double, 2> traction;   ///< 0 where it does not touch any longer
  std::array<double, 2> motion;     ///< Δg_t of the whole step, relative to what it touches, or has left
  bool touches;                     ///< at the end
  double part_in_contact = 1.;      ///< φ: of the step, if it enters or leaves in it
  /// τ_n: what it could bear at the start, |t| p_n/p; 0 where it does not slip in the step.
  double limit_n = 0.;
};

/// What a node's friction takes from the motion in a step, eq. (E4) of doc/theory.md, with A the area of the
/// node and Ψ = |t|²/(2 k_t):
///   W = −(θ A_n t_n + (1 − θ) A t)·Δg_t = D + L + A Ψ − A_n Ψ_n.
/// For θ = ½, L = 0: all that is not stored is dissipated. For θ = 0, D = −A t·γ is what the return map
/// dissipates over the slip γ = Δg_t + (t − t_n)/k_t, and L = A |t − t_n|²/(2 k_t) is what the end value
/// takes besides; a node that leaves dissipates what its spring held. If springs store nothing, L = 0.
///
/// In statics dissipation never falls, (I6): D = ½ A_n max(−t_n·γ, τ_n |γ|) + ½ A <−t·γ>, with φ Δg_t in γ. A
/// node that sticks at the start slips once it bears τ_n, and not with t_n. In steady sliding that is W as
/// above, but for what a change of area makes of stored energy. A node that leaves has
/// D = A_n <Ψ_n − ½ φ t_n·Δg_t>. What mean forces take of the rest of the motion of nodes that enter or leave
/// is `beyond`; what they miss of the friction of nodes that begin to slip is `missed`.
///
/// Where a pair presses at both ends of a step, nodes that enter and nodes that leave hand its load over.
/// When they do so is not known, and their gaps do not say it: they are short beside the slip, and stiff
/// penalties leave no depth. The load goes over linearly then, with φ = 1: the sum is right whenever it
/// happens.
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

  /// The same with φ = 1: of a node that enters, or leaves, while others take over its load.
  FrictionAccount handed_over() const;
};

/// φ of a node that was `depth` deep and has been moved by `opening` along the normal since.
inline double part_before_leaving(const double depth, const double opening) {
  return opening > depth ? depth / opening : 1.;
}

FrictionAccount compute_friction_account(const FrictionStep &step, const FrictionRule &rule);

} // namespace billet

#endif
