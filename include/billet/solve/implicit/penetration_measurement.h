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

/// Groups of results whose errors are estimated. The first contains the forces of the tools and of
/// pairs of bodies. If there are none, or only pairs of a body with itself, whose forces cancel
/// out, it is the norm of the support forces. For each driven tool, whose own force has no error, a
/// further group contains its travel.
class StepResults {
public:
  using Groups = std::vector<ResultGroup>;

  explicit StepResults(const ImplicitProblem &problem) : problem_(problem) {}
  /// Returns the name of each group: "forces", "travel of 'die'".
  std::vector<std::string> names() const;
  /// Return the groups at the last accepted step, and at the trial state.
  Groups accepted() const;
  Groups of_trial() const;
  /// Returns the size that each group counts with at least, by the last accepted state. That of a
  /// travel is the travel by which the tool's load does the work of all loads so far
  /// (doc/theory.md, W3). An error of the travel changes the other forces by a part of them that is
  /// no larger than the error over this size.
  ///
  /// The size is at most the scene's radius, for loads near zero.
  std::vector<double> min_sizes() const;

private:
  bool has_forces_of_contacts() const;
  void add_travels(const std::vector<double> &offsets, Groups &results) const;

  const ImplicitProblem &problem_;
  const ImplicitParts &parts_ = problem_.parts();
};

/// Effect of penetration on the results at the end of a step.
struct OfPenetration {
  /// Largest penetration before augmentation, see ContactSet::find_penetration().
  double penetration = 0.;
  StepResults::Groups with, without; ///< empty: not found
  double residual = 0.;              ///< of `without`, as part of the forces
  unsigned int n_iterations = 0;     ///< beside those of the step
};

/// Measures the effect of penetration on request. If tractions are not augmented in the step
/// anyway, one or a few additional iterations are made and taken back.
class PenetrationMeasurement {
public:
  explicit PenetrationMeasurement(ImplicitProblem &problem) : problem_(problem), results_(problem) {}

  /// Makes the next step measure. If penetration changes a result by more than this part, that step
  /// augments tractions until no more than that is left.
  void ask(const double allowed = std::numeric_limits<double>::infinity()) {
    is_wanted_ = true;
    allowed_ = allowed;
  }
  bool is_wanted() const { return is_wanted_; }
  /// Withdraws the request: the next attempt may be unsuitable.
  void withdraw() { is_wanted_ = false; }
  /// Begins an attempt of a step.
  void begin() { measured_.reset(); }
  bool has_begun() const { return measured_.has_value(); }
  /// Begins the measurement before the first augmentation of a step.
  void begin_with_augmentation();
  /// Discards the measurement, because the state of the step has changed since.
  void spoil() { measured_ = OfPenetration(); }
  /// Completes the measurement by the step's augmentations, or makes one from the converged state
  /// `accepted`. Appends its iterations to the report. `accuracy`: see EquilibriumSolver.
  /// Collective.
  void measure(const Vector &accepted, double accuracy, NewtonReport &report);
  /// Returns the factor of the pairs' tolerances up to which penetration is allowed, if its effect
  /// is too large; else 0.
  double find_allowed() const;
  /// Returns the measurement of the last accepted step; once.
  std::optional<OfPenetration> take() { return std::exchange(measured_, {}); }

private:
  struct Limits {
    static constexpr unsigned int max_iterations = 4;
    /// Maximum residual as part of the difference, so that some digits of it are known.
    static constexpr double accuracy = 0.05;
    /// Maximum part of penetration that one augmentation leaves; the rest is extrapolated as a
    /// geometric series.
    static constexpr double max_left = 0.8;
  };
  /// Augments once and iterates. Returns the remaining part of the penetration; 0 if nothing was
  /// found.
  double augment_once(const Vector &accepted, double accuracy, NewtonReport &report);

  ImplicitProblem &problem_;
  ImplicitParts &parts_ = problem_.parts();
  StepResults results_;
  bool is_wanted_ = false;
  double allowed_ = 0.; ///< part of the forces
  std::optional<OfPenetration> measured_;
};

} // namespace billet

#endif
