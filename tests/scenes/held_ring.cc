// SPDX-License-Identifier: LGPL-2.1-or-later
// A ring that gas holds against another one: contact whose gap and reaction belong together neither makes nor
// takes energy while it lasts; the gap to the mean plane, as published, pumps the warping of facets.
#include "explicit_run.h"

#include <deal.II/base/mpi.h>

namespace held_ring_test {

using namespace billet;
using billet::testing::check;

namespace {

/// Drift after the blow and its change until the end, relative to the largest energy.
std::array<double, 2> run(const FacetMethod facets, const double end_time) {
  parameters::Scene scene = testing::read_test_scene("held_ring.prm");
  scene.pairs[0].facets.method.value = facets;
  scene.time_stepping.end_time = end_time;
  testing::ExplicitRun rings(scene);
  double after_impact = 0.;
  rings.finish(50e-6, [&] {
    if (std::abs(rings.state().time - 50e-6) < 1e-9)
      after_impact = rings.problem.relative_drift();
  });
  return {after_impact, rings.problem.relative_drift() - after_impact};
}

} // namespace

BILLET_MPI_TEST(held_ring) {
  using Facets = FacetMethod;
  for (const Facets facets : {Facets::planed, Facets::bilinear}) {
    const std::string name = facets == Facets::planed ? "planed" : "bilinear";
    const auto [impact, change] = run(facets, 120e-6);
    check(name + ": energy of the blow", impact, 5e-3);
    check(name + ": energy while it is held", change, 1e-4);
  }
  check("mean gap: energy is made", run(Facets::mean_gap, 200e-6)[1] < -0.1);
}

} // namespace held_ring_test
