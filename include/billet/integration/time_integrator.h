// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_INTEGRATION_TIME_INTEGRATOR_H
#define BILLET_INTEGRATION_TIME_INTEGRATOR_H

namespace billet {

/// Newmark's family of one-step methods for M ü + F(u, u̇, t) = 0. The weights are those of the
/// generalised-α method:
///   M [(1 − α_m) a_{n+1} + α_m a_n] + (1 − α_f) F_{n+1} + α_f F_n = 0,                        (I1)
///   u_{n+1} = u_n + Δt v_n + Δt² [(½ − β) a_n + β a_{n+1}],
///   v_{n+1} = v_n + Δt [(1 − γ) a_n + γ a_{n+1}].                                             (I2)
/// Forces are weighted, not evaluated at a weighted state. F is computed only at the ends of steps,
/// where the histories of material and friction are defined. For linear F both are the same.
///
/// In steps in which contact would generate energy, its forces are excluded from F and a. They act
/// in full at the end of the step (Kane, Repetto, Ortiz & Marsden 1999). With M c = F_c,
///   u_{n+1} = ... + Δt² (β/γ) c_{n+1},   v_{n+1} = ... + Δt c_{n+1}.                          (I4)
/// Thus a contact spring that opens or closes can only dissipate energy. With a* = a + c/γ in place
/// of a, (I2) holds unchanged.
///
/// Equation (I1) is divided by 1 − α_f wherever it is used. The forces at the end of the step, and
/// their derivatives, then enter it as they enter statics.
class TimeIntegrator {
public:
  /// Makes the trapezoidal rule: second order, no numerical dissipation.
  TimeIntegrator() : TimeIntegrator(0., 0., 0.25, 0.5) {}
  TimeIntegrator(const double alpha_m, const double alpha_f, const double beta, const double gamma)
      : alpha_m_(alpha_m), alpha_f_(alpha_f), beta_(beta), gamma_(gamma) {}

  double alpha_m() const { return alpha_m_; }
  double alpha_f() const { return alpha_f_; }
  double beta() const { return beta_; }
  double gamma() const { return gamma_; }

  /// Coefficients of a rate at the end of the step: increment (u_{n+1} − u_n) + velocity v_n +
  /// acceleration a_n, from (I2).
  struct Rate {
    double increment, velocity, acceleration;
  };
  Rate velocity(double step) const;
  Rate acceleration(double step) const;

  // Weights in (I1)/(1 − α_f), in which that of F_{n+1} is 1:
  double forces_before() const { return alpha_f_ / (1. - alpha_f_); }      ///< of F_n
  double inertia_now() const { return (1. - alpha_m_) / (1. - alpha_f_); } ///< of M a_{n+1}
  double inertia_before() const { return alpha_m_ / (1. - alpha_f_); }     ///< of M a_n
  /// Returns the weight of contact's F_{n+1} with (I4), where a* stands in for a_{n+1}.
  double contact() const { return inertia_now() / gamma_; }
  /// Factors with which M [1/time²] and C = ∂F/∂u̇ [1/time] are added to the tangent K = ∂F/∂u.
  double mass_factor(const double step) const { return inertia_now() * acceleration(step).increment; }
  double damping_factor(const double step) const { return velocity(step).increment; }

  /// Returns the factor of Δt² (a_{n+1} − a_n) in the leading local error of the displacement:
  /// β − 1/6 (Zienkiewicz & Xie 1991). It is not less than 1/12, that of the trapezoidal rule:
  /// where the displacement's error vanishes, the velocity's does not.
  double error_factor() const;

private:
  double alpha_m_, alpha_f_, beta_, gamma_;
};

} // namespace billet

#endif
