// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_SOFTNESS_LIMIT_H
#define BILLET_SOLVE_SOFTNESS_LIMIT_H

#include "billet/contact/contact_load.h"

#include <array>
#include <cstddef>
#include <vector>

namespace billet {

/// By how much the springs of contact make its forces smaller, of pairs that limit that: estimated from what
/// the last augmentation has changed; (L7) of doc/theory.md.
class SoftnessLimit {
public:
  /// `limits`: of each pair, whether it does.
  explicit SoftnessLimit(const std::vector<bool> &limits);

  /// Whether any pair limits it.
  bool is_used() const;

  /// Newton's method has converged in a step, and nothing has been augmented in it.
  void begin();
  /// Of each pair, with these springs on all ranks: what is missing of its forces, as part of what is
  /// allowed; 0 of pairs that do not limit it.
  std::vector<double> excess(const std::vector<ContactSprings> &springs) const;
  /// All pairs have been augmented, once, and are in equilibrium again. `changes`: of each pair, in normal
  /// and tangential direction.
  struct Change {
    double of_nodes = 0., in_all = 0.; ///< Σ |ΔF|; the largest of |Σ ΔF| and |Δ Σ |F|| [force]
  };
  void learn(const std::vector<ContactSprings> &before, const std::vector<std::array<Change, 2>> &changes);
  /// The step has ended with these, or with none where no pair limits softness.
  void commit(const std::vector<ContactSprings> &springs);
  /// Of each pair: what the last augmentation still changed of its normal force in a step that ended before
  /// the limit was reached, largest, over the largest force; 0 if all steps reached it.
  std::vector<double> unsettled() const;

  // For checkpoints:
  std::vector<double> save() const;
  void load(const std::vector<double> &numbers);

private:
  struct Direction {
    double counts = 1.;  ///< the part of what springs hold by which forces change if that is augmented
    double changed = 0.; ///< by which the last augmentation of the step changed the force [force]

    double missing(const ContactSprings::Direction &springs, double force) const;
    void learn(const ContactSprings::Direction &before, const Change &change);
  };
  struct Pair {
    bool limits = false;
    Direction normal, tangential;
    double let_in = 0.;                        ///< of friction, by the slip that steps have left [force]
    double largest_force = 0., unsettled = 0.; ///< over the run [force]
  };

  std::vector<Pair> pairs_;
};

} // namespace billet

#endif
