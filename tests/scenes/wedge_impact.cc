// SPDX-License-Identifier: LGPL-2.1-or-later
// A ball hits a plate, each a wedge with prisms on the axis. The two nodes of a prism that are at one place
// there move as one, and both sides of the wedge stay mirror images, whatever the facets and passes. Energies
// balance, and the ball's momentum goes to the plate.
#include "explicit_run.h"

#include <deal.II/base/mpi.h>

namespace wedge_impact_test {

using namespace billet;
using billet::testing::check;

namespace {

struct Outcome {
  double apart = 0.;    ///< largest distance of two nodes that start at one place [length]
  double unequal = 0.;  ///< largest difference between heights of mirror images [length]
  double momentum = 0.; ///< largest change of all momentum along the axis, relative
  double force = 0.;    ///< largest
  double drift = 0.;    ///< largest, relative
};

double height(const Element &element, const unsigned int a, const Vector &displacements) {
  return element.cell->vertex(a)[2] + displacements(element.dofs[std::size_t{3} * a + 2]);
}

Outcome run(const FacetMethod facets, const parameters::ContactPair::Passes passes) {
  parameters::Scene scene = testing::read_test_scene("wedge_impact.prm");
  scene.pairs[0].facets.method.value = facets;
  scene.pairs[0].facets.passes = passes;
  testing::ExplicitRun wedge(scene);
  Outcome outcome;
  double first = 0.;
  wedge.finish(scene.time_stepping.end_time / 15., [&] {
    const double momentum = wedge.state().momentum[2];
    first = first == 0. ? momentum : first;
    outcome.momentum = std::max(outcome.momentum, std::abs(momentum / first - 1.));
    outcome.force = std::max(outcome.force, wedge.state().body_pair_loads[0].force.norm());
    for (unsigned int body = 0; body < 2; ++body)
      for (const Element &element : wedge.discretization.elements(body))
        for (unsigned int a = 0; a < n_element_nodes / 2; ++a) { // those of one side, then those of the other
          const double difference = std::abs(height(element, a, wedge.state().displacements) -
                                             height(element, a + 4, wedge.state().displacements));
          double &worst = element.cell->vertex(a).distance(element.cell->vertex(a + 4)) > 0. ? outcome.unequal
                                                                                             : outcome.apart;
          worst = std::max(worst, difference);
        }
  });
  outcome.drift = wedge.worst_drift;
  return outcome;
}

} // namespace

BILLET_MPI_TEST(wedge_impact) {
  using Passes = parameters::ContactPair::Passes;
  const Outcome two = run(FacetMethod::planed, Passes::two), one = run(FacetMethod::planed, Passes::one);
  for (const auto &[name, outcome] :
       {std::pair<std::string, Outcome>("two passes", two), {"one pass", one}}) {
    check(name + ": nodes at one place on the axis stay together", outcome.apart, 1e-12);
    check(name + ": both sides are mirror images", outcome.unequal, 1e-9);
    check(name + ": momentum", outcome.momentum, 1e-9);
    check(name + ": energies balance", outcome.drift, 1e-3);
  }
  check("largest forces of both", std::abs(two.force / one.force - 1.), 0.05);
}

} // namespace wedge_impact_test
