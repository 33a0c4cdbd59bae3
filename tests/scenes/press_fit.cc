// SPDX-License-Identifier: LGPL-2.1-or-later
// Two rings of one material with the interference d, plane strain (Lamé; Timoshenko & Goodier, Theory of
// Elasticity, 1970, §28): with radii a, b, c and E' = E/(1 − ν²) the pressure between them is
//   p = E' d/b (b² − a²)(c² − b²)/(2 b² (c² − a²)),
// the hoop stress −p b²/(b² − a²)(1 + a²/r²) in the inner and p b²/(c² − b²)(1 + c²/r²) in the outer one.
// Where the bore is held and drawn inwards by s, the displacement of the inner ring is u = A r + B/r with
//   u(a) = −s,   σ_r(b) = E/((1 + ν)(1 − 2ν)) (A − (1 − 2ν) B/b²) = −p,
// and d = u_outer(b) − u(b) with u_outer(b) = p b/E' ((c² + b²)/(c² − b²) + ν/(1 − ν)), until p would fall
// below 0 and the rings part. Pushed back, they fit as before.
#include "unloaded.h"

#include <deal.II/base/mpi.h>

namespace press_fit_test {

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

parameters::Scene read_scene(const unsigned int n, const double tolerance) {
  auto scene = testing::read_shipped_scene("press_fit.prm");
  for (unsigned int body = 0; body < 2; ++body)
    scene.bodies[body].mesh.arguments =
        std::to_string(n / 2) + ", " + std::to_string(n) +
        ", 1 : " + (body == 0 ? "10, 0, 0 : 20.01, 90, 1" : "20, 0, 0 : 30, 90, 1") + " : true";
  scene.pairs[0].penetration_tolerance = tolerance;
  return scene;
}

/// With this pressure between the rings, and stresses that make up the hoop stress A ± B/r² of each.
Errors find_errors(const SceneRun &fit, const double p, const std::array<std::array<double, 2>, 2> &hoops) {
  Errors errors{0., 0.};
  for (const auto &node : fit.problem.equation().parts().contacts().of_bodies()[0].measures().report())
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
      const double exact = hoops[body][0] + hoops[body][1] / (r * r);
      square += (hoop - exact) * (hoop - exact);
      exact_square += exact * exact;
    }
  }
  errors.hoop = std::sqrt(square / exact_square);
  return errors;
}

/// Constants of the hoop stress of the outer ring under the pressure p.
std::array<double, 2> outer_hoop(const double p) {
  const double mean = p * b * b / (c * c - b * b);
  return {mean, mean * c * c};
}

Errors run(const unsigned int n, const double tolerance) {
  SceneRun fit(read_scene(n, tolerance));
  fit.finish();
  const double mean = -p * b * b / (b * b - a * a);
  return find_errors(fit, p, {{{mean, mean * a * a}, outer_hoop(p)}});
}

/// The bore drawn inwards by so much: the pressure, A and B of the inner ring.
struct DrawnRing {
  double pressure, A, B;

  explicit DrawnRing(const double s) {
    const double stiffness = E / (1. + nu) / (1. - 2. * nu), part = (1. - 2. * nu) / (b * b);
    const double outer = b * (1. - nu * nu) / E * ((c * c + b * b) / (c * c - b * b) + nu / (1. - nu));
    // A = part B − p/stiffness from the second condition, B from the first.
    const double of_s = -s / (part * a + 1. / a), of_p = a / stiffness / (part * a + 1. / a);
    // d = outer p − (part b + 1/b)(of_s + of_p p) + b p/stiffness
    const double shape = part * b + 1. / b;
    pressure = std::max(0., (d + shape * of_s) / (outer - shape * of_p + b / stiffness));
    B = of_s + of_p * pressure;
    A = part * B - pressure / stiffness;
  }

  /// λ (u' + u/r) + 2μ u/r
  std::array<double, 2> hoop() const { return {E / (1. + nu) / (1. - 2. * nu) * A, E / (1. + nu) * B}; }
};

