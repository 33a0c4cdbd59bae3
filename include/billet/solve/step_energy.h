// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_STEP_ENERGY_H
#define BILLET_SOLVE_STEP_ENERGY_H

#include "billet/solve/rejected_steps.h"

#include <vector>

namespace billet {

/// Judges static steps by the spurious work of contact, (A4). Steps out of energy balance are cut;
/// a step whose imbalance persists is a jump of the solution.
class StepEnergy {
public:
  /// Works of a step [energy].
  struct Works {
    /// Work of contact, less the energy that springs store and friction dissipates.
    double imbalance;
    double own;    ///< the larger of the absolute works of internal forces and of contact
    double before; ///< largest work of the run so far
  };
  enum class Verdict { balanced, rejected, jump };

  /// A step is rejected if its imbalance exceeds this part of all work, that of the step included,
  /// ...
  static constexpr double max_part = 0.15;
  /// ... and also this part of the step's own work.
  static constexpr double max_part_of_own = 0.4;
  /// Minimum work before the step, as part of the step's own, for a judgement. Below it bodies
  /// begin to touch, and there is no energy yet to be lost.
  static constexpr double min_before = 0.1;

  /// Returns the imbalance as part of all work, that of this step included; 0 without work.
  static double part_of_all(const Works &works);

  /// Judges a step from time `t_n`. `floor`: works below it count as zero.
  Verdict judge(double t_n, double length, const Works &works, double floor);

  std::vector<double> save() const { return rejected_.save(); }
  void load(const std::vector<double> &numbers) { rejected_.load(numbers); }

private:
  RejectedSteps rejected_;
};

} // namespace billet

#endif
