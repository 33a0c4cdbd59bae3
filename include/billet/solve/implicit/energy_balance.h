// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_ENERGY_BALANCE_H
#define BILLET_SOLVE_IMPLICIT_ENERGY_BALANCE_H

#include "billet/solve/contact_losses.h"
#include "billet/solve/implicit/path_guard.h"
#include "billet/solve/step_energy.h"

namespace billet {

class ImplicitMotion;

/// The balance of energy of steps: rejects those that contact, or the elements, make too large an error in,
/// and books what the trapezoidal rule misses. Of static and of dynamic scenes there is one each.
class EnergyBalance {
public:
  explicit EnergyBalance(ImplicitProblem &problem) : problem_(problem) {}
  virtual ~EnergyBalance() = default;
  EnergyBalance(const EnergyBalance &) = delete;
  EnergyBalance &operator=(const EnergyBalance &) = delete;

  /// Computes the energies of the trial state. Whether the error of the step's time integration is too large;
  /// then the step fails. Collective.
  virtual bool is_inaccurate(double t, NewtonReport &report);
  /// Whether contact makes or loses so much energy that the step fails. Collective.
  virtual bool rejects(double t, NewtonReport &report) = 0;
  /// Books what contact and elements have made or lost in the step, before its other works. Collective.
  virtual void commit(double t) = 0;
  /// Messages after a step; at the end of the run.
  virtual DiagnosticList check() { return {}; }
  virtual DiagnosticList finish() const { return {}; }

  /// Of the last step that was tried: as part of what is allowed, see ImplicitMotion::step_error().
  virtual double time_error() const { return 0.; }
  /// Whether contact between bodies makes most of what the energies fail to balance by.
  bool contact_makes_energy() const;
  /// So far [energy].
  double largest_energy() const { return largest_energy_; }
  void update_largest_energy();
  const InternalForces::Energies &trial_energies() const { return trial_energies_; }

  virtual void save(StateWriter &writer) const;
  virtual void load(const StateReader &reader);

protected:
  /// What contact takes in a step, less what springs then store and friction dissipates; < 0: it makes
  /// energy.
  struct ContactLoss {
    double total = 0.;
    double friction = 0.; ///< of that, by the springs of friction
  };
  /// Of the step at its end; `works` of StepWorks count, too. Collective.
  ContactLoss contact_loss(double t, double works) const;
  /// What the work of the elements' forces in the step, by the trapezoidal rule, misses of their energy.
  struct ElementImbalance {
    double by_yielding; ///< as far as plastic flow explains it [energy]
    double unexplained; ///< [energy]
  };
  ElementImbalance element_imbalance() const;

  ImplicitProblem &problem_;
  /// What contact has taken and not yet given back, of static scenes in all steps that are no jumps.
  double contact_balance_ = 0.;
  InternalForces::Energies trial_energies_;
  double largest_energy_ = 0.;
};

/// Of static scenes: a step in which contact loses much is cut, unless the bodies jump.
class StaticBalance final : public EnergyBalance {
public:
  using EnergyBalance::EnergyBalance;
  bool rejects(double t, NewtonReport &report) override;
  void commit(double t) override;
  DiagnosticList finish() const override;
  void save(StateWriter &writer) const override;
  void load(const StateReader &reader) override;

private:
  double trial_contact_loss_ = 0.;
  StepEnergy step_energy_;
};

/// Of implicit dynamics: errors of time integration, and contact that makes energy, which is damped, or takes
/// too much at once.
class DynamicBalance final : public EnergyBalance {
public:
  DynamicBalance(ImplicitProblem &problem, const PathGuard &paths, ImplicitMotion &motion)
      : EnergyBalance(problem), paths_(paths), motion_(motion) {}
  bool is_inaccurate(double t, NewtonReport &report) override;
  bool rejects(double t, NewtonReport &report) override;
  void commit(double t) override;
  DiagnosticList check() override;
  double time_error() const override { return time_error_; }
  void save(StateWriter &writer) const override;
  void load(const StateReader &reader) override;

private:
  /// Parts of the largest energy.
  struct Limits {
    /// That contact may make, and give back of what it took; and that it may take in a step, but for
    /// friction.
    static constexpr double may_make = 0.005, may_take = 0.01;
    /// Of elements, (I8): in the run; of what is left of that in a step; and in a step always.
    static constexpr double of_run = 0.02, of_rest = 0.05, always = 1e-4;
  };
  ContactLoss dynamic_loss(double t) const;
  double largest_energy_of_trial() const;
  /// As part of what is allowed, (I8).
  double energy_error(double imbalance) const;
  /// What of that is lost for good.
  double taken_by_contact(const ContactLoss &loss) const;

  const PathGuard &paths_;
  ImplicitMotion &motion_;
  double time_error_ = 0.;
  /// What the work of the elements' forces misses of their energy, in the step and so far.
  double trial_imbalance_ = 0., element_balance_ = 0.;
  ContactLosses contact_losses_;
};

} // namespace billet

#endif
