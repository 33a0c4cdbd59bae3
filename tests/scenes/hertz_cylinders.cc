// SPDX-License-Identifier: LGPL-2.1-or-later
// Hertz: two elastic cylinders, plane strain, frictionless. With the load P per length, 1/R = 1/R_1 + 1/R_2
// and 1/E* = Σ (1 − ν²)/E_i (Johnson, Contact Mechanics, 1985, ch. 4)
//   b² = 4 P R/(π E*),   p = p_0 √(1 − x²/b²),   p_0 = 2 P/(π b).
// The half-width is read from the pressures: p² is linear in x². On the way back the forces are those of the
// way there, and nothing is left at its end.
#include "unloaded.h"

#include <deal.II/base/mpi.h>

namespace hertz_cylinders_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

BILLET_MPI_TEST(hertz_cylinders) {
  auto scene = testing::read_shipped_scene("hertz_cylinders.prm");
  scene.bodies[0].mesh.arguments = "28, 1, 12 : 0, 0, -1 : 1, 0.1, 0 : true";
  scene.bodies[1].mesh.arguments = "24, 1, 12 : 0, 0, 0 : 1, 0.1, 1 : true";
  scene.pairs[0].penetration_tolerance = 0.;
  scene.solver.force_tolerance = 1e-9;
  scene.bodies[1].supports[0].displacement.value[2] = "0.04*(abs(t - 1) - 1)";
  scene.time_stepping.end_time = 2.25;
  testing::set_fixed_steps(scene, 9);
  SceneRun run(scene);
  std::vector<double> forces{0.};
  while (forces.size() < 5) { // until 1
    run.advance();
    forces.push_back(run.problem.state().body_pair_loads[0].force[2]);
  }

  constexpr double nu = 0.3, R = 1. / (1. / 10. + 1. / 20.), thickness = 0.1;
  const double effective = 1. / ((1. - nu * nu) * (1. / 1e5 + 1. / 2e5));
  const double P = 2. * std::abs(forces.back()) / thickness;
  const double b = std::sqrt(4. * P * R / (M_PI * effective)), p_0 = 2. * P / (M_PI * b);
  std::map<DofIndex, double> positions;
  for (const auto &element : run.discretization.elements(1))
    for (const unsigned int v : element.cell->vertex_indices())
      positions[element.cell->vertex_dof_index(v, 0)] = element.cell->vertex(v)[0];
  // Least squares of p² = A − B x² over the nodes well inside: b² = A/B, p_0² = A.
  double s0 = 0., s1 = 0., s2 = 0., t0 = 0., t1 = 0., last = 0.;
  for (const auto &node : run.problem.equation().parts().contacts().of_bodies()[0].measures().report()) {
    if (!(node.pressure > 0.))
      continue;
    const double x = positions.at(node.dofs[0]), x2 = x * x, p2 = node.pressure * node.pressure;
    last = std::max(last, x);
    if (x > 0.8 * b)
      continue;
    s0 += 1.;
    s1 += x2;
    s2 += x2 * x2;
    t0 += p2;
    t1 += p2 * x2;
  }
  const double B = -(s0 * t1 - s1 * t0) / (s0 * s2 - s1 * s1), A = (t0 + B * s1) / s0;
  check("nodes well inside the contact", s0 >= 12.);
  check("half-width", std::abs(std::sqrt(A / B) / b - 1.), 0.02);
  check("largest pressure", std::abs(std::sqrt(A) / p_0 - 1.), 0.02);
  check("contact ends within an element of the half-width", std::abs(last - b), 1.5 * 6. * 0.15 / 24.);

  const double stored = run.problem.state().energies.elastic;
  testing::WorstError back;
  for (std::size_t i = 3; i > 0; --i) {
    run.advance();
    back.add(std::abs(run.problem.state().body_pair_loads[0].force[2] - forces[i]) / std::abs(forces[4]));
  }
  check("forces on the way back", back.value(), 1e-8);
  run.finish();
  testing::check_unloaded("", run, stored);
}

} // namespace hertz_cylinders_test
