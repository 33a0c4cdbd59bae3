// SPDX-License-Identifier: LGPL-2.1-or-later
// Springback of a perfectly plastic strip with 2 to 7 points through its one brick against the closed form;
// it continues from a checkpoint to the last bit, also on other ranks, and from other numbers of points.

#include "materials.h"
#include "restart_run.h"

#include <deal.II/base/mpi.h>

namespace points_through_test {

using namespace billet;
using billet::testing::check;

namespace {

parameters::Scene read(const unsigned int n_points) {
  parameters::Scene scene = testing::read_test_scene("points_through.prm");
  scene.solver.force_tolerance = 1e-10;
  scene.solver.energy_tolerance = 1e-20;
  scene.bodies[0].element.value.points_through = n_points;
  if (n_points == 2)
    scene.bodies[0].element.value.thickness_direction.clear();
  return scene;
}

constexpr double length = 4., plane_modulus = 1e5 / (1. - 0.45 * 0.45), inertia = 1. / 12.;
const double limit = 2. / std::sqrt(3.) * 100. / 4., ///< M_p
    limit_curvature = limit / (plane_modulus * inertia);

/// Curvature that springs back from `curvature`, per M_p/(E'I): the line through the moments of the way back.
double spring_back(const unsigned int n_points, const double curvature) {
  parameters::Scene scene = read(n_points);
  std::ostringstream displacement;
  displacement.precision(17);
  displacement << length * curvature << "*z*bend";
  scene.bodies[0].supports[1].displacement.value[0] = displacement.str();
  testing::ImplicitSolutionRun run(scene, MPI_COMM_WORLD);
  testing::History history;
  std::vector<double> works, curvatures;
  for (double t = 1.; t < 1.35; t += 0.1) {
    run.run(t, history);
    works.push_back(run.problem.state().energies.external);
    curvatures.push_back(curvature * (1. - 0.4 * (t - 1.)));
  }
  const auto moment = [&](const std::size_t i) {
    return (works[i + 1] - works[i]) / (curvatures[i + 1] - curvatures[i]) / length;
  };
  const double first = 0.5 * (curvatures[0] + curvatures[1]), second = 0.5 * (curvatures[1] + curvatures[2]);
  const double residual = first - moment(0) * (first - second) / (moment(0) - moment(1));
  return (curvature - residual) / limit_curvature;
}

void test_springback() {
  const std::vector<double> tolerances = {0.19, 0.13, 0.05, 0.025};
  for (const double multiple : {1., 3.}) { // of the limit curvature
    const double first_yield = 2. / 3. / multiple, exact = 1. - first_yield * first_yield / 3.;
    double of_two = 0.;
    for (std::size_t k = 0; k < all_points_through.size(); ++k) {
      const unsigned int n = all_points_through[k];
      const double error = std::abs(spring_back(n, multiple * limit_curvature) / exact - 1.);
      if (!testing::is_first_rank())
        continue;
      const std::string name = "springback at " + std::to_string(static_cast<int>(multiple)) + ", " +
                               std::to_string(n) + " points";
      check(name, error, tolerances[k]);
      if (n == 2)
        of_two = error;
      else if (n > 3)
        check(name + ", twice as close as two points", error < 0.5 * of_two);
    }
  }
}

double mean_plastic_strain(const Solution &solution, const MPI_Comm communicator) {
  double sum = 0.;
  for (const auto &summary : solution.summarize(0))
    sum += summary.equivalent_plastic_strain;
  return dealii::Utilities::MPI::sum(sum, communicator);
}

/// A scene with another number of points takes over displacements and mean plastic strain.
void test_transfer(const unsigned int from, const unsigned int to, const std::string &direction) {
  double strain = 0.;
  {
    testing::ImplicitSolutionRun run(read(from), MPI_COMM_WORLD);
    testing::History ignored;
    run.run(1., ignored);
    strain = mean_plastic_strain(run.problem, MPI_COMM_WORLD);
    run.save("layers.h5");
  }
  parameters::Scene scene = read(to);
  scene.bodies[0].element.value.thickness_direction.clear();
  if (to > 2)
    scene.bodies[0].element.value.thickness_direction = {"0", "0", direction};
  scene.restart.file.value = "layers.h5";
  testing::ImplicitSolutionRun run(scene, MPI_COMM_WORLD);
  const RestartReport report = run.load(scene.restart.file.value);
  const double found = mean_plastic_strain(run.problem, MPI_COMM_WORLD);
  testing::History history;
  run.run(1.2, history);
  if (!testing::is_first_rank())
    return;
  const std::string name =
      std::to_string(from) + " to " + std::to_string(to) + " points, direction " + direction;
  check(name + ", is another state", !report.is_exact);
  check(name + ", plastic strain", std::abs(found / strain - 1.), 1e-9);
  check(name + ", continues", !history.empty());
}

} // namespace

BILLET_MPI_TEST(points_through) {
  const bool is_alone = testing::n_ranks() == 1;
  if (is_alone)
    test_springback();
  parameters::Scene scene = read(5);
  testing::test_going_on<testing::ImplicitSolutionRun>(
      "Five points", scene, is_alone ? std::vector<double>{0.8, 1.4} : std::vector<double>{0.8},
      [](auto &run, const double time, testing::History &history) { run.run(time, history); });
  test_transfer(7, 2, "1");
  if (!is_alone)
    return;
  testing::set_elasticity(scene.bodies[0].material, "hypoelastic");
  testing::test_going_on<testing::ImplicitSolutionRun>(
      "Five points, hypoelastic", scene, {0.8},
      [](auto &run, const double time, testing::History &history) { run.run(time, history); });
  test_transfer(2, 7, "1");
  test_transfer(3, 5, "1");
  test_transfer(5, 5, "-1");
}

} // namespace points_through_test
