// SPDX-License-Identifier: LGPL-2.1-or-later
// Areas on which the springs of deep nodes stand: the area that counts for the traction is what the energy
// grows by, and both are continuous where nodes become deep.
#include "billet/contact/spring_energy.h"

#include "../testing.h"

namespace spring_energy_test {

using namespace billet;
using billet::testing::central_difference;
using billet::testing::check;
using billet::testing::WorstError;

BILLET_TEST(spring_energy) {
  constexpr double limit = 2.5;
  billet::testing::Random random;
  WorstError derivative, share, on_one, jump, no_area;
  bool is_between = true;
  for (unsigned int sample = 0; sample < 200; ++sample) {
    const double energy = random(1.01 * limit, 100. * limit), area = random(0.1, 2.),
                 before = random(0.1, 2.);
    const auto at = [&](const double e) { return SpringEnergy::split(e, limit); };
    const double h = 1e-5 * energy;
    derivative.add(std::abs(
        central_difference([&](const double d) { return at(energy + d).on_areas(area, before); }, h) -
        at(energy).counted_area(area, before)));
    share.add(std::abs(central_difference([&](const double d) { return at(energy + d).on_current_area; }, h) -
                       at(energy).share));
    is_between = is_between && at(energy).counted_area(area, before) <= std::max(area, before) &&
                 at(energy).max_area(area, before) == std::max(area, before);
    jump.add(std::abs(at(limit * (1. + 1e-12)).on_areas(area, before) - at(limit).on_areas(area, before)));
    no_area.add(std::abs(at(energy).on_areas(area, SpringEnergy::no_area) - area * energy) / energy);
    no_area.add(std::abs(at(energy).counted_area(area, SpringEnergy::no_area) - area));
    const SpringEnergy whole = SpringEnergy::on_one_area(energy);
    on_one.add(std::abs(whole.on_areas(area, before) - area * energy) / energy);
    on_one.add(std::abs(whole.counted_area(area, before) - area));
    on_one.add(std::abs(whole.max_area(area, before) - area));
  }
  check("the area that counts is the derivative of the energy", derivative.value(), 1e-8);
  check("share of the current area", share.value(), 1e-8);
  check("areas that count are no larger than both", is_between);
  check("energies are continuous where nodes become deep", jump.value(), 1e-10);
  check("without an area before, all stands on the current one", no_area.value(), 1e-14);
  check("what is not split stands on the current area", on_one.value(), 1e-14);
}

} // namespace spring_energy_test
