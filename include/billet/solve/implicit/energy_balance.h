// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_ENERGY_BALANCE_H
#define BILLET_SOLVE_IMPLICIT_ENERGY_BALANCE_H

#include "billet/solve/contact_losses.h"
#include "billet/solve/implicit/path_guard.h"
#include "billet/solve/step_energy.h"

namespace billet {

class ImplicitMotion;

/// Energy balance of steps: rejects steps with too large an error by contact or elements, and
/// records the error of the trapezoidal rule. There is one class each for static and dynamic
/// scenes.
class EnergyBalance {
public:
  explicit EnergyBalance(ImplicitProblem &problem) : problem_(problem) {}
  virtual ~EnergyBalance() = default;
  EnergyBalance(const EnergyBalance &) = delete;
  EnergyBalance &operator=(const EnergyBalance &) = delete;

  /// Computes the energies of the trial state. Returns a failure if the error of the step's time
  /// integration is too large. Collective.
  virtual std::optional<StepFailure> judge_accuracy(double t);
  /// Returns a failure if contact generates or loses too much energy. Collective.
  virtual std::optional<StepFailure> judge_contact(double t, DiagnosticList &messages) = 0;
  /// Records the energy that contact and elements have generated or lost in the step, before its
  /// other works. Collective.
  virtual void commit(double t) = 0;
  /// Return messages after a step, and at the end of the run.
  virtual DiagnosticList check() { return {}; }
  virtual DiagnosticList finish() const { return {}; }

  /// Returns the error of the last step that was tried, over the allowed error; see
  /// ImplicitMotion::step_error().
  virtual double time_error() const { return 0.; }
  /// Whether contact between bodies causes most of the imbalance of the energies.
  bool contact_makes_energy() const;
  /// Returns the largest energy so far [energy].
  double max_energy() const { return max_energy_; }
  void update_max_energy();
  const InternalForces::Energies &trial_energies() const { return trial_energies_; }

  virtual void save(StateWriter &writer) const;
  virtual void load(const StateReader &reader);

protected:
  /// Work of contact in a step, less the energy that springs then store and friction
  /// dissipates; < 0: contact generates energy.
  struct ContactLoss {
    double total = 0.;
    double friction = 0.; ///< part of it by the springs of friction
  };
  /// Returns the loss of the step at its end, with `works` of StepWorks. Collective.
  ContactLoss contact_loss(double t, double works) const;
  /// Change of the elements' energy in the step, less the work of their forces by the trapezoidal
  /// rule.
  struct ElementImbalance {
    double by_yielding; ///< up to the plastic dissipation [energy]
    double unexplained; ///< [energy]
  };
  ElementImbalance element_imbalance() const;

  ImplicitProblem &problem_;
  ImplicitParts &parts_ = problem_.parts();
  /// Energy that contact has taken and not yet returned; in static scenes, of all steps except
  /// jumps.
  double contact_balance_ = 0.;
  InternalForces::Energies trial_energies_;
  double max_energy_ = 0.;
};

/// Balance of static scenes: a step in which contact loses much energy is cut, unless the bodies
/// jump.
class StaticBalance final : public EnergyBalance {
public:
  using EnergyBalance::EnergyBalance;
  std::optional<StepFailure> judge_contact(double t, DiagnosticList &messages) override;
  void commit(double t) override;
  DiagnosticList finish() const override;
  void save(StateWriter &writer) const override;
  void load(const StateReader &reader) override;

private:
  struct Limits {
    /// Work lost or created by contact in the whole run, as part of all work, above which a message
    /// is due.
    static constexpr double doubtful = 0.04;
  };

  double trial_contact_loss_ = 0.;
  StepEnergy step_energy_;
};

/// Balance of implicit dynamics: rejects errors of time integration, and contact that takes too
/// much energy at once. Contact that generates energy is damped.
class DynamicBalance final : public EnergyBalance {
public:
  DynamicBalance(ImplicitProblem &problem, const PathGuard &paths, ImplicitMotion &motion)
      : EnergyBalance(problem), paths_(paths), motion_(motion) {}
  std::optional<StepFailure> judge_accuracy(double t) override;
  std::optional<StepFailure> judge_contact(double t, DiagnosticList &messages) override;
  void commit(double t) override;
  DiagnosticList check() override;
  double time_error() const override { return time_error_; }
  void save(StateWriter &writer) const override;
  void load(const StateReader &reader) override;

private:
  /// Limits, as parts of the largest energy.
  struct Limits {
    /// Maximum energy that contact may generate, and return of what it took; and that it may take
    /// in a step, except friction.
    static constexpr double may_make = 0.005, may_take = 0.01;
    /// Limits of the elements' imbalance, (I8): in the run; of the rest of that in a step; and in
    /// any step.
    static constexpr double of_run = 0.02, of_rest = 0.05, always = 1e-4;
  };
  ContactLoss dynamic_loss(double t) const;
  double max_energy_of_trial() const;
  /// Returns the imbalance over the allowed one, (I8).
  double energy_error(double imbalance) const;
  /// Returns the part of the loss that is permanent.
  double taken_by_contact(const ContactLoss &loss) const;

  const PathGuard &paths_;
  ImplicitMotion &motion_;
  double time_error_ = 0.;
  /// Unexplained ElementImbalance, of the step and so far.
  double trial_imbalance_ = 0., element_balance_ = 0.;
  ContactLosses contact_losses_;
};

} // namespace billet

#endif
