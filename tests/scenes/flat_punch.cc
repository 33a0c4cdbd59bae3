// SPDX-License-Identifier: LGPL-2.1-or-later
// A thin strip that lifts off a flat punch: nodes that touch and open in turn keep Newton's method from an
// end unless penalties rise from low ones. The force is that of a beam.
#include "scene_run.h"

#include <deal.II/base/mpi.h>

namespace flat_punch_test {

using namespace billet;
using billet::testing::check;

BILLET_MPI_TEST(flat_punch) {
  const parameters::Scene parameters = parameters::Scene::read(std::string(SOURCE_DIR) + "/flat_punch.prm");
  testing::SceneRun run(parameters);
  run.finish();
  // A beam on two supports, with two forces at the distance a from them: w = F a² (3 l − 4 a) / (6 E I).
  const double a = 20., l = 80., stiffness = 2e5 * 2. / 12., w = 0.01;
  const double force = w * 6. * stiffness / (a * a * (3. * l - 4. * a));
  check("the punch bears what a beam does", testing::near(run.load(0).force[2], -force, 0.002));
  check("and the die", testing::near(run.load(1).force[2], force, 0.002));
}

} // namespace flat_punch_test
