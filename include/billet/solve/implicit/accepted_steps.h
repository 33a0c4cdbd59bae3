// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_ACCEPTED_STEPS_H
#define BILLET_SOLVE_IMPLICIT_ACCEPTED_STEPS_H

#include "billet/solve/implicit/implicit_reactions.h"
#include "billet/solve/implicit/step_diagnosis.h"
#include "billet/solve/implicit/step_rules.h"

#include <vector>

namespace billet {

/// A step whose trial state is accepted. Nothing here changes before all of its works are recorded.
struct AcceptedStep {
  double start_time, end_time; ///< [time]
  const ForceState &start, &trial;
  const Vector &increment;             ///< of displacements
  double contact_at_start;             ///< ContactWeights::at_start()
  StepWorks of_contact;                ///< over all ranks
  std::vector<ContactLoad> tool_loads; ///< at the start
  std::vector<Placement> placements;   ///< of tools, at the start

  /// Returns the mean over the step of a value of contact.
  template <class T> T mean_of_contact(const T &at_start, const T &at_end) const {
    return (1. - contact_at_start) * at_end + contact_at_start * at_start;
  }
};

/// Records the works, energies and loads of accepted steps, and makes their ends the starts of the
/// next ones.
class AcceptedSteps {
public:
  /// Components that record a step, too. They must outlive this object.
  struct Parts {
    ImplicitProblem &problem;
    StepRules &rules;
    SpringBooks &books;
    StepDiagnosis &diagnosis;
    ImplicitReactions &reactions;
  };
  explicit AcceptedSteps(const Parts &parts) : p_(parts) {}

  /// Accepts the trial state at time t. Collective.
  void commit(double t);

private:
  AcceptedStep describe(double t) const;
  /// Adds the works of supports, loads and released forces, and commits what carries them.
  void add_works(const AcceptedStep &step);
  /// Sets the loads of contact, and adds what it has dissipated.
  void set_contact_loads(const AcceptedStep &step);
  /// Moves the tools to the end of the step, and adds their works.
  void move_tools(const AcceptedStep &step);
  /// Makes the trial state the start of the next step.
  void advance(const AcceptedStep &step);

  Parts p_;
  ImplicitParts &parts_ = p_.problem.parts();
};

} // namespace billet

#endif
