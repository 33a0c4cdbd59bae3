// SPDX-License-Identifier: LGPL-2.1-or-later
// Initial gaps that faces beside the contact take over, (C15): by the way they look, and beside overlaps by
// their own gap.
#include "billet/contact/facing_gaps.h"

#include "../testing.h"

namespace facing_gaps_test {

using namespace billet;
using namespace billet::testing;

using dealii::Tensor;

namespace {

constexpr double alone = FacingGaps::unknown;

Tensor<1, 3> direction(const double x, const double y, const double z) { return Tensor<1, 3>({x, y, z}); }

void check_gaps() {
  FacingGaps gaps;
  check("nothing is carried without contact",
        gaps.carried_penetration(direction(0., 0., 2.), alone) == 0. && !gaps.find(direction(0., 0., 1.)));
  gaps.add(direction(0., 0., 1.), 0.02);
  gaps.add(direction(0., 0., 3.), 0.01);
  gaps.add(direction(0., 0.05, 1.), 0.015);
  check("the least gap counts", gaps.find(direction(0., 0., 1.)) == 0.01);
  check("a face beside it is raised", gaps.carried_penetration(direction(0., 0., 2.), alone) == -0.01);
  check("  whatever its gap", gaps.carried_penetration(direction(0., 0., 2.), 0.5) == -0.01);
  check("  and its edges and corners", gaps.carried_penetration(direction(0., 1., 1.), alone) == -0.01 &&
                                           gaps.carried_penetration(direction(1., 1., 1.), alone) == -0.01);
  check("but not its sides", gaps.carried_penetration(direction(1., 0., 0.), alone) == 0.);
  check("  nor its back", gaps.carried_penetration(direction(0., 0., -1.), alone) == 0.);
}

void check_overlaps() {
  FacingGaps gaps;
  gaps.add(direction(0., 0., 1.), 0.01);
  gaps.add(direction(0., 0., 1.), -0.02);
  const Tensor<1, 3> up = direction(0., 0., 1.);
  check("the deepest overlap counts", gaps.carried_penetration(up, alone) == 0.02);
  check("a small gap beside it stays", gaps.carried_penetration(up, 0.02) == 0.);
  check("  and fades in", near(gaps.carried_penetration(up, 0.03), 0.01, 1e-12));
  check("  up to the whole", gaps.carried_penetration(up, 0.05) == 0.02);
}

void check_directions() {
  Random random;
  double worst = 0.; // cosine of the largest angle at which a face is still met, and the least at which not
  double least = 1.;
  for (unsigned int i = 0; i < 1000; ++i) {
    const Tensor<2, 3> turn = random.rotation();
    FacingGaps gaps;
    gaps.add(turn * direction(0., 0., 1.), 1.);
    const double angle = random(0., M_PI), cosine = std::cos(angle);
    if (gaps.find(turn * direction(std::sin(angle), 0., cosine)))
      least = std::min(least, cosine);
    else
      worst = std::max(worst, cosine);
  }
  check("directions count as the same up to 55 degrees, in any axes", worst < 0.64 && least > 0.44);
}

} // namespace

BILLET_TEST(facing_gaps) {
  check_gaps();
  check_overlaps();
  check_directions();
}

} // namespace facing_gaps_test
