// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_SOFTNESS_LIMIT_H
#define BILLET_SOLVE_SOFTNESS_LIMIT_H

#include "billet/contact/contact_load.h"

#include <array>
#include <cstddef>
#include <vector>

namespace billet {

/// Estimate of the part by which contact springs reduce the contact force, for pairs that limit it.
/// It follows from the change by the last augmentation; (L7) of doc/theory.md.
class SoftnessLimit {
public:
  /// Limit of a pair: none, one of both directions, or, for sheets, one of the normal direction
  /// alone.
  enum class Rule { none, general, sheet };
  explicit SoftnessLimit(const std::vector<Rule> &rules);

  /// Whether any pair limits its softness.
  bool is_used() const;

  /// Changes what limits each pair, as a penalty that has changed demands.
  void set_rules(const std::vector<Rule> &rules);
  /// Forgets what augmentations have shown of a pair, whose penalty has become another one.
  void forget(std::size_t pair) { pairs_[pair].normal.counts = pairs_[pair].tangential.counts = 1.; }
  /// Begins after Newton's method has converged in a step, before any augmentation.
  void begin();
  /// Returns, for each pair, the missing part of its forces over the allowed part; 0 for pairs
  /// without a limit. `springs` are summed over all ranks. `resolved`: part of the normal force up
  /// to which missing friction does not count, since iterations do not resolve it.
  std::vector<double> excess(const std::vector<ContactSprings> &springs, double resolved = 0.) const;
  /// Change of a pair's force by an augmentation, in normal or tangential direction, once all pairs
  /// have been augmented and are in equilibrium again.
  struct Change {
    double of_nodes = 0., in_all = 0.; ///< Σ |ΔF|; the largest of |Σ ΔF| and |Δ Σ |F|| [force]
  };
  void learn(const std::vector<ContactSprings> &before, const std::vector<std::array<Change, 2>> &changes);
  /// Accepts a step with these springs; they are empty if no pair limits softness. `resolved` as in
  /// excess().
  void commit(const std::vector<ContactSprings> &springs, double resolved = 0.);
  /// Returns the largest change of each pair's normal force by the last augmentation of a step that
  /// ended above the limit, over the largest force. It is 0 if all steps reached the limit.
  std::vector<double> unsettled() const;

  // For checkpoints:
  std::vector<double> save() const;
  void load(const std::vector<double> &numbers);

private:
  struct Direction {
    /// Change of the force by an augmentation, over the force that springs hold.
    double counts = 1.;
    /// Change of the force by the last augmentation of the step; of sheets, by all that would
    /// follow [force]
    double changed = 0.;

    double missing(const ContactSprings::Direction &springs, double force) const;
    void learn(const ContactSprings::Direction &before, const Change &change, Rule rule);
  };
  struct Pair {
    Rule rule = Rule::none;
    Direction normal, tangential;
    /// Missing friction by the slip of all steps so far [force].
    double let_in = 0.;
    double max_force = 0., unsettled = 0.; ///< over the run [force]
  };

  std::vector<Pair> pairs_;
};

} // namespace billet

#endif
