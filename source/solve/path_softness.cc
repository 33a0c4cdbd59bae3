// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/path_softness.h"

namespace billet {

void PathSoftness::add(const double time, const double penetration, const double deformation,
                       const double all_energy) {
  const Sample now = {time, penetration, deformation, all_energy};
  if (last_.penetration > 0. || penetration > 0.) {
    const double half = 0.5 * (time - last_.time);
    penetration_ += half * (last_.penetration + penetration);
    deformation_ += half * (last_.deformation + deformation);
    all_ += half * (last_.all + all_energy);
  }
  last_ = now;
}

double PathSoftness::part(const double counts) const {
  const double sum = penetration_ + deformation_;
  return sum > 0. && penetration_ > counts * all_ ? penetration_ / sum : 0.;
}

void PathSoftness::save(std::vector<double> &numbers) const {
  numbers.insert(numbers.end(), {last_.time, last_.penetration, last_.deformation, last_.all, penetration_,
                                 deformation_, all_});
}

void PathSoftness::load(const double *numbers) {
  last_ = {numbers[0], numbers[1], numbers[2], numbers[3]};
  penetration_ = numbers[4];
  deformation_ = numbers[5];
  all_ = numbers[6];
}

} // namespace billet
