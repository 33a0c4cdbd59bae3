// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_PENETRATION_MEASUREMENT_H
#define BILLET_SOLVE_IMPLICIT_PENETRATION_MEASUREMENT_H

#include "billet/solve/implicit/implicit_problem.h"
#include "billet/solve/result_group.h"

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace billet {

/// What errors are parts of, each group by itself: the forces of the tools and of pairs of bodies, or,
/// without either or with pairs of a body with itself only, whose forces cancel out, the norm of the forces
/// of supports; then, of each tool that a force or a moment drives, which leave its own force no error, how
/// far that has taken it.
class StepResults {
public:
  using Groups = std::vector<ResultGroup>;

  explicit StepResults(const ImplicitProblem &problem) : problem_(problem) {}
  /// "forces", "travel of 'die'": of each group.
  std::vector<std::string> names() const;
  /// At the last accepted step, and at the trial state.
  Groups accepted() const;
  Groups of_trial() const;

private:
  bool has_forces_of_contacts() const;
  void add_travels(const std::vector<double> &offsets, Groups &results) const;

  const ImplicitProblem &problem_;
};

/// What penetrations make of the results at the end of a step.
struct OfPenetration {
  double penetration = 0.;           ///< the deepest, see ContactSet::find_penetration(), before augmentation
  StepResults::Groups with, without; ///< or empty: not found
  double residual = 0.;              ///< of `without`, as part of the forces
  unsigned int n_iterations = 0;     ///< that it took besides those of the step
};

/// Measures that where it is asked for. Where tractions are not augmented in the step anyway, one or a few
/// iterations more do it, and are taken back.
class PenetrationMeasurement {
public:
  explicit PenetrationMeasurement(ImplicitProblem &problem) : problem_(problem), results_(problem) {}

  /// The next step measures. If penetrations make more than this part of a result, that step already augments
  /// tractions until no more than that is left.
  void ask(const double allowed = std::numeric_limits<double>::infinity()) {
    is_wanted_ = true;
    allowed_ = allowed;
  }
  bool is_wanted() const { return is_wanted_; }
  /// What is tried next may be no step to measure in.
  void withdraw() { is_wanted_ = false; }
  /// Before an attempt of a step.
  void begin() { measured_.reset(); }
  bool has_begun() const { return measured_.has_value(); }
  /// Before the first augmentation of a step.
  void begin_with_augmentation();
  /// What was measured is of no use: the step ends otherwise.
  void spoil() { measured_ = OfPenetration(); }
  /// Completes what augmentations in the step have begun to measure, or makes it, from the state `accepted`
  /// of a step that has converged. Adds its iterations. `accuracy`: see EquilibriumSolver. Collective.
  void measure(const Vector &accepted, double accuracy, NewtonReport &report);
  /// Factor of what pairs ask for up to which penetrations are allowed, if they make too much; else 0.
  double find_allowed() const;
  /// Of the last accepted step; once.
  std::optional<OfPenetration> take() { return std::exchange(measured_, {}); }

private:
  struct Limits {
    static constexpr unsigned int max_iterations = 4;
    /// Part of the difference that residuals may be: it is known to some digits then.
    static constexpr double accuracy = 0.05;
    /// Part of penetrations that one augmentation leaves, at most: what is left goes on like that, as a
    /// geometric series.
    static constexpr double max_left = 0.8;
  };
  /// Augments once and iterates. Returns the part of the penetrations that is left; 0 if nothing was found.
  double augment_once(const Vector &accepted, double accuracy, NewtonReport &report);

  ImplicitProblem &problem_;
  StepResults results_;
  bool is_wanted_ = false;
  double allowed_ = 0.; ///< part of the forces
  std::optional<OfPenetration> measured_;
};

} // namespace billet

#endif
