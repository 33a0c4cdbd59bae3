// SPDX-License-Identifier: LGPL-2.1-or-later
// Two cubes that meet by their edges, turned by 45 degrees, fly apart again where edges are asked for,
// with the momentum that they came with; nodes against facets alone let them through.
#include "explicit_run.h"

#include <deal.II/base/mpi.h>

namespace crossing_edges_test {

using namespace billet;
using billet::testing::check;

namespace {

struct Outcome {
  double velocity = 0.;                    ///< of the upper cube's nodes, mean, at the end
  double momentum = 0.;                    ///< largest, of both
  double depth = 0.;                       ///< largest, of the middle parts of the two edges below each other
  double drift = 0., made = 0., lost = 0.; ///< largest, relative
};

/// Cubes of n x n x n elements, the upper one of which is so far aside.
Outcome run(const bool edges, const unsigned int n_elements = 3, const double aside = 0.) {
  parameters::Scene scene = testing::read_test_scene("crossing_edges.prm");
  scene.pairs[0].facets.edges =
      edges ? parameters::ContactPair::Edges::held : parameters::ContactPair::Edges::free;
  const std::string n = std::to_string(n_elements);
  for (auto &body : scene.bodies)
    body.mesh.arguments = n + ", " + n + ", " + n + " : -1, -1, -1 : 1, 1, 1 : false";
  scene.bodies[0].mesh.translation[0] = aside;
  testing::ExplicitRun cubes(scene);
  Outcome outcome;
  cubes.finish(0.005, [&] {
    outcome.made = std::max(outcome.made, -cubes.problem.relative_drift());
    outcome.lost = std::max(outcome.lost, cubes.problem.relative_drift());
    outcome.momentum = std::max(outcome.momentum, cubes.state().momentum.norm());
    double lowest = 10.,
           highest = -10.; // of the upper edge, of the lower one, a third of a cube to each side
    unsigned int n_nodes = 0;
    outcome.velocity = 0.;
    for (unsigned int body = 0; body < 2; ++body)
      for (const auto &element : cubes.discretization.elements(body))
        for (unsigned int a = 0; a < n_element_nodes; ++a) {
          const auto X = element.cell->vertex(a);
          const double z = X[2] + cubes.state().displacements(element.dofs[3 * a + 2]);
          const bool is_middle = std::abs(X[body]) < 0.4;
          if (body == 0) {
            outcome.velocity += cubes.state().velocities(element.dofs[3 * a + 2]);
            ++n_nodes;
            lowest = is_middle ? std::min(lowest, z) : lowest;
          } else
            highest = is_middle ? std::max(highest, z) : highest;
        }
    outcome.velocity /= n_nodes;
    outcome.depth = std::max(outcome.depth, highest - lowest);
  });
  outcome.drift = cubes.worst_drift;
  return outcome;
}

} // namespace

BILLET_MPI_TEST(crossing_edges) {
  const Outcome with = run(true), without = run(false);
  check("edges: the cubes fly apart", with.velocity > 0.5);
  check("edges: hold each other out", with.depth, 0.05);
  check("edges: momentum", with.momentum, 1e-12 * 8.);
  check("edges: energy", with.drift, 0.01);
  check("nodes alone: the edges go through each other", without.depth > 0.3);
  // What is left is lost, or made, by nodes: on faces that they bend, by areas that change. Where nodes hit
  // nodes, or two elements a side make edges that bend by a tenth of their length, that is more: 10 % with
  // nodes alone.
  for (const unsigned int n : {2, 3, 4, 5})
    for (const double aside : {0., 0.1, 0.21, 0.3, 0.34}) {
      const Outcome outcome = run(true, n, aside);
      const std::string name =
          std::to_string(n) + " elements, " + std::to_string(aside).substr(0, 4) + " aside: ";
      const bool is_coarse = n == 2 || (n % 2 == 0 && aside == 0.);
      check(name + "they fly apart", outcome.velocity > 0.3);
      check(name + "momentum", outcome.momentum, 1e-12 * 8.);
      check(name + "energy made", outcome.made, is_coarse ? 0.06 : 0.03);
      check(name + "energy lost", outcome.lost, 0.045);
    }
}

} // namespace crossing_edges_test
