// SPDX-License-Identifier: LGPL-2.1-or-later
// A block that slides on a deformable slab stops after v²/(2 μ g), and friction takes all of its kinetic
// energy.
#include "explicit_run.h"

#include <deal.II/base/mpi.h>

namespace explicit_sliding_block_test {

using namespace billet;
using billet::testing::check;

namespace {

constexpr double friction = 0.25, gravity = 4000., full_weight = 2.5e-3;

void test(const std::string &name, const bool two_passes, const FacetMethod facets) {
  parameters::Scene scene = testing::read_test_scene("sliding_block.prm");
  scene.pairs[0].facets.passes =
      two_passes ? parameters::ContactPair::Passes::two : parameters::ContactPair::Passes::one;
  scene.pairs[0].facets.method.value = facets;
  testing::ExplicitRun run(scene);
  double start = 0., speed = 0., side = 0., initial = 0.;
  run.finish(0.5e-3, [&] {
    const double t = run.state().time;
    const auto u = testing::mean_of_body(run, run.state().displacements, 1);
    side = std::max(side, std::abs(u[1]));
    if (t == 0.)
      initial = run.state().energies.kinetic;
    if (std::abs(t - full_weight) < 1e-9) {
      start = u[0];
      speed = testing::mean_of_body(run, run.state().velocities, 1)[0];
    }
  });
  const double way = testing::mean_of_body(run, run.state().displacements, 1)[0] - start;
  std::cout << name << ":" << std::endl;
  check("  slides fast where it is measured", speed > 3.);
  check("  way", std::abs(way / (speed * speed / (2. * friction * gravity)) - 1.), 0.005);
  check("  straight on", side / way, 0.005);
  // What is left is vibration that the weight and the jerk of the stop have excited.
  check("  comes to rest", run.state().energies.kinetic / initial, 1e-3);
  check("  friction takes the energy", std::abs(run.state().energies.friction / initial - 1.), 0.005);
  check("  energy", run.worst_drift, 5e-3);
}

} // namespace

BILLET_MPI_TEST(explicit_sliding_block) {
  using Facets = FacetMethod;
  test("planed, two passes", true, Facets::planed);
  test("planed, one pass", false, Facets::planed);
  test("bilinear, two passes", true, Facets::bilinear);
  test("bilinear, one pass", false, Facets::bilinear);
}

} // namespace explicit_sliding_block_test
