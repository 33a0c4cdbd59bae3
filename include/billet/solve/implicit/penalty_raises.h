// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_PENALTY_RAISES_H
#define BILLET_SOLVE_IMPLICIT_PENALTY_RAISES_H

#include "billet/solve/implicit/implicit_problem.h"
#include "billet/solve/penalty_control.h"
#include "billet/solve/penalty_watch.h"

#include <functional>
#include <vector>

namespace billet {

/// Energies of contact springs and checks of their penetration.
class SpringBooks {
public:
  explicit SpringBooks(ImplicitProblem &problem);

  /// Sets the energy of a contact with a tool at the end of a step.
  void set(const std::size_t contact, const double energy) { of_tools_[contact] = energy; }
  /// Records a change of the energy in the springs of a contact [energy].
  void add(std::size_t contact, double change);
  /// Calls `change`, which changes penalties at the start of the step. What springs store more then
  /// counts as external work. Collective.
  void change_at_start(const std::function<void()> &change);
  /// Returns warnings about penalties that are too low, after a step. Collective.
  DiagnosticList check();
  /// Returns PenaltyWatch::has_low_penalties().
  bool has_low_penalties() const { return watch_.has_low_penalties(); }

  void save(StateWriter &writer) const { watch_.save(writer); }
  void load(const StateReader &reader) { watch_.load(reader); }

private:
  /// Returns the record of the energy in the springs of a contact.
  double &energy(std::size_t contact);
  void check_pair(const std::string &name, Penetration deepest, double moved, double stored_energy,
                  DiagnosticList &messages);

  ImplicitProblem &problem_;
  ImplicitParts &parts_ = problem_.parts();
  std::vector<double> of_tools_; ///< energy in the springs of each contact with a tool
  PenaltyWatch watch_;
};

/// Raises penalties of static steps with too large penetration; then the step is repeated.
class PenaltyRaises {
public:
  PenaltyRaises(ImplicitProblem &problem, SpringBooks &books) : problem_(problem), books_(books) {}

  /// Returns a failure if penetration is too large at the end of the step, which has to be repeated
  /// then. Collective.
  std::optional<StepFailure> judge();
  /// Raises the penalties at the start of the step. Compressed springs receive the energy that
  /// stiffer ones store, and start the step with their forces. Collective.
  DiagnosticList raise();

private:
  struct Limits {
    static constexpr double min_raise = 2., max_raise = 8.;
    /// Contact follows nodes to 0.4 of a facet, four times the penetration that default penalties
    /// allow. A penalty of the scene is kept up to this multiple of the allowed penetration.
    static constexpr double deep = 3.6;
    /// Part of the first step below which a step counts as short: it can hardly be cut further.
    static constexpr double short_step = 0.01;
  };
  /// Returns the factor by which the penalty of each contact should rise; 1 means unchanged.
  /// Collective.
  std::vector<double> find_factors() const;
  DiagnosticList describe() const;

  ImplicitProblem &problem_;
  ImplicitParts &parts_ = problem_.parts();
  SpringBooks &books_;
  std::vector<double> factors_; ///< result of the last judge()
};

/// Raises penalties of dynamic scenes after a step. The contacts are then in their accepted state,
/// so that a checkpoint contains the raised penalties.
class DynamicPenalties {
public:
  DynamicPenalties(ImplicitProblem &problem, SpringBooks &books)
      : problem_(problem), books_(books),
        control_(parts_.scene(), parts_.discretization(), PenaltyControl::in_implicit_scenes) {}

  /// `solution` is that of the step. Collective.
  DiagnosticList control(const Solution &solution);

  void save(StateWriter &writer) const { control_.save(writer); }
  void load(const StateReader &reader) { control_.load(reader); }

private:
  ImplicitProblem &problem_;
  ImplicitParts &parts_ = problem_.parts();
  SpringBooks &books_;
  PenaltyControl control_;
};

} // namespace billet

#endif
