// SPDX-License-Identifier: LGPL-2.1-or-later
// Nodes that go through a tool thinner than two facets, here a ball: from outside to outside, from one side
// of its inside to the other, and so deep that the other side is as near.
#include "billet/contact/thin_tool_watch.h"

#include "../geometry/make_surface.h"
#include "../testing.h"

#include <deal.II/base/config.h>

#include <cmath>
#include <string>

namespace thin_tool_watch_test {

using namespace billet;
using billet::testing::check;
using dealii::Tensor;

BILLET_TEST(thin_tool_watch) {
  const auto ball = billet::testing::make_surface("sphere", "set Radius = 0.05");
  check("a tool thicker than two facets is not watched", !ThinToolWatch::make(*ball, 0.049));
  auto watch = ThinToolWatch::make(*ball, 0.051);
  check("a thinner one is", watch.has_value());
  if (!watch)
    return;
  check("thickness", std::abs(watch->thickness() - 0.1), 1e-12);
  check("no positions are known at first", !watch->knows_positions());

  const auto passes = [&](const Tensor<1, 3> &from, const Tensor<1, 3> &to, const double penetration = 0.) {
    watch->remember({from});
    const auto end = ball->project(to, 0);
    return watch->passes(0, {to, 0, end.gap, penetration});
  };
  const auto at = [](const double x, const double y) { return Tensor<1, 3>({x, y, 0.}); };
  check("through the middle", passes(at(-1., 0.), at(1., 0.)));
  check("through it aside", passes(at(-1., 0.03), at(1., 0.03)));
  check("a chord that grazes it does not count", !passes(at(-1., 0.0495), at(1., 0.0495)));
  check("past it", !passes(at(-1., 0.2), at(1., 0.2)));
  check("away from it", !passes(at(-0.1, 0.), at(-1., 0.)));
  check("at rest", !passes(at(-0.1, 0.), at(-0.1, 0.)));
  check("into it", !passes(at(-0.1, 0.), at(-0.04, 0.)));
  check("inside, from one side to the other", passes(at(-0.04, 0.), at(0.04, 0.)));
  check("inside, on one side", !passes(at(-0.04, 0.), at(-0.045, 0.01)));
  const auto turns = [&](const double degrees, const double radius) {
    const double angle = degrees * M_PI / 180.;
    return passes(at(radius, 0.), at(radius * std::cos(angle), radius * std::sin(angle)));
  };
  check("deep inside, to where it faces away", turns(85., 0.03) && !turns(20., 0.03));
  check("less deep, to the other side", turns(120., 0.045) && !turns(60., 0.045));
  check("pressed to the middle", passes(at(-0.1, 0.), at(-0.1, 0.), 0.05));
  check("pressed less deep", !passes(at(-0.1, 0.), at(-0.1, 0.), 0.02));
#ifdef DEAL_II_WITH_OPENCASCADE
  const auto flat = billet::testing::make_surface(
      "CAD", "set File = " + std::string(SOURCE_DIR) + "/../../prm/step_punch/punch.step\nset Faces = 2");
  check("a flat face of a CAD file is not thin, though its box has a tolerance",
        !ThinToolWatch::make(*flat, 1.));
#endif
  watch->forget();
  check("positions are dropped", !watch->knows_positions());
}

} // namespace thin_tool_watch_test
