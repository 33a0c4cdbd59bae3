// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_STEP_ENERGY_H
#define BILLET_SOLVE_STEP_ENERGY_H

#include <vector>

namespace billet {

/// Judges static steps by the work that contact does from nowhere, (A4). Steps out of balance are cut; one
/// that stays so is a jump of the solution.
class StepEnergy {
public:
  /// Of a step [energy].
  struct Works {
    double imbalance; ///< what contact takes, less what its springs store and friction dissipates
    double own;       ///< the larger of the absolute works of internal forces and of contact
    double before;    ///< largest work of the run so far
  };
  enum class Verdict { balanced, rejected, jump };

  /// An imbalance above this part of all work, that of the step included, is rejected, ...
  static constexpr double max_part = 0.15;
  /// ... if it is also above this part of the step's own.
  static constexpr double max_part_of_own = 0.4;
  /// Where there was less work before, as a part of the step's own, nothing is judged: bodies begin to touch,
  /// and there is nothing yet that could be lost.
  static constexpr double min_before = 0.1;
  /// An imbalance that cuts to this part of a rejected step leave as it is, anywhere within that step,
  /// belongs to the solution.
  static constexpr double least_cut = 1. / 32.;

  /// Part of all work, that of this step included; 0 without work.
  static double part_of_all(const Works &works);

  /// `floor`: works below that count as none. Of a step from time `t_n`.
  Verdict judge(double t_n, double length, const Works &works, double floor);

  std::vector<double> save() const { return {rejected_until_, first_length_}; }
  void load(const std::vector<double> &numbers) {
    rejected_until_ = numbers.at(0);
    first_length_ = numbers.at(1);
  }

private:
  double rejected_until_ = -1., first_length_ = 0.; ///< end of the first rejected step, and its length
};

} // namespace billet

#endif
