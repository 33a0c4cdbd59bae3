// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_AUGMENTATION_H
#define BILLET_SOLVE_IMPLICIT_AUGMENTATION_H

#include "billet/solve/implicit/equilibrium_solver.h"
#include "billet/solve/implicit/penetration_measurement.h"
#include "billet/solve/softness_limit.h"

#include <array>
#include <vector>

namespace billet {

/// The augmented Lagrangian of contacts: tractions are augmented and iterated anew until all pairs have what
/// they ask for, a 'Penetration tolerance' or a limit of softness.
class Augmentation {
public:
  Augmentation(ImplicitProblem &problem, EquilibriumSolver &solver, PenetrationMeasurement &measurement);

  /// Augments from the state of `report`, and continues it. Collective.
  void augment(NewtonReport &report, std::vector<double> &offsets, Vector &displacements);

  /// Tractions are augmented where penetrations are above so many times what pairs ask for.
  void allow_penetration(const double factor) { penetration_allowed_ = factor; }
  /// What augmentation leaves above that is an error to be reported, and fails no step.
  void may_leave_penetration() { may_leave_penetration_ = true; }
  /// Makes penalties of augmented contacts that are stiffer than 10 E/h as stiff as that, with a message on
  /// each; false if there is none. Collective.
  bool soften_contacts(DiagnosticList &messages);

  /// What is learnt of softness; a probe puts it back.
  const SoftnessLimit &softness() const { return softness_; }
  void set_softness(const SoftnessLimit &softness) { softness_ = softness; }
  /// Accepts the step. Collective.
  void commit() { softness_.commit(contact_springs()); }
  /// Messages at the end about pairs whose augmentation was given up while it changed forces.
  DiagnosticList finish() const;

  void save(StateWriter &writer) const;
  void load(StateReader &reader);

private:
  struct Limits;
  /// A series of augmentations.
  struct Series;
  /// Of each contact: by how much it is farther from what its pair asks for than it may be, as `errors`; or
  /// softer than it may be, SoftnessLimit. At the trial state. Collective.
  struct Demands {
    std::vector<double> of_contacts;
    double by_tolerances = 0., largest = 0.; ///< of all
  };
  Demands find_demands(const std::vector<ContactSprings> &springs) const;
  /// Of each contact; of none if no pair limits softness. Collective.
  std::vector<ContactSprings> contact_springs() const;
  /// What an augmentation has changed of the forces of each contact. Collective.
  std::vector<std::array<SoftnessLimit::Change, 2>>
  changes_of(const std::vector<ContactSprings> &before, const std::vector<ContactSprings> &after) const;
  /// Makes the penalties of contacts stiffer whose errors, above 1, fell by little since `before`. `added` is
  /// what the last augmentation added to the normal force, as part of what springs held. Collective. Returns
  /// the factors, all 1 if none is.
  std::vector<double> stiffen_slow_contacts(const std::vector<double> &before,
                                            const std::vector<double> &errors,
                                            const std::vector<double> &added);
  /// Fails the step since augmentations do not come to what pairs ask for.
  void give_up(const Series &series, unsigned int n, double error, NewtonReport &report) const;
  /// Augments once and iterates; where that fails for softness alone, goes back. Returns whether to go on.
  bool augment_once(Series &series, const Demands &demands, bool is_of_softness, NewtonReport &report,
                    std::vector<double> &offsets, Vector &displacements);
  void learn(Series &series);

  ImplicitProblem &problem_;
  EquilibriumSolver &solver_;
  PenetrationMeasurement &measurement_;
  SoftnessLimit softness_;
  double penetration_allowed_ = 1.;
  bool may_leave_penetration_ = false;
};

} // namespace billet

#endif