/// Held until 1; drawn inwards by up to 0.03 until 3, and pushed back until 4.
void test_pulling_apart() {
  parameters::Scene scene = read_scene(16, 0.);
  parameters::Support bore;
  bore.name = "bore";
  bore.boundary_ids.value = {0};
  bore.components = {true, true, false};
  for (unsigned int i = 0; i < 2; ++i)
    bore.displacement.value[i] =
        std::string("(0.0045*max(0, t - 3) - 0.0015*max(0, t - 1))*") + (i == 0 ? "x" : "y");
  bore.displacement.value[2] = "0";
  scene.bodies[0].supports.push_back(bore);
  scene.time_stepping.end_time = 4.;
  testing::set_fixed_steps(scene, 12);
  SceneRun fit(scene);
  const SolutionState &state = fit.problem.state();
  dealii::Tensor<1, 3> force;
  double stored = 0.;
  const auto compare = [&](const std::string &name, const double s) {
    const DrawnRing exact(s);
    const Errors errors = find_errors(fit, exact.pressure, {{exact.hoop(), outer_hoop(exact.pressure)}});
    check(name + ": pressure", errors.pressure, 0.01);
    check(name + ": hoop stress", errors.hoop, 0.01);
  };
  fit.finish([&](const NewtonReport &) {
    if (std::abs(state.time - 1.) < 1e-9) {
      compare("bore held", 0.);
      force = state.body_pair_loads[0].force;
      stored = state.energies.elastic;
    } else if (std::abs(state.time - 5. / 3.) < 1e-9) {
      compare("bore drawn in", 0.01);
    } else if (std::abs(state.time - 3.) < 1e-9) {
      check("bore drawn in farther: nothing touches",
            testing::is_open(fit) && state.body_pair_loads[0].force.norm() == 0.);
      compare("bore drawn in farther", 0.03);
      testing::WorstError left;
      for (const auto &element : fit.problem.summarize(1))
        left.add(element.cauchy_stress.norm() / p);
      check("bore drawn in farther: no stress in the outer ring", left.value(), 1e-8);
    }
  });
  check("bore pushed back: force", (state.body_pair_loads[0].force - force).norm() / force.norm(), 1e-6);
  check("bore pushed back: energy", std::abs(state.energies.elastic / stored - 1.), 1e-6);
}

/// The ramp in many small steps, with all facets on the verge of contact in the first; and deeper than
/// contact is found.
void test_ramp() {
  parameters::Scene scene = read_scene(16, 0.);
  testing::set_fixed_steps(scene, 20);
  SceneRun fit(scene);
  fit.finish();
  const double mean = -p * b * b / (b * b - a * a);
  check("ramp in 20 steps: pressure", find_errors(fit, p, {{{mean, mean * a * a}, outer_hoop(p)}}).pressure,
        0.01);
  scene.bodies[0].mesh.arguments = "8, 16, 1 : 10, 0, 0 : 20.9, 90, 1 : true";
  bool is_refused = false;
  try {
    SceneRun(scene).finish();
  } catch (const InputError &error) {
    is_refused =
        std::string(error.what()).find("contact detects a penetration of up to") != std::string::npos;
  }
  check("too deep for contact to be found: refused", is_refused);
}

} // namespace

BILLET_MPI_TEST(press_fit) {
  const Errors springs = run(16, 0.), coarse = run(8, 1e-5), fine = run(16, 1e-5);
  check("pressure, penalty alone", springs.pressure, 0.01);
  check("hoop stress, penalty alone", springs.hoop, 0.01);
  check("pressure, augmented", fine.pressure, 0.01);
  check("hoop stress, augmented", fine.hoop, 1.5e-3);
  check("the hoop stress converges at second order", fine.hoop, 0.3 * coarse.hoop);
  test_pulling_apart();
  test_ramp();
  // Chords of different lengths reach into each other in the middle of facets: shifted, nothing presses.
  auto shifted = testing::read_shipped_scene("press_fit.prm");
  shifted.bodies[1].mesh.arguments = "6, 18, 1 : 20, 0, 0 : 30, 90, 1 : true";
  shifted.pairs[0].initial.ramp_time = 0.;
  SceneRun rings(shifted);
  rings.finish();
  check("shifted rings whose meshes do not fit: no force",
        rings.problem.state().body_pair_loads[0].force.norm() / (p * b), 1e-7);
}

} // namespace press_fit_test
