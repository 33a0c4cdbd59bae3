// SPDX-License-Identifier: LGPL-2.1-or-later
// Rings that hit each other, with facets of different angles, and nodes at their rims that leave facets and
// come back from beside: contact makes no energy, and loses what springs held where nodes leave.
#include "explicit_run.h"

#include <deal.II/base/mpi.h>

namespace expanding_rings_test {

using namespace billet;
using billet::testing::check;

BILLET_MPI_TEST(expanding_rings) {
  using Facets = FacetMethod;
  for (const bool two_passes : {true, false})
    for (const Facets facets : {Facets::planed, Facets::bilinear}) {
      parameters::Scene scene = testing::read_test_scene("expanding_rings.prm");
      scene.pairs[0].facets.passes =
          two_passes ? parameters::ContactPair::Passes::two : parameters::ContactPair::Passes::one;
      scene.pairs[0].facets.method.value = facets;
      testing::ExplicitRun rings(scene);
      double made = 0., lost = 0., force = 0.;
      rings.finish(2e-6, [&] {
        made = std::max(made, -rings.problem.relative_drift());
        lost = std::max(lost, rings.problem.relative_drift());
        force = std::max(force, rings.state().body_pair_loads[0].force.norm());
      });
      const std::string name = std::string(facets == Facets::planed ? "planed" : "bilinear") +
                               (two_passes ? ", two passes" : ", one pass");
      check(name + ": energy made", made, 2e-3);
      check(name + ": energy lost", lost, 1e-2);
      check(name + ": they touch", force > 0.);
    }
}

} // namespace expanding_rings_test
