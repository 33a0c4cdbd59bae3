// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_STEP_ENERGY_H
#define BILLET_SOLVE_STEP_ENERGY_H

namespace billet {

/// Judges static steps by the work that contact does from nowhere, (Q4). Steps out of balance are cut; one
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

  /// An imbalance above this part both of the step's own work and of all work is rejected.
  static constexpr double max_part = 0.25;
  /// An imbalance that cuts to this part of the first rejected step leave as it is belongs to the solution.
  static constexpr double least_cut = 1. / 32.;

  /// Part of all work, that of this step included; 0 without work.
  static double part_of_all(const Works &works);

  /// `floor`: works below that count as none. Of a step from time `t_n`.
  Verdict judge(double t_n, double length, const Works &works, double floor);

private:
  double rejected_at_ = -1., first_length_ = 0.;
};

} // namespace billet

#endif
