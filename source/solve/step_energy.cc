// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/step_energy.h"

#include <cmath>

namespace billet {

double StepEnergy::part_of_all(const Works &works) {
  const double all = works.before + works.own;
  return all > 0. ? std::abs(works.imbalance) / all : 0.;
}

StepEnergy::Verdict StepEnergy::judge(const double t_n, const double length, const Works &works,
                                      const double floor) {
  if (!(works.before + works.own > floor) || works.before < min_before * works.own ||
      !(std::abs(works.imbalance) > max_part_of_own * works.own) || !(part_of_all(works) > max_part))
    return Verdict::balanced;
  return rejected_.add(t_n, length) ? Verdict::jump : Verdict::rejected;
}

} // namespace billet
