// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_FORCE_CHOICE_H
#define BILLET_OUTPUT_FORCE_CHOICE_H

#include <cstddef>
#include <vector>

namespace billet {

/// Chooses the loads that a table has room for: those that were largest so far, and none without a
/// force. A couple counts by its moment.
class ForceChoice {
public:
  /// Sizes of the force [force] and of the moment [force length] of a load.
  struct Load {
    double force = 0., moment = 0.;
  };
  /// Load that is shown.
  struct Shown {
    std::size_t load;
    bool is_moment; ///< else the force is shown

    bool operator==(const Shown &other) const { return load == other.load && is_moment == other.is_moment; }
  };

  /// Shows the first loads until there are forces. `lever`: size of the model, by which moments are
  /// compared with forces [length].
  ForceChoice(std::size_t n_loads, std::size_t max_shown, double lever);

  /// Takes the loads of a step. Returns whether the choice changes.
  bool update(const std::vector<Load> &loads);
  /// Returns what is shown, in the order of the loads.
  const std::vector<Shown> &shown() const { return shown_; }

private:
  bool is_moment(std::size_t load) const;
  /// Returns the maximum so far, as a force.
  double size(std::size_t load) const;

  double lever_;
  std::size_t max_shown_;
  std::vector<Load> max_;
  std::vector<Shown> shown_;
};

} // namespace billet

#endif
