// SPDX-License-Identifier: LGPL-2.1-or-later
// A strip is bent by an explicit run, in each formulation, and springs back in a static scene without the
// tool: into a state without forces, elastically, to where a strip does that was bent statically, too. Then
// the static result moves on in an explicit scene, and stays where it is.
#include "materials.h"
#include "restart_run.h"

#include <deal.II/base/mpi.h>

namespace springback_test {

using namespace billet;
using billet::testing::check;

namespace {

parameters::Scene make_static(parameters::Scene scene) {
  scene.time_stepping.scheme = parameters::TimeStepping::Scheme::quasi_static;
  scene.bodies[0].loads.clear();
  testing::set_elasticity(scene.bodies[0].material, "Hencky");
  scene.time_stepping.control = parameters::TimeStepping::Control::automatic;
  scene.time_stepping.initial_step = 0.1;
  scene.time_stepping.min_step = 1e-6;
  scene.time_stepping.max_step = 0.5;
  scene.time_stepping.few_iterations = 5;
  scene.time_stepping.many_iterations = 9;
  scene.time_stepping.growth_factor = 1.5;
  scene.time_stepping.shrink_factor = 0.7;
  scene.time_stepping.cut_factor = 0.5;
  return scene;
}

parameters::Scene without_tools(parameters::Scene scene) {
  scene.tools.clear();
  scene.pairs.clear();
  scene.restart.file.value = "somewhere"; // it begins with deformed bodies
  return scene;
}

/// Mean over the free end. Collective.
double deflection(const Discretization &discretization, const Vector &displacements) {
  std::array<double, 2> sums{};
  for (const auto &element : discretization.elements(0))
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      if (element.cell->vertex(a)[0] > 12. - 1e-6) {
        sums[0] += displacements(element.dofs[3 * a + 2]);
        sums[1] += 1.;
      }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 2, MPI_DOUBLE, MPI_SUM, discretization.communicator());
  return -sums[0] / sums[1];
}

std::vector<double> plastic_strains(const Solution &solution) {
  std::vector<double> strains;
  for (const auto &summary : solution.summarize(0))
    strains.push_back(summary.equivalent_plastic_strain);
  return strains;
}

double maximum(const std::vector<double> &values) {
  return dealii::Utilities::MPI::max(values.empty() ? 0. : *std::max_element(values.begin(), values.end()),
                                     MPI_COMM_WORLD);
}

/// Of the nodal forces of the stresses, relative to that of a yielding element.
double max_force(testing::ImplicitSolutionRun &run) {
  Vector forces = run.discretization.make_additive_vector();
  InternalForces internal(run.scene, run.discretization);
  for (std::size_t e = 0; e < internal.block(0).size(); ++e) {
    std::vector<double> state(internal.block(0).state_size());
    run.problem.equation().parts().internal().block(0).get_state(e, state.data());
    internal.block(0).set_state(e, state.data());
  }
  internal.assemble_forces(run.problem.state().displacements, forces);
  forces.compress(dealii::VectorOperation::add);
  Vector owned = run.discretization.make_owned_vector();
  owned = forces;
  // What stresses do to the clamp and to the other half of the strip are no forces on the whole.
  for (const auto &element : run.discretization.elements(0))
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      for (unsigned int i = 0; i < 3; ++i)
        if (run.discretization.owned_dofs().is_element(element.dofs[3 * a + i]) &&
            (element.cell->vertex(a)[0] < 1e-6 || (i == 1 && element.cell->vertex(a)[1] < 1e-6)))
          owned(element.dofs[3 * a + i]) = 0.;
  owned.compress(dealii::VectorOperation::insert);
  return owned.linfty_norm() / (200. * 0.5 * 0.33);
}

void test(const std::string &name, const parameters::Scene &bending, const double reference,
          const bool has_one_point) {
  std::vector<double> strains;
  double bent = 0.;
  {
    testing::ExplicitStops run(bending, MPI_COMM_WORLD);
    testing::History ignored;
    run.run(bending.time_stepping.end_time, 1000, ignored);
    run.save("bent.h5");
    run.problem.prepare_step(1.);
    run.problem.update_state();
    bent = deflection(run.discretization, run.problem.state().displacements);
    strains = plastic_strains(run.problem);
  }
  parameters::Scene scene = without_tools(make_static(bending));
  scene.time_stepping.end_time = bending.time_stepping.end_time + 1.;
  testing::ImplicitSolutionRun run(scene, MPI_COMM_WORLD);
  const RestartReport report = run.load("bent.h5", 0.5);
  const std::vector<double> taken_over = plastic_strains(run.problem);
  testing::History history;
  run.run(scene.time_stepping.end_time, history);
  run.save("sprung.h5");
  const std::vector<double> left = plastic_strains(run.problem);
  testing::WorstError change, transfer;
  for (std::size_t e = 0; e < strains.size(); ++e) {
    transfer.add(std::abs(taken_over[e] - strains[e]));
    change.add(std::abs(left[e] - taken_over[e]));
  }
  const double way = deflection(run.discretization, run.problem.state().displacements);
  const double back = bent - way;
  const double worst_transfer = dealii::Utilities::MPI::max(transfer.value(), MPI_COMM_WORLD);
  const double worst_change = dealii::Utilities::MPI::max(change.value(), MPI_COMM_WORLD);
  const double strain = maximum(strains), force = max_force(run);

  // It moves on without being driven.
  parameters::Scene moving = without_tools(bending);
  moving.time_stepping.end_time = scene.time_stepping.end_time + 0.2e-3;
  testing::ExplicitStops then(moving, MPI_COMM_WORLD);
  then.load("sprung.h5");
  testing::History motion;
  then.run(moving.time_stepping.end_time, 10, motion);
  then.problem.update_state();
  const double last = deflection(then.discretization, then.problem.state().displacements);
  if (!testing::is_first_rank())
    return;
  check(name + ": is bent plastically", strain > 0.01);
  check(name + ": leaves something behind", report.kinetic_energy > 0. && report.imbalance > 0.);
  check(name + ": same plastic strain", worst_transfer, 1e-4 * strain);
  check(name + ": springs back by a part", back > 0.02 * bent && back < 0.9 * bent);
  // The static element has no hourglass stresses: what they held of an element's bending others take over.
  check(name + ": elastically", worst_change, (has_one_point ? 5e-3 : 1e-6) * strain);
  check(name + ": no forces are left", force, 1e-4);
  check(name + ": comes to where static bending ends", std::abs(way / reference - 1.),
        has_one_point ? 0.05 : 0.01);
  if (!has_one_point) // that again leaves them behind
    check(name + ": stays there", std::abs(last - way) / back, 1e-4);
}

} // namespace

