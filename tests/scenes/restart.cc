// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs that stop and go on, through a file: the rest is that of the run without interruption, bit by bit on
// as many ranks, to 1e-8 on others. A press with friction, plasticity, a tool with a force, one that stops,
// one that is taken away; an impact with all that an explicit scene may have, also at the removal of its
// tool; a ring that touches itself.
#include "../sample_laws.h"
#include "materials.h"
#include "restart_run.h"

#include <deal.II/base/mpi.h>

namespace restart_test {

using namespace billet;
using billet::testing::check;
using billet::testing::History;

BILLET_MPI_TEST(restart) {
  // On several ranks fewer stops, and no formulations that know nothing of ranks.
  const bool is_alone = testing::n_ranks() == 1;
  const auto stops = [&](const std::vector<double> &all, const double on_ranks) {
    return is_alone ? all : std::vector<double>{on_ranks};
  };
  {
    parameters::Scene scene = testing::read_test_scene("restart_press.prm");
    // What Newton's method leaves, and how many iterations it takes, depends on round-off, and so on the
    // ranks.
    scene.solver.force_tolerance = 1e-11;
    testing::set_fixed_steps(scene, 10);
    if (!is_alone) // whether to augment once more may hang on round-off, and so on ranks
      for (auto &pair : scene.pairs)
        pair.penetration_tolerance = 0.;
    testing::test_going_on<testing::ImplicitSolutionRun>(
        "Press", scene, stops({0.3, 0.6, 0.9}, 0.6),
        [](auto &run, const double time, History &history) { run.run(time, history); });
  }
  if (is_alone) {
    parameters::Scene scene = testing::read_test_scene("restart_press.prm");
    scene.solver.force_tolerance = 1e-11;
    scene.bodies[0].element.value.type = BrickElement::one_point;
    testing::set_elasticity(scene.bodies[0].material, "hypoelastic");
    for (auto &pair : scene.pairs)
      pair.penetration_tolerance = 0.; // whether to augment once more may hang on round-off, and so on ranks
    testing::set_fixed_steps(scene, 10);
    testing::test_going_on<testing::ImplicitSolutionRun>(
        "Press, one point, hypoelastic", scene, {0.6},
        [](auto &run, const double time, History &history) { run.run(time, history); });
  }
  {
    parameters::Scene scene = testing::read_test_scene("raised_penalties.prm"); // in the first steps
    scene.solver.force_tolerance = 1e-11;
    scene.time_stepping.end_time = 0.5e-4;
    scene.amplitudes[0].values.back() *= 10.;     // forces well above round-off of the raised penalties
    scene.implicit_dynamics.error_tolerance = 0.; // steps are fixed
    testing::set_fixed_steps(scene, 10);
    testing::test_going_on<testing::ImplicitSolutionRun>(
        "Raises", scene, stops({0.1e-4, 0.15e-4}, 0.15e-4),
        [](auto &run, const double time, History &history) { run.run(time, history); });
  }
  {
    parameters::Scene scene = testing::read_test_scene("explicit_ranks.prm");
    scene.time_stepping.end_time = 0.1e-3;
    scene.tools[0].motion.removal_time.value = 0.06e-3;
    scene.tools[0].motion.release_time = 0.02e-3;
    testing::test_going_on<testing::ExplicitStops>(
        "Impact", scene, stops({0.04e-3, 0.06e-3, 0.07e-3}, 0.06e-3), // the second: at the removal
        [](auto &run, const double time, History &history) { run.run(time, 1, history); });
  }
  {
    parameters::Scene scene = testing::read_test_scene("explicit_ranks.prm");
    scene.explicit_dynamics.number_type = NumberType::float_precision;
    scene.time_stepping.end_time = 0.1e-3;
    parameters::Material &material = scene.bodies[1].material; // whose points also store their plastic work
    material.law = material.elasticity->make_plastic_law(
        testing::at_rate(testing::linear_hardening(material), testing::cowper_symonds(1e4, 5.)));
    // Which elements stand together in a batch decides how many terms of a series all of them take.
    testing::test_going_on<testing::ExplicitStops>(
        "Impact in float", scene, {0.04e-3},
        [](auto &run, const double time, History &history) { run.run(time, 1, history); }, 1e-5);
  }
  if (is_alone) {
    parameters::Scene scene = testing::read_test_scene("hard_blow.prm"); // deep, on areas from before
    scene.bodies[0].initial_velocity.value = {"100", "200", "-1000"};
    scene.pairs[0].friction = make_coulomb(0.1);
    scene.time_stepping.end_time = 0.4e-3;
    testing::test_going_on<testing::ExplicitStops>(
        "Deep blow", scene, {0.2e-3},
        [](auto &run, const double time, History &history) { run.run(time, 1, history); });
  }
  {
    parameters::Scene scene = testing::read_test_scene("restart_ring.prm");
    double area = 0.;
    testing::test_going_on<testing::ExplicitStops>(
        "Ring", scene, stops({2.5e-6, 4e-6}, 4e-6), [&](auto &run, const double time, History &history) {
          run.run(time, 1, history);
          for (const auto &row : history)
            area = std::max(area, row[7]); // no tools: after time, force and moment
        });
    if (testing::is_first_rank())
      check("Ring touches itself", area > 0.);
  }
}

} // namespace restart_test
