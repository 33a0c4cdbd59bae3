// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_TOOL_FRICTION_H
#define BILLET_CONTACT_TOOL_FRICTION_H

#include "billet/contact/edge_fading.h"
#include "billet/contact/friction_history.h"
#include "billet/contact/pressure_record.h"
#include "billet/usage.h"

#include <array>
#include <vector>

namespace billet {

/// Friction of nodes on a tool. It has the histories, the tractions by return map in a contact
/// frame that each node carries along, and the account of their works. Exists only with friction.
class ToolFriction {
public:
  /// History of a node.
  struct History : FrictionHistory {
    dealii::Tensor<1, 3> tool_position; ///< of the slave node, in the tool's coordinates
  };

  /// `stores` is whether springs store energy, see FrictionRule. The references must outlive this
  /// object.
  ToolFriction(const FrictionLaw &law, bool stores, std::size_t n_nodes, const ToolStep &step,
               const PressureRecord &pressures);

  /// Sets how works are counted: with ½, and those of a motion, by default.
  void set_account(const double start_weight, const FrictionAccounting &accounting) {
    start_weight_ = start_weight;
    accounting_ = &accounting;
  }
  const FrictionAccounting &accounting() const { return *accounting_; }

  /// Returns the history at the end of the step.
  History &operator[](const std::size_t i) { return now_[i]; }
  const History &operator[](const std::size_t i) const { return now_[i]; }

  /// Computes traction and tangent of node i, which touches the tool, and its history. `fading` is
  /// null except beyond the edge of the surface. `is_exact` is whether the kind of tangents is
  /// ContactTangent::exact.
  template <bool is_exact>
  void press(std::size_t i, const ContactPoint &node, const FrictionTangent &kind, const EdgeFading *fading,
             ToolContactState &state, History &history) const;
  /// Releases node i, which does not touch the tool; `normal` is that of the surface, in the tool's
  /// coordinates.
  void release(std::size_t i, const ContactPoint &node, const dealii::Tensor<1, 3> &normal,
               ToolContactState &state, History &history) const;

  /// Returns the elastic slip of a sticking node in this step, or since its last augmentation
  /// [length].
  double elastic_slip(std::size_t i, const ContactPoint &node, const ToolContactState &state) const;

  /// Makes the current tractions of nodes that touched at the start of the step the initial ones.
  void augment(const std::vector<ContactPoint> &nodes);
  /// Undoes the augmentations of this step.
  void restart() { base_.clear(); }
  void commit() {
    base_.clear();
    n_ = now_;
  }
  /// Clears the history of all nodes.
  void clear();
  /// Starts the history of a node at this position on the tool; commit() must follow.
  void start(std::size_t i, const dealii::Tensor<1, 3> &on_tool);

  /// Returns the size of the histories [bytes].
  std::size_t size() const { return 2 * now_.size() * sizeof(History); }
  std::size_t n_nodes() const { return now_.size(); }

  /// Saves the state at the start of the step.
  void save(StateWriter &writer, const SlaveSurface::Range &range) const;
  /// Loads the state as that of the end of a step; commit() must follow.
  void load(const StateReader &reader, const SlaveSurface::Range &range);

private:
  FrictionRule rule_of(const ContactPoint &node) const {
    return {node.stiffness.tangential, start_weight_, accounting_, stores_, stores_};
  }

  const FrictionLaw &law_;
  const bool stores_;
  const ToolStep &step_;
  const PressureRecord &pressures_;
  std::vector<History> n_, now_; ///< at the start of the step, and at its end
  /// Augmented initial tractions of this step; empty: those of n_.
  std::vector<std::array<double, 2>> base_;
  double start_weight_ = 0.5;
  const FrictionAccounting *accounting_ = &FrictionAccounting::of_motion;
  HeldMemory memory_{Capability::friction};
};

} // namespace billet

#endif
