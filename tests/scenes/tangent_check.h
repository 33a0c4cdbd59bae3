// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_TANGENT_CHECK_H
#define BILLET_TESTS_TANGENT_CHECK_H

#include "materials.h"
#include "scene_run.h"

#include "../geometry/make_surface.h"

namespace billet::testing {

/// Runs to time t, starts one more step, and continues the last increment into it: there K⁻¹ (∂R/∂u v) must
/// be v. Unknown travels of tools are among the u.
inline double tangent_error(SceneRun &run, const double t, const unsigned int n_directions) {
  ImplicitProblem &problem = run.problem.equation();
  run.advance(); // from here on the unknowns of all steps are alike
  Vector before = problem.unknowns(), point = before;
  while (run.control.time() < t) {
    before = problem.unknowns();
    run.advance();
  }
  point = problem.unknowns();
  point.sadd(1.7, -0.7, before);
  problem.start_step(run.control.next_time());
  Vector plus = point, minus = point, difference = point, solution = point, v = point;
  Random random;
  WorstError error;
  for (unsigned int k = 0; k < n_directions; ++k) {
    Vector direction = run.discretization.make_owned_vector();
    const auto &owned = run.discretization.owned_dofs();
    for (const auto i : owned)
      direction(i) = random(-1., 1.);
    direction.compress(dealii::VectorOperation::insert);
    problem.parts().supports().homogeneous().distribute(direction);
    double *const offsets = std::copy(direction.begin(), direction.end(), v.begin());
    std::generate(offsets, v.end(), [&random] { return random(-1., 1.); });
    const double h = 1e-7;
    difference = 0.;
    for (const auto &[offset, weight] :
         {std::pair<double, double>{1., 8.}, {-1., -8.}, {2., -1.}, {-2., 1.}}) {
      plus = point;
      plus.add(offset * h, v);
      if (!problem.compute_residual(plus, minus))
        return 1.;
      difference.add(weight / (12. * h), minus);
    }
    if (!problem.compute_tangent(point) || !problem.solve_tangent(difference, solution, 1e-10))
      return 1.;
    solution -= v;
    error.add(solution.l2_norm() / v.l2_norm());
  }
  return error.value();
}

/// The block is pressed onto a curved tool, shoved and turned over it.
inline parameters::Scene make_curved(const SurfacePart &part, const double friction_coefficient) {
  parameters::Scene scene = parameters::Scene::read(std::string(SOURCE_DIR) + "/block_on_plane.prm");
  scene.bodies[0].supports[0].displacement.value = {"0.04*t", "0.03*t - 0.01*z*t", "-0.08*t"};
  set_hardening(scene.bodies[0].material,
                LinearHardening{1e6, linear_hardening(scene.bodies[0].material).modulus});
  scene.tools[0].surface = make_surface(part.shape, part.lines);
  scene.tools[0].motion.rotation_axis = dealii::Tensor<1, 3>({2. / 7., 3. / 7., 6. / 7.});
  scene.tools[0].motion.rotation_angle.value = "0.05*t";
  scene.tools[0].motion.translation.value = {"0.01*t", "0", "0.01*t"};
  scene.pairs[0].friction = make_coulomb(friction_coefficient);
  scene.pairs[0].initial.allowed_penetration.value = 1.;
  scene.time_stepping.initial_step = 0.25;
  return scene;
}

/// The exact tangent of that scene, most nodes sticking, most slipping, and without friction.
inline void check_curved(const std::string &name, const SurfacePart &part) {
  for (const double friction : {0.8, 0.03, 0.}) {
    const std::string state = friction > 0.5  ? ", much friction"
                              : friction > 0. ? ", little friction"
                                              : ", no friction";
    parameters::Scene scene = make_curved(part, friction);
    scene.solver.contact_tangent = parameters::ContactTangent::exact;
    SceneRun exact(scene);
    check(name + state + ": exact tangent", tangent_error(exact, 0.75, 3), 1e-6);
    unsigned int n_touch = 0, n_stick = 0;
    for (const auto &node : exact.problem.equation().parts().contacts().of_tools()[0].measures().report()) {
      n_touch += node.status != ContactStatus::open;
      n_stick += node.status == ContactStatus::stick;
    }
    check(name + state + ": contact is as meant",
          n_touch > 3 && (friction > 0.5 ? n_stick > 0 : n_stick < n_touch));
  }
}

} // namespace billet::testing

#endif
