// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_AUGMENTATION_H
#define BILLET_SOLVE_IMPLICIT_AUGMENTATION_H

#include "billet/solve/implicit/equilibrium_solver.h"
#include "billet/solve/implicit/penetration_measurement.h"
#include "billet/solve/softness_limit.h"

#include <array>
#include <limits>
#include <vector>

namespace billet {

class SpringBooks;

/// Augmented Lagrangian method for contacts: tractions are augmented and iterated anew until all
/// pairs meet their 'Penetration tolerance' or their limit of softness.
class Augmentation {
public:
  Augmentation(ImplicitProblem &problem, EquilibriumSolver &solver, PenetrationMeasurement &measurement);

  /// Augments from the state of `report`, to which it appends. Collective.
  void augment(NewtonReport &report, std::vector<double> &offsets, Vector &displacements);

  /// Sets the factor of the pairs' tolerances above which tractions are augmented.
  void allow_penetration(const double factor) { penetration_allowed_ = factor; }
  /// Accepts steps whose remaining penetration exceeds the tolerance: it counts as an error to be
  /// reported.
  void may_leave_penetration() { may_leave_penetration_ = true; }
  /// Reduces the penalties of augmented contacts that exceed 10 E/h to that value after a failure,
  /// with a message on each. If none does, those of sheets fall to (T13), unless the iterations
  /// were merely slow. Returns false if there is none. Collective.
  bool soften_contacts(const NewtonReport &failed, SpringBooks &books, DiagnosticList &messages);
  /// Reduces the penalties of sheets to (T13), before a step. Those of stacks fall before the first
  /// one, others if nodes have been restless in two steps so far. Adds a message on each pair.
  /// Collective.
  void soften_sheets(SpringBooks &books, DiagnosticList &messages);

  /// Returns the state of the softness estimate, which a probe restores.
  const SoftnessLimit &softness() const { return softness_; }
  void set_softness(const SoftnessLimit &softness) { softness_ = softness; }
  /// Accepts the step. Collective.
  void commit();
  /// Returns messages at the end about pairs whose augmentation ended while it still changed
  /// forces.
  DiagnosticList finish() const;

  void save(StateWriter &writer) const;
  void load(StateReader &reader);

private:
  struct Limits;
  /// Series of augmentations.
  struct Series;
  /// Errors that demand an augmentation where they are above 1.
  struct Demands {
    /// Error of the augmentation of each contact over its tolerance, or its softness over the limit
    /// of SoftnessLimit if that is larger.
    std::vector<double> of_contacts;
    double by_tolerances = 0., maximum = 0.; ///< over all contacts
  };
  /// Returns the demands at the trial state after n augmentations. Collective.
  Demands find_demands(const std::vector<ContactSprings> &springs, unsigned int n) const;
  /// Whether nodes are restless in the iterations so far, by contact; false but of sheets.
  /// Collective.
  std::vector<bool> restless_sheets() const;
  /// Whether contacts are those of sheets that other bodies may touch, too: springs between bodies
  /// are soft beside the compression of a sheet.
  std::vector<bool> stacked_sheets() const;
  /// Penalty to which one is reduced at most [E/h], and whether nodes keep their tractions at the
  /// start of the step. By default it is not reduced.
  struct Fall {
    double to = std::numeric_limits<double>::max();
    bool keeps_tractions = false;
  };
  /// Reduces penalties by whole octaves, with a message on each, and the reason in it. Returns
  /// whether there is any. Collective.
  bool lower_penalties(const std::vector<Fall> &falls, const std::string &reason, SpringBooks &books,
                       DiagnosticList &messages);
  /// Does the same for the contacts chosen, all of sheets: takes back a raise by augmentation, or
  /// reduces to (T13) if there is none.
  void lower_sheets(const std::vector<bool> &chosen, const std::string &reason, SpringBooks &books,
                    DiagnosticList &messages);
  /// Returns the rules by which contacts limit their softness now.
  static std::vector<SoftnessLimit::Rule> softness_rules(const ContactSet &contacts);
  /// Returns the springs of each contact; empty if no pair limits softness. Collective.
  std::vector<ContactSprings> contact_springs() const;
  /// Returns the changes of the forces of each contact by an augmentation. Collective.
  std::vector<std::array<SoftnessLimit::Change, 2>>
  changes_of(const std::vector<ContactSprings> &before, const std::vector<ContactSprings> &after) const;
  /// Whether augmentation may raise the penalty of this contact above `enough_penalty`. Once a
  /// sheet's has fallen again, it would only rise and fall in turn.
  bool may_be_raised(std::size_t contact) const;
  void bound_penalty(std::size_t contact);
  /// Raises the penalties of contacts whose errors are above 1 and fell little in the last
  /// augmentation. Returns the factors, all 1 if none is raised. Collective.
  std::vector<double> stiffen_slow_contacts(const std::vector<double> &errors, const Series &series);
  /// Fails the step because augmentation does not converge to the pairs' tolerances. Names the pair
  /// that is farthest from its own.
  void give_up(const Series &series, unsigned int n, const Demands &demands, NewtonReport &report) const;
  /// Augments once and iterates. If that fails and only softness required it, restores the former
  /// state. Returns whether to continue.
  bool augment_once(Series &series, const Demands &demands, bool is_of_softness, NewtonReport &report,
                    std::vector<double> &offsets, Vector &displacements);
  /// Restores the state before augmentations for softness, and its penalties.
  void restore_soft_state(Series &series, NewtonReport &report, std::vector<double> &offsets,
                          Vector &displacements);
  void learn(Series &series);
  /// Appends a note on each pair whose penalty augmentation has made very stiff, once. Collective.
  void note_stiff_contacts(const Series &series, DiagnosticList &messages);

  ImplicitProblem &problem_;
  ImplicitParts &parts_ = problem_.parts();
  EquilibriumSolver &solver_;
  PenetrationMeasurement &measurement_;
  SoftnessLimit softness_;
  double penetration_allowed_ = 1.;
  bool may_leave_penetration_ = false;
  bool has_failed_ = false;            ///< for softness, in some step
  std::vector<bool> is_noted_;         ///< contacts of note_stiff_contacts()
  bool has_sheets_;                    ///< whether a contact is that of a sheet; so on all ranks
  std::vector<double> restless_steps_; ///< number of steps with restless nodes, of sheets
  std::vector<double> bounded_;        ///< 1 for sheets that may_be_raised() no more; may be empty
};

} // namespace billet

#endif
