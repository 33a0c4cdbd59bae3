// SPDX-License-Identifier: LGPL-2.1-or-later
// The assembled tangent of scenes with contact between bodies against central differences of the residual,
// for each kind of facet, with supports at nodes in contact, and on several ranks.
#include "tangent_check.h"

#include <deal.II/base/mpi.h>

namespace tangent_of_bodies_test {

using namespace billet;
using billet::testing::check;
using billet::testing::is_first_rank;
using billet::testing::SceneRun;
using billet::testing::tangent_error;

BILLET_MPI_TEST(tangent_of_bodies) {
  using Facets = FacetMethod;
  const bool is_alone = testing::n_ranks() == 1;
  for (const auto &[facets, name] : {std::pair<Facets, std::string>{Facets::planed, "planed"},
                                     {Facets::bilinear, "bilinear"},
                                     {Facets::overlap, "overlap"}})
    for (const double friction : {0., 0.3}) {
      if ((friction == 0. || facets == Facets::bilinear) && !is_alone)
        continue; // nothing there that the others have not
      parameters::Scene scene = parameters::Scene::read(std::string(SOURCE_DIR) + "/dragged_blocks.prm");
      scene.pairs[0].facets.method.value = facets;
      scene.pairs[0].friction = make_coulomb(friction);
      scene.solver.contact_tangent = parameters::ContactTangent::exact;
      scene.time_stepping.initial_step = 0.2;
      SceneRun run(scene);
      // At 0.75 a node changes its status within the differences of one direction.
      const double error = tangent_error(run, is_alone ? 0.65 : 0.35, is_alone ? 2 : 1);
      unsigned int n_touch = 0;
      const auto reports = run.problem.report_contacts();
      for (const auto &node : reports[0])
        n_touch += node.status != ContactStatus::open;
      n_touch = dealii::Utilities::MPI::sum(n_touch, MPI_COMM_WORLD);
      if (is_first_rank()) {
        check(name + (friction > 0. ? ", friction" : ", no friction") + ": exact tangent", error, 1e-6);
        check(name + (friction > 0. ? ", friction" : ", no friction") + ": nodes touch", n_touch > 5);
      }
    }
}

} // namespace tangent_of_bodies_test
