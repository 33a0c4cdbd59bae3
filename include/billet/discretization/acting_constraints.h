// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DISCRETIZATION_ACTING_CONSTRAINTS_H
#define BILLET_DISCRETIZATION_ACTING_CONSTRAINTS_H

#include "billet/scene/scene.h"

#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <vector>

namespace billet {

/// Chooses constraints.
using ConstraintFilter = std::function<bool(const Constraint &)>;

/// Chooses those that hold in a step that starts at t, as SupportTimes::acts_after() says.
inline ConstraintFilter holding_after(const double t) {
  return [t](const Constraint &constraint) { return constraint.times.acts_after(t); };
}
/// Chooses those that hold at t, as SupportTimes::acts_at() says.
inline ConstraintFilter holding_at(const double t) {
  return [t](const Constraint &constraint) { return constraint.times.acts_at(t); };
}

/// Supports and symmetry planes that hold nodes now. It changes between steps only, on all ranks
/// alike.
class ActingConstraints {
public:
  /// Begins with those that `acts` chooses.
  ActingConstraints(const Scene &scene, const ConstraintFilter &acts);

  bool operator()(const Constraint &constraint) const { return resting_.count(&constraint) == 0; }
  /// Returns how often they have changed.
  unsigned int n_changes() const { return n_changes_; }

  /// Whether supports of the scene begin or end within the run.
  bool may_change() const { return may_change_; }
  /// Whether `acts` chooses others than act now.
  bool differ(const ConstraintFilter &acts) const;
  /// Returns the times over which forces fade, in ascending order, of those that act and that
  /// `acts` omits.
  std::vector<double> fade_times(const ConstraintFilter &acts) const;
  /// Lets those of them go whose forces fade over this time.
  void release(const ConstraintFilter &acts, double fade_time);
  /// Adds those that `acts` chooses. Returns the times later than 0 at which those begin that did
  /// not act.
  std::set<double> take(const ConstraintFilter &acts);
  /// Makes those act that `acts` chooses, as by release() and take().
  void change_to(const ConstraintFilter &acts);
  /// Forgets the states of times at which none of those began that act.
  template <class State> void forget_ended(std::map<double, State> &starts) const {
    const std::set<double> left = late_beginnings();
    for (auto start = starts.begin(); start != starts.end();)
      start = left.count(start->first) > 0 ? std::next(start) : starts.erase(start);
  }

private:
  std::set<double> late_beginnings() const;
  template <class Visit> void visit(const Visit &visit) const {
    for (const Body &body : scene_.bodies())
      for (const Constraint &constraint : body.constraints)
        visit(constraint);
  }

  const Scene &scene_;
  std::set<const Constraint *> resting_; ///< those that do not act
  bool may_change_ = false;
  unsigned int n_changes_ = 0;
};

/// Returns the times later than 0 at which supports of this choice begin.
std::set<double> late_beginnings(const Scene &scene, const ConstraintFilter &acts);

} // namespace billet

#endif
