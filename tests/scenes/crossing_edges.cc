// SPDX-License-Identifier: LGPL-2.1-or-later
// Two cubes that meet by their edges, turned by 45 degrees, fly apart again where edges are asked for, and
// with the momentum that they came with; nodes against facets alone let them through.
#include "explicit_run.h"

#include <deal.II/base/mpi.h>

using namespace billet;
using billet::testing::check;

namespace {

struct Outcome {
  double velocity = 0.; ///< of the upper cube's nodes, mean, at the end
  double momentum = 0.; ///< largest, of both
  double depth = 0.;    ///< largest, of the middle parts of the two edges below each other
  double drift = 0.;
};

Outcome run(const bool edges) {
  parameters::Scene scene = testing::read_test_scene("crossing_edges.prm");
  scene.pairs[0].edges = edges;
  testing::ExplicitRun cubes(scene);
  Outcome outcome;
  cubes.finish(0.005, [&] {
    outcome.momentum = std::max(outcome.momentum, cubes.state().momentum.norm());
    double lowest = 10.,
           highest = -10.; // of the upper edge, of the lower one, a third of a cube to each side
    unsigned int n = 0;
    outcome.velocity = 0.;
    for (unsigned int body = 0; body < 2; ++body)
      for (const auto &element : cubes.discretization.elements(body))
        for (unsigned int a = 0; a < n_element_nodes; ++a) {
          const auto X = element.cell->vertex(a);
          const double z = X[2] + cubes.state().displacements(element.dofs[3 * a + 2]);
          const bool is_middle = std::abs(X[body]) < 0.4;
          if (body == 0) {
            outcome.velocity += cubes.state().velocities(element.dofs[3 * a + 2]);
            ++n;
            lowest = is_middle ? std::min(lowest, z) : lowest;
          } else
            highest = is_middle ? std::max(highest, z) : highest;
        }
    outcome.velocity /= n;
    outcome.depth = std::max(outcome.depth, highest - lowest);
  });
  outcome.drift = cubes.worst_drift;
  return outcome;
}

} // namespace

int main(int argc, char *argv[]) {
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const Outcome with = run(true), without = run(false);
  check("edges: the cubes fly apart", with.velocity > 0.5);
  check("edges: hold each other out", with.depth, 0.05);
  check("edges: momentum", with.momentum, 1e-12 * 8.);
  check("edges: energy", with.drift, 0.01);
  check("nodes alone: the edges go through each other", without.depth > 0.3);
  return testing::exit_code();
}
