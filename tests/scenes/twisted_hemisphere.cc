// SPDX-License-Identifier: LGPL-2.1-or-later
// A round punch pressed on a block and twisted, both elastic. The torque, work over angle, comes to that of
// full sliding under Hertz's pressure (Johnson, Contact Mechanics, 1985, §7.4, with a³ = 3 P R/(4 E*)),
//   M = ∫ µ p r dA = 3π/16 µ P a;
// before, nodes stick in a disc that shrinks. Turned back, the punch takes no work by friction before it
// slips; lifted, it leaves no forces.
#include "scene_run.h"

#include <deal.II/base/mpi.h>

namespace twisted_hemisphere_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

BILLET_MPI_TEST(twisted_hemisphere) {
  auto scene = testing::read_shipped_scene("twisted_hemisphere.prm");
  scene.bodies[0].mesh.arguments = "10, 10, 3 : -1, -1, -1 : 1, 1, 0 : true";
  scene.bodies[1].mesh.arguments = "9, 9, 3 : -1, -1, 0 : 1, 1, 1 : true";
  for (auto &amplitude : scene.amplitudes) // pressed and lifted in fewer steps
    if (amplitude.name == "down") {
      amplitude.times = {0., 0.25, 1.75, 2.};
      amplitude.values = {0., -0.3, -0.3, 0.1};
    } else
      amplitude.times = {0.25, 1.25, 1.75};
  scene.time_stepping.stops = {0.25, 1.25, 1.75};
  scene.time_stepping.end_time = 2.;
  scene.time_stepping.max_step = 0.125;
  scene.pairs[0].penetration_tolerance = 0.; // springs alone give back what they took
  SceneRun run(scene);
  const SolutionState &state = run.problem.state();
  std::map<DofIndex, double> radii;
  for (const auto &element : run.discretization.elements(1))
    for (const unsigned int v : element.cell->vertex_indices()) {
      const auto x = element.cell->vertex(v);
      radii[element.cell->vertex_dof_index(v, 0)] = std::hypot(x[0], x[1]);
    }

  constexpr double mu = 0.3, R = 10., rate = 0.16, back_rate = -0.016, effective = 1000. / (1. - 0.09) / 2.;
  double time = 0., work = 0., torque = 0., plateau = 0., full = 0., first_back = 0., last_back = 0.,
         taken = 0., back = 0., at_turn = 0., first_stuck = 0., last_stuck = 0.;
  double moment_n = 0.;
  testing::WorstError growth;
  double moment_errors = 0.;
  unsigned int n_moments = 0;
  run.finish([&](const NewtonReport &) {
    const double now = state.time, middle = 0.5 * (now + time);
    double stuck = 0.;
    for (const auto &node : run.problem.equation().parts().contacts().of_bodies()[0].measures().report())
      if (node.status == ContactStatus::stick && node.pressure > 0.)
        stuck = std::max(stuck, radii.at(node.dofs[0]));
    // Work over angle is the mean moment of the step, but where nodes begin to slip within it; the pair's
    // moment is on its first body.
    const double moment = std::abs(state.body_pair_loads[0].moment[2]);
    if (middle > 0.65 && middle < 1.25) {
      moment_errors +=
          std::abs(0.5 * (moment + moment_n) * rate * (now - time) / (state.energies.external - work) - 1.);
      ++n_moments;
    }
    moment_n = moment;
    if (middle > 0.25 && middle < 1.75)
      torque = (state.energies.external - work) / ((middle < 1.25 ? rate : back_rate) * (now - time));
    if (middle > 0.25 && middle < 1.25) {
      if (first_stuck == 0.)
        first_stuck = stuck;
      else
        growth.add(stuck - last_stuck);
      last_stuck = stuck;
      plateau = torque;
      const double P = std::abs(state.body_pair_loads[0].force[2]);
      full = 3. * M_PI / 16. * mu * P * std::cbrt(0.75 * P * R / effective);
      at_turn = state.energies.friction;
    } else if (middle > 1.25 && middle < 1.75) {
      if (first_back == 0.)
        first_back = torque;
      last_back = torque;
      back += std::abs(state.energies.external - work);
      taken = state.energies.friction - at_turn;
    }
    time = now;
    work = state.energies.external;
  });
  check("torque of full sliding", std::abs(plateau / full - 1.), 0.05);
  check("the pair's moment is the torque", moment_errors / n_moments, 5e-4);
  check("sticks at first", first_stuck > 1.);
  check("the disc that sticks shrinks", growth.value(), 0.);
  check("nearly all slips", last_stuck < 0.3 * first_stuck);
  check("turned back, the torque falls", last_back < 0.9 * first_back && first_back < plateau);
  // By Mindlin's theory the rim slips back at once, but next to nothing is lost there.
  check("turned back, friction takes next to nothing", taken / back, 0.04);
  check("force at the end", state.body_pair_loads[0].force.norm() == 0.);
  bool is_open = true;
  for (const auto &node : run.problem.equation().parts().contacts().of_bodies()[0].measures().report())
    is_open = is_open && node.status == ContactStatus::open && node.traction.norm() == 0.;
  check("open at the end", is_open);
  check("elastic energy at the end", state.energies.elastic / state.energies.external, 1e-12);
}

} // namespace twisted_hemisphere_test
