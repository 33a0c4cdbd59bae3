// SPDX-License-Identifier: LGPL-2.1-or-later
// An elastic bar on a rigid wall, against the wave solution: it touches from 20 to 100 µs, with the force of
// a shock at finite strain, 1.624 MN (1.6 MN, ρ c v A, at small ones), and flies back with all of its energy.
#include "explicit_run.h"

#include <deal.II/base/mpi.h>

namespace explicit_bar_test {

using namespace billet;
using billet::testing::check;

namespace {

/// Fronts are some elements wide: `rise` and `fall` are where half of the force is passed.
struct Impact {
  double begin = 0., rise = 0., fall = 0., force = 0., drift = 0., rebound = 0.;
};

Impact run(const unsigned int n, const double penalty) {
  parameters::Scene scene = testing::read_test_scene("elastic_bar.prm");
  scene.bodies[0].mesh.arguments = std::to_string(n) + ", 2, 2 : 0.002, 0, 0 : 0.202, 0.02, 0.02 : true";
  scene.pairs[0].penalty.normal = penalty;
  testing::ExplicitRun bar(scene);
  Impact impact;
  unsigned int n_on_plateau = 0;
  double last_time = 0., last_force = 0.;
  double initial_momentum = 0.;
  bar.finish(0.25e-6, [&] {
    const double t = bar.state().time, force = bar.state().tool_loads[0].force[0];
    if (t == 0.)
      initial_momentum = bar.state().momentum[0];
    if (force > 0. && impact.begin == 0.)
      impact.begin = t;
    constexpr double half = 0.8e6;
    if ((force > half) != (last_force > half))
      (force > half ? impact.rise : impact.fall) =
          last_time + (t - last_time) * (half - last_force) / (force - last_force);
    last_time = t;
    last_force = force;
    if (t > 40e-6 && t < 80e-6) { // away from the fronts
      impact.force += force;
      ++n_on_plateau;
    }
    impact.rebound = -bar.state().momentum[0] / initial_momentum;
  });
  impact.force /= n_on_plateau;
  impact.drift = bar.worst_drift;
  return impact;
}

} // namespace

BILLET_MPI_TEST(explicit_bar) {
  const Impact coarse = run(40, 1.), fine = run(160, 1.);
  check("touches after gap over velocity", std::abs(fine.begin / 20e-6 - 1.), 0.02);
  const auto duration_error = [](const Impact &i) { return std::abs((i.fall - i.rise) / 80e-6 - 1.); };
  // With ν = 0 the stress per undeformed area is E ln λ/λ. A shock to the strain ε = 1 − λ goes at v/ε, and
  // ρ v²/ε is the stress behind it: −ε ln(1 − ε)/(1 − ε) = ρ v²/E = 4e-4, ε = 0.0197039.
  const auto force_error = [](const Impact &i) { return std::abs(i.force / 1.624046e6 - 1.); };
  check("lasts for two passages of the wave", duration_error(fine), 0.02);
  check("with the force of a shock", force_error(fine), 2e-4);
  check("with the coarser mesh, too", force_error(coarse), 1e-3);
  check("lasts better with the finer mesh", duration_error(fine) < duration_error(coarse));
  check("flies back with its momentum", std::abs(fine.rebound - 1.), 0.01);
  for (const double penalty : {0.1, 1., 10.}) {
    std::cout << "penalty " << penalty << " E/h: ";
    check("energy", run(80, penalty).drift, 1e-3);
  }
}

} // namespace explicit_bar_test
