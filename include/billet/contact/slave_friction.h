// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_SLAVE_FRICTION_H
#define BILLET_CONTACT_SLAVE_FRICTION_H

#include "billet/contact/touching_slaves.h"
#include "billet/state.h"
#include "billet/usage.h"

#include <vector>

namespace billet {

/// Works of friction at one slave in the step, this rank's part [energy].
struct FrictionWorks {
  double dissipation = 0., damping = 0., taken_beyond = 0., missed = 0.;
  double dissipation_handed_over = 0.; ///< `dissipation` by FrictionAccount::handed_over()
};

/// Friction history and works of slave nodes. Exists only with friction.
class SlaveFriction {
public:
  /// All arguments must outlive this object.
  SlaveFriction(const FrictionLaw &law, const TouchingSlaves &slaves, const SlavePenalties &penalties,
                const GapOffsets &offsets, const SlaveStart &start);

  /// Sets how works are counted: with ½, and those of a motion, by default.
  void set_account(const double start_weight, const FrictionAccounting &accounting) {
    start_weight_ = start_weight;
    accounting_ = &accounting;
  }
  const FrictionAccounting &accounting() const { return *accounting_; }
  const FrictionLaw &law() const { return law_; }

  /// Computes traction and works of a slave that presses.
  SlaveTraction press(const std::size_t s) {
    const SlaveState &state = slaves_[s];
    const SlaveMotion motion = slaves_.motion_of(s);
    const SlaveTraction traction = compute_slave_traction(law_, penalties_[s], state.contact.normal,
                                                          state.contact.gap, motion, base_[s], history_[s]);
    history_[s].area = state.area;
    account_for(s, traction, motion);
    return traction;
  }
  /// Releases a slave that does not press.
  void release(std::size_t s);

  const FrictionWorks &works(const std::size_t s) const { return works_[s]; }
  /// Returns the length of the slip path [length].
  double slip(const std::size_t s) const { return history_[s].slip; }
  /// Returns the initial state of this step's traction: that at its start, or augmented.
  const SlaveHistory &base(const std::size_t s) const { return base_[s]; }
  /// Returns the elastic slip of a sticking slave in this step, or since its last augmentation
  /// [length].
  double elastic_slip(std::size_t s) const;

  /// Makes the current tractions of slaves that press the initial ones.
  void augment();
  /// Undoes the augmentations of this step.
  void restart() { base_ = history_n_; }
  void commit() { base_ = history_n_ = history_; }

  /// Saves the state at the start of the step, under the keys of the slaves.
  void save(StateWriter &writer, const std::vector<std::uint64_t> &keys) const;
  void load(const StateReader &reader, const std::vector<std::uint64_t> &keys);

private:
  /// Records the works of friction. For a node that several ranks have, each rank takes the part of
  /// its facets.
  void account_for(std::size_t s, const SlaveTraction &traction, const SlaveMotion &motion);
  /// Whether the slave touched at the start of the step. If it came in within the step, its
  /// friction is not augmented.
  bool was_touching(std::size_t s) const;
  void augment_one(std::size_t s);

  const FrictionLaw &law_;
  const TouchingSlaves &slaves_;
  const SlavePenalties &penalties_;
  const GapOffsets &offsets_;
  const SlaveStart &start_;
  std::vector<SlaveHistory> history_n_, history_, base_;
  std::vector<FrictionWorks> works_;
  double start_weight_ = 0.5;
  const FrictionAccounting *accounting_ = &FrictionAccounting::of_motion;
  HeldMemory memory_{Capability::friction};
};

} // namespace billet

#endif