BILLET_MPI_TEST(springback) {
  const parameters::Scene bending = testing::read_test_scene("springback.prm");
  double reference = 0.;
  {
    parameters::Scene scene = make_static(bending);
    scene.time_stepping.initial_step = scene.time_stepping.max_step = 0.1e-3;
    testing::ImplicitSolutionRun run(scene, MPI_COMM_WORLD);
    testing::History ignored;
    run.run(scene.time_stepping.end_time, ignored);
    run.save("pressed.h5");
    parameters::Scene released = without_tools(make_static(bending));
    released.time_stepping.end_time = scene.time_stepping.end_time + 1.;
    testing::ImplicitSolutionRun rest(released, MPI_COMM_WORLD);
    rest.load("pressed.h5");
    rest.run(released.time_stepping.end_time, ignored);
    reference = deflection(rest.discretization, rest.problem.state().displacements);
  }
  for (const std::string name : {"Hencky", "neo-Hookean", "hypoelastic"}) {
    if (name != "Hencky" && testing::n_ranks() > 1) // laws know nothing of ranks
      continue;
    parameters::Scene scene = bending;
    testing::set_elasticity(scene.bodies[0].material, name);
    test(name, scene, reference, false);
  }
  if (testing::n_ranks() > 1)
    return;
  parameters::Scene scene = bending;
  scene.bodies[0].element.value.type = BrickElement::one_point;
  test("One point", scene, reference, true);
}

} // namespace springback_test
