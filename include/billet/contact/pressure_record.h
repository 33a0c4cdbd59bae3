// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_PRESSURE_RECORD_H
#define BILLET_CONTACT_PRESSURE_RECORD_H

#include "billet/contact/tool_contact_state.h"
#include "billet/contact/tool_step.h"

#include <vector>

namespace billet {

/// Pressures of nodes on a tool at the start of the step, for the works of the step.
class PressureRecord {
public:
  /// State of a node, in the tool's coordinates.
  struct Entry {
    double pressure = 0.;    ///< [stress]
    double penetration = 0.; ///< [length]
    dealii::Tensor<1, 3> normal, position;
  };

  /// Whether the entries are those of the start of the step; the same on all ranks.
  bool is_known() const { return is_known_; }
  const Entry &operator[](const std::size_t i) const { return entries_[i]; }
  /// Whether it is known that a node of this rank pressed.
  bool has_pressure() const;

  /// Records the states at the end of a step, with the tool where the step has placed it.
  void record(const std::vector<ToolContactState> &states, const std::vector<ContactPoint> &nodes,
              const Placement &placement);
  /// Divides the depth of a node whose penalty was multiplied by `factor` at the same pressure.
  void divide_penetration(const std::size_t i, const double factor) {
    if (is_known_)
      entries_[i].penetration /= factor;
  }

  void save(StateWriter &writer, const SlaveSurface::Range &range) const;
  /// Loads entries of a state that contains them.
  void load(const StateReader &reader, const SlaveSurface::Range &range);
  /// Sets whether load() follows.
  void set_known(const bool is_known) { is_known_ = is_known; }

private:
  std::vector<Entry> entries_;
  bool is_known_ = false;
};

/// Returns the penetration of a node that presses, otherwise 0 [length]. Multipliers are no
/// penetration.
inline double pressed_depth(const ToolContactState &state, const ContactPoint &node) {
  return state.pressure > 0. ? std::max(0., -(state.gap + node.multiplier_offset)) : 0.;
}

} // namespace billet

#endif
