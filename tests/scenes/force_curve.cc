// SPDX-License-Identifier: LGPL-2.1-or-later
// The billet's force curve, the same on several ranks: the comparison files for 1 and 3 ranks are one text.
#include "scene_run.h"

#include <deal.II/base/mpi.h>

#include <fstream>
#include <iomanip>

namespace force_curve_test {

using billet::testing::SceneRun;

BILLET_MPI_TEST(force_curve) {
  SceneRun scene(billet::testing::read_shipped_scene("billet_upsetting.prm"));
  std::ofstream output(billet::testing::is_first_rank() ? "output" : "/dev/null");
  output << std::setprecision(11) << "time iterations force area plastic_work\n";
  scene.finish([&](const billet::NewtonReport &report) {
    output << scene.control.time() << " " << report.iterations.size() << " " << scene.load().force.norm()
           << " " << scene.load().area << " " << scene.problem.state().energies.plastic << "\n";
  });
}

} // namespace force_curve_test
