// SPDX-License-Identifier: LGPL-2.1-or-later
// Two hemispheres pushed past each other, large sliding on rough meshes that do not match. Without friction
// nothing is left of the work when they have parted, and the force on the way out is the mirror image of that
// on the way in; with friction the work is what friction took. Both part without forces.
#include "scene_run.h"

#include <deal.II/base/mpi.h>

namespace passing_spheres_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

BILLET_MPI_TEST(passing_spheres) {
  for (const double friction : {0., 0.3}) {
    const std::string name = friction == 0. ? "frictionless: " : "friction: ";
    auto scene = testing::read_shipped_scene("passing_spheres.prm");
    scene.pairs[0].friction = make_coulomb(friction);
    scene.pairs[0].penetration_tolerance = 0.; // springs alone know no history, and give back what they took
    for (auto &body : scene.bodies)
      body.mesh.refinements = 1;
    testing::set_fixed_steps(scene, 40);
    SceneRun run(scene);
    const SolutionState &state = run.problem.state();
    std::vector<dealii::Tensor<1, 3>> forces{{}};
    double max_energy = 0., max_force = 0.;
    run.finish([&](const NewtonReport &) {
      forces.push_back(state.body_pair_loads[0].force);
      max_energy = std::max(max_energy, state.energies.elastic);
      max_force = std::max(max_force, forces.back().norm());
    });
    check(name + "they meet", max_force > 100.);
    if (friction == 0.) {
      testing::WorstError mirrored;
      for (std::size_t i = 0; i < forces.size(); ++i) {
        const auto &there = forces[forces.size() - 1 - i];
        mirrored.add(std::hypot(forces[i][0] + there[0], forces[i][2] - there[2]) / max_force);
      }
      check(name + "mirrored force", mirrored.value(), 1e-5);
      // (A1) follows a node that leaves on the one facet that had most of it, one that enters on all.
      check(name + "work", std::abs(state.energies.external) / max_energy, 1e-3);
    } else
      check(name + "work", std::abs(state.energies.external / state.energies.friction - 1.), 0.03);
    check(name + "elastic energy at the end", state.energies.elastic / max_energy, 1e-10);
    check(name + "force at the end", forces.back().norm() / max_force, 1e-12);
    bool is_open = true;
    for (const auto &node : run.problem.equation().parts().contacts().of_bodies()[0].measures().report())
      is_open = is_open && node.status == ContactStatus::open && node.traction.norm() == 0.;
    check(name + "open at the end", is_open);
  }
}

} // namespace passing_spheres_test
