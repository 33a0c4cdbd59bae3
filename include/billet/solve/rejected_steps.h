// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_REJECTED_STEPS_H
#define BILLET_SOLVE_REJECTED_STEPS_H

#include <vector>

namespace billet {

/// Steps that were rejected for one reason. If it remains in much shorter steps, anywhere within
/// the first rejected one, it belongs to the solution: no step is short enough.
class RejectedSteps {
public:
  /// Length, as part of the first rejected step, down to which steps are cut.
  static constexpr double min_cut = 1. / 32.;

  /// Adds a rejected step from time `t_n`. Returns whether it is that short.
  bool add(const double t_n, const double length) {
    if (t_n >= until_ - rounding * first_length_) {
      until_ = t_n + length;
      first_length_ = length;
    }
    return length <= min_cut * first_length_ * (1. + rounding);
  }

  std::vector<double> save() const { return {until_, first_length_}; }
  void load(const std::vector<double> &numbers) {
    until_ = numbers.at(0);
    first_length_ = numbers.at(1);
  }

private:
  /// Tolerance of times and lengths, as part of the first rejected step.
  static constexpr double rounding = 1e-6;

  double until_ = -1., first_length_ = 0.; ///< end of the first rejected step, and its length
};

} // namespace billet

#endif
