// SPDX-License-Identifier: LGPL-2.1-or-later
// In a contact-dominated step with friction slipping, the energy |R·Δu| of the last iterations squares:
// E_{k+1}/E_k ≈ (E_k/E_{k−1})², so the logarithms of successive ratios stand 2 : 1. With the other elements
// and laws steps have fewer iterations; there each relative residual is at most twenty times the square of
// the last.
#include "materials.h"
#include "scene_run.h"

#include <deal.II/base/mpi.h>

namespace newton_is_quadratic_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

/// log(E_{k+1}/E_k) / log(E_k/E_{k−1}) of the last three energies; 0 where the fall has not begun by then.
double order_of_convergence(const std::vector<NewtonIteration> &iterations) {
  const std::size_t n = iterations.size();
  if (n < 3 || iterations[n - 2].energy > 1e-4 * iterations[0].energy ||
      std::abs(iterations[n - 1].step_length - 1.) > 1e-6)
    return 0.;
  return std::log(iterations[n - 1].energy / iterations[n - 2].energy) /
         std::log(iterations[n - 2].energy / iterations[n - 3].energy);
}

/// The largest f_{k+1}/f_k² of corrections that begin below 1e-3 and end above round-off, 1e-11, and their
/// number. A tangent that is wrong by 0.1 % has 1e3 and more.
void test_squares(const std::string &name, const BrickElement element, const std::string &elasticity) {
  parameters::Scene parameters = testing::read_shipped_scene("billet_upsetting.prm");
  parameters.bodies[0].element.value.type = element;
  testing::set_elasticity(parameters.bodies[0].material, elasticity);
  parameters.solver.force_tolerance = 1e-11;
  testing::set_fixed_steps(parameters, 25);
  SceneRun scene(parameters);
  double maximum = 0.;
  unsigned int n = 0;
  scene.finish([&](const NewtonReport &report) {
    for (std::size_t i = 0; i < report.iterations.size(); ++i) {
      const double before = report.iterations[i].force;
      const double after = i + 1 < report.iterations.size() ? report.iterations[i + 1].force : report.force;
      if (before < 1e-3 && after > 1e-11) {
        maximum = std::max(maximum, after / (before * before));
        ++n;
      }
    }
  });
  check(name + ", residuals square", maximum, 20.);
  check(name + ", seen often enough", n >= 5);
}

} // namespace

BILLET_MPI_TEST(newton_is_quadratic) {
  parameters::Scene parameters = testing::read_shipped_scene("billet_upsetting.prm");
  parameters.solver.force_tolerance = 1e-11;
  testing::set_fixed_steps(parameters, 20);
  SceneRun scene(parameters);
  std::vector<double> orders;
  unsigned int n_steps_slipping = 0;
  scene.finish([&](const NewtonReport &report) {
    const double order = order_of_convergence(report.iterations);
    if (order > 0.)
      orders.push_back(order);
    unsigned int n_slipping = 0, n_sticking = 0;
    for (const auto &node : scene.problem.equation().parts().contacts().of_tools()[0].measures().report()) {
      n_slipping += node.status == ContactStatus::slip ? 1 : 0;
      n_sticking += node.status == ContactStatus::stick ? 1 : 0;
    }
    n_steps_slipping += n_slipping > n_sticking ? 1 : 0;
  });
  std::sort(orders.begin(), orders.end());
  check("most of the contact slips in every step", n_steps_slipping == 20);
  check("at least four steps show their order", orders.size() >= 4);
  check("median order of the energy's fall is 2 (at least 1.8)",
        !orders.empty() && orders[orders.size() / 2] >= 1.8);

  using Element = BrickElement;
  // Exact, since friction makes the matrix unsymmetric anyway.
  test_squares("mean dilatation, neo-Hookean", Element::mean_dilatation, "neo-Hookean");
  test_squares("mean dilatation, hypoelastic", Element::mean_dilatation, "hypoelastic");
  test_squares("assumed strain, Hencky", Element::assumed_strain, "Hencky");
  test_squares("assumed strain, hypoelastic", Element::assumed_strain, "hypoelastic");
  test_squares("one point, Hencky", Element::one_point, "Hencky");
  test_squares("one point, hypoelastic", Element::one_point, "hypoelastic");
}

} // namespace newton_is_quadratic_test
