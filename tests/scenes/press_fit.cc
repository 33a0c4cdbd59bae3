// SPDX-License-Identifier: LGPL-2.1-or-later
// Two rings of one material with the interference d, plane strain (Lamé; Timoshenko & Goodier, Theory of
// Elasticity, 1970, §28): with radii a, b, c and E' = E/(1 − ν²) the pressure between them is
//   p = E' d/b (b² − a²)(c² − b²)/(2 b² (c² − a²)),
// the hoop stress −p b²/(b² − a²)(1 + a²/r²) in the inner and p b²/(c² − b²)(1 + c²/r²) in the outer one.
#include "scene_run.h"

#include <deal.II/base/mpi.h>

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

constexpr double E = 2e5, nu = 0.3, a = 10., b = 20., c = 30., d = 0.01;
const double p =
    E / (1. - nu * nu) * d / b * (b * b - a * a) * (c * c - b * b) / (2. * b * b * (c * c - a * a));

struct Errors {
  double pressure, hoop; ///< the farthest, in the root mean square
};

Errors run(const unsigned int n, const double tolerance) {
  auto scene = testing::read_shipped_scene("press_fit.prm");
  for (unsigned int body = 0; body < 2; ++body)
    scene.bodies[body].mesh.arguments =
        std::to_string(n / 2) + ", " + std::to_string(n) +
        ", 1 : " + (body == 0 ? "10, 0, 0 : 20.01, 90, 1" : "20, 0, 0 : 30, 90, 1") + " : true";
  scene.pairs[0].penetration_tolerance = tolerance;
  SceneRun fit(scene);
  fit.finish();
  Errors errors{0., 0.};
  for (const auto &node : fit.problem.body_contact(0).report())
    if (node.area > 0.)
      errors.pressure = std::max(errors.pressure, std::abs(node.pressure / p - 1.));
  double square = 0., exact_square = 0.;
  for (unsigned int body = 0; body < 2; ++body) {
    const auto stresses = fit.problem.summarize(body);
    for (std::size_t i = 0; i < stresses.size(); ++i) {
      const auto x = fit.discretization.elements(body)[i].cell->center();
      const double r = std::hypot(x[0], x[1]);
      const dealii::Tensor<1, 3> along({-x[1] / r, x[0] / r, 0.});
      const double hoop = along * (stresses[i].cauchy_stress * along);
      const double exact = body == 0 ? -p * b * b / (b * b - a * a) * (1. + a * a / (r * r))
                                     : p * b * b / (c * c - b * b) * (1. + c * c / (r * r));
      square += (hoop - exact) * (hoop - exact);
      exact_square += exact * exact;
    }
  }
  errors.hoop = std::sqrt(square / exact_square);
  return errors;
}

} // namespace

int main(int argc, char *argv[]) {
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const Errors springs = run(16, 0.), coarse = run(8, 1e-5), fine = run(16, 1e-5);
  check("pressure, penalty alone", springs.pressure, 0.01);
  check("hoop stress, penalty alone", springs.hoop, 0.01);
  check("pressure, augmented", fine.pressure, 0.01);
  check("hoop stress, augmented", fine.hoop, 1.5e-3);
  check("the hoop stress converges at second order", fine.hoop, 0.3 * coarse.hoop);
  return testing::exit_code();
}
