// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_INTEGRATION_TIME_INTEGRATOR_H
#define BILLET_INTEGRATION_TIME_INTEGRATOR_H

namespace billet {

/// Newmark's family of one-step methods for M ü + F(u, u̇, t) = 0, with the weights of the generalised-α
/// method,
///   M [(1 − α_m) a_{n+1} + α_m a_n] + (1 − α_f) F_{n+1} + α_f F_n = 0,                        (I1)
///   u_{n+1} = u_n + Δt v_n + Δt² [(½ − β) a_n + β a_{n+1}],
///   v_{n+1} = v_n + Δt [(1 − γ) a_n + γ a_{n+1}].                                             (I2)
/// Forces are weighted, not evaluated at a weighted state: F is computed at the ends of steps only, where the
/// histories of material and friction live. For linear F both are the same.
///
/// In steps in which contact would make energy its forces take no part in F and a, but act in full at the end
/// of the step (Kane, Repetto, Ortiz & Marsden 1999), with M c = F_c,
///   u_{n+1} = ... + Δt² (β/γ) c_{n+1},   v_{n+1} = ... + Δt c_{n+1},                          (I4)
/// so that a spring that opens or closes can only take some. For a* = a + c/γ (I2) stands as it is.
///
/// Equation (I1) is divided by 1 − α_f wherever it is used, so that the forces at the end of the step, and
/// their derivatives, stand in it as they stand in statics.
class TimeIntegrator {
public:
  /// The trapezoidal rule: of second order, without numerical dissipation.
  TimeIntegrator() : TimeIntegrator(0., 0., 0.25, 0.5) {}
  TimeIntegrator(const double alpha_m, const double alpha_f, const double beta, const double gamma)
      : alpha_m_(alpha_m), alpha_f_(alpha_f), beta_(beta), gamma_(gamma) {}

  double alpha_m() const { return alpha_m_; }
  double alpha_f() const { return alpha_f_; }
  double beta() const { return beta_; }
  double gamma() const { return gamma_; }

  /// A rate at the end of the step as increment (u_{n+1} − u_n) + velocity v_n + acceleration a_n, from (I2).
  struct Rate {
    double increment, velocity, acceleration;
  };
  Rate velocity(double step) const;
  Rate acceleration(double step) const;

  // Weights in (I1)/(1 − α_f), in which that of F_{n+1} is 1:
  double forces_before() const { return alpha_f_ / (1. - alpha_f_); }      ///< of F_n
  double inertia_now() const { return (1. - alpha_m_) / (1. - alpha_f_); } ///< of M a_{n+1}
  double inertia_before() const { return alpha_m_ / (1. - alpha_f_); }     ///< of M a_n
  /// Of contact's F_{n+1} with (I4), where a* is taken for a_{n+1}.
  double contact() const { return inertia_now() / gamma_; }
  /// What the tangent K = ∂F/∂u gets: this part of M [1/time²], and this part of C = ∂F/∂u̇ [1/time].
  double mass_factor(const double step) const { return inertia_now() * acceleration(step).increment; }
  double damping_factor(const double step) const { return velocity(step).increment; }

  /// The error that a step makes in the displacement is this times Δt² (a_{n+1} − a_n), to leading order: β −
  /// 1/6 (Zienkiewicz & Xie 1991), but not less than 1/12, that of the trapezoidal rule, since where it
  /// vanishes the velocity's error does not.
  double error_factor() const;

private:
  double alpha_m_, alpha_f_, beta_, gamma_;
};

} // namespace billet

#endif
