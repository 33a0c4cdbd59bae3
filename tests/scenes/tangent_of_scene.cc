// SPDX-License-Identifier: LGPL-2.1-or-later
// The assembled tangent of a whole scene (elements, contact, supports) against central differences of its
// residual, with nodes that stick, slip and enter, on a tool that turns and moves.
#include "scene_run.h"

#include <deal.II/base/mpi.h>

#include <Epetra_Map.h>
#include <Epetra_Vector.h>

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

/// Runs to time t, starts one more step, and continues the last increment into it: there K⁻¹ (∂R/∂u v) must
/// be v.
double tangent_error(SceneRun &run, const double t, const unsigned int n_directions) {
  QuasiStatic &problem = run.problem;
  Vector before = run.discretization.make_owned_vector(), x = before;
  while (run.control.time() < t) {
    before = problem.state().displacements;
    run.advance();
  }
  const auto &owned = run.discretization.owned_dofs();
  x = problem.state().displacements;
  x.sadd(1.7, -0.7, before);
  problem.start_step(run.control.next_time());
  Epetra_Vector &point = *x.trilinos_vector()(0);
  Epetra_Vector plus(point), minus(point), difference(point), solution(point);
  testing::Random random;
  testing::WorstError error;
  for (unsigned int k = 0; k < n_directions; ++k) {
    Vector direction = run.discretization.make_owned_vector();
    for (const auto i : owned)
      direction(i) = random(-1., 1.);
    direction.compress(dealii::VectorOperation::insert);
    run.problem.supports().homogeneous().distribute(direction);
    const Epetra_Vector &v = *direction.trilinos_vector()(0);
    const double h = 1e-7;
    difference.PutScalar(0.);
    for (const auto &[offset, weight] :
         {std::pair<double, double>{1., 8.}, {-1., -8.}, {2., -1.}, {-2., 1.}}) {
      plus = point;
      plus.Update(offset * h, v, 1.);
      if (!problem.compute_residual(plus, minus))
        return 1.;
      difference.Update(weight / (12. * h), minus, 1.);
    }
    if (!problem.compute_tangent(point) || !problem.solve_tangent(difference, solution))
      return 1.;
    solution.Update(-1., v, 1.);
    double wrong = 0., whole = 0.;
    solution.Norm2(&wrong);
    v.Norm2(&whole);
    error.add(wrong / whole);
  }
  return error.value();
}

} // namespace

int main(int argc, char *argv[]) {
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  // Slipping billet, some nodes of the mantle in contact.
  parameters::Scene billet = testing::read_shipped_scene("billet_upsetting.prm");
  SceneRun upset(billet);
  check("upset billet, slipping: exact tangent", tangent_error(upset, 0.9, 5), 1e-6);

  // Sticking block on a plane that turns and moves.
  parameters::Scene block = parameters::Scene::read(std::string(SOURCE_DIR) + "/block_on_plane.prm");
  SceneRun carried(block);
  check("block on a turning plane, sticking: exact tangent", tangent_error(carried, 1.2, 5), 1e-6);

  // The same, dragged over its cone.
  block.pairs[0].friction_coefficient = 0.05;
  SceneRun dragged(block);
  check("block on a turning plane, slipping: exact tangent", tangent_error(dragged, 0.8, 5), 1e-6);
  return billet::testing::exit_code();
}
