// SPDX-License-Identifier: LGPL-2.1-or-later
// Supports of dynamic scenes that begin and end, on one element with a lumped mass, an oscillator: released
// at once it vibrates with its period; released over a whole period it comes to rest; caught it stays where
// it is. Explicit, and implicit with the trapezoidal rule. Runs that stop on the way go on bit by bit.
#include "billet/integration/time_integrator_type.h"
#include "billet/run/stops.h"

#include "restart_run.h"

#include <deal.II/base/mpi.h>

#include <cmath>
#include <fstream>

namespace timed_supports_in_motion_test {

using namespace billet;
using billet::testing::check;

namespace {

constexpr double young = 1000., release = 0.2, size = 1e-4;
// Half of the mass moves: m = 1/2, k = E.
const double period = 2. * M_PI / std::sqrt(2. * young);

/// A cube that is held at z = 0 and cannot move sideways. Its top is pulled up, comes to rest at the height
/// `size` without an acceleration, and is let go there; it is caught at the time `caught`, or never.
parameters::Scene read(const std::string &scheme, const double fade_time, const double caught) {
  const std::string file = "timed_supports_in_motion.prm";
  std::ofstream text(file);
  text.precision(15);
  text << "subsection Bodies\n  subsection body\n    subsection Mesh\n"
          "      set Primitive = subdivided_hyper_rectangle\n"
          "      set Arguments = 1, 1, 1 : 0, 0, 0 : 1, 1, 1 : true\n    end\n"
          "    subsection Material\n      set Law = elastic\n      set Young modulus = 1000\n"
          "      set Poisson ratio = 0\n      set Density = 1\n    end\n    subsection Supports\n"
          "      subsection foot\n        set Boundary ids = 4\n      end\n"
          "      subsection sides\n        set Boundary ids = 5\n        set Components = x, y\n      end\n"
          "      subsection grip\n        set Boundary ids = 5\n        set Components = z\n"
          "        set Displacement = 0 ; 0 ; 1e-4*(t/0.2 - sin(2*pi*t/0.2)/(2*pi))\n        set Until = "
       << release << "\n        set Fade time = " << fade_time << "\n      end\n";
  if (caught > 0.)
    text << "      subsection catch\n        set Boundary ids = 5\n        set Components = z\n        set "
            "From = "
         << caught << "\n      end\n";
  text << "    end\n  end\nend\nsubsection Time stepping\n  set Scheme = " << scheme
       << "\n  set End time = " << release + 3. * period << "\n";
  if (scheme != "explicit")
    text << "  set Step control = fixed\n  set Initial step = 0.001\n";
  text << "end\nsubsection Output\n  set Format = none\nend\n";
  text.close();
  parameters::Scene scene = parameters::Scene::read(file);
  scene.explicit_dynamics.safety_factor = 0.05;
  scene.explicit_dynamics.linear_viscosity = scene.explicit_dynamics.quadratic_viscosity = 0.;
  scene.implicit_dynamics.mass = parameters::ImplicitDynamics::Mass::lumped;
  scene.implicit_dynamics.error_tolerance = 0.;
  scene.implicit_dynamics.integrator = newmark(0.25, 0.5);
  scene.solver.force_tolerance = 1e-9;
  return scene;
}

/// Displacement of the top over the time.
using Motion = std::vector<std::pair<double, double>>;

double top(const Discretization &discretization, const Vector &displacements) {
  double u = 0.;
  for (const auto &element : discretization.elements(0))
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      if (element.cell->vertex(a)[2] > 0.5)
        u = displacements(element.dofs[3 * a + 2]);
  return u;
}

Motion move_explicitly(const parameters::Scene &parameters, double &drift) {
  testing::ExplicitRun run(parameters);
  const Stops stops(run.scene);
  Motion motion;
  const double end = parameters.time_stepping.end_time;
  while (run.problem.time() < end * (1. - 1e-9)) {
    run.problem.prepare_step(stops.next(run.problem.time()));
    run.problem.update_state();
    drift = std::max(drift, std::abs(run.state().energies.drift()) / (0.5 * young * size * size));
    motion.emplace_back(run.problem.time(), top(run.discretization, run.state().displacements));
    run.problem.finish_step();
  }
  return motion;
}

Motion move_implicitly(const parameters::Scene &parameters, double &drift) {
  testing::SceneRun run(parameters);
  Motion motion;
  run.finish([&](const NewtonReport &) {
    const EnergyLedger &energies = run.problem.state().energies;
    drift = std::max(drift, std::abs(energies.drift()) / (0.5 * young * size * size));
    motion.emplace_back(run.problem.state().time, top(run.discretization, run.problem.state().displacements));
  });
  return motion;
}

/// Largest difference to a motion u(s), where s is the time since the release, from s = `from` on.
template <class Expected> double difference(const Motion &motion, const double from, const Expected &u) {
  testing::WorstError error;
  for (const auto &[time, displacement] : motion)
    if (time - release >= from)
      error.add(std::abs(displacement - u(time - release)) / size);
  return error.value();
}

template <class Move>
void check_motion(const std::string &name, const std::string &scheme, const Move &move) {
  const double omega = 2. * M_PI / period;
  double drift = 0.;
  const Motion at_once = move(read(scheme, 0., 0.), drift);
  check(name + ": released at once, it vibrates",
        difference(at_once, 0., [&](const double s) { return size * std::cos(omega * s); }), 0.1);
  check(name + ": with the same size after two periods",
        difference(at_once, 2. * period, [&](const double s) { return size * std::cos(omega * s); }), 0.1);
  check(name + ": energy balances", drift, 1e-2);

  const Motion slowly = move(read(scheme, period, 0.), drift);
  check(name + ": released over a period, it follows the fading force",
        difference(slowly, 0.,
                   [&](const double s) {
                     return s < period ? size * (1. - s / period + std::sin(omega * s) / (omega * period))
                                       : 0.;
                   }),
        0.05);
  check(name + ": energy balances while the force fades", drift, 1e-2);

  const double caught = 0.8 * period;
  const Motion held = move(read(scheme, 0., release + caught), drift);
  double place = 0.;
  for (const auto &[time, displacement] : held)
    if (time <= (release + caught) * (1. + 1e-9))
      place = displacement;
  check(name + ": caught, it has moved until then", std::abs(place / size - std::cos(omega * caught)), 0.1);
  check(name + ": caught, it stays where it is",
        difference(held, caught * (1. + 1e-9), [&](const double) { return place; }), 1e-9);
  check(name + ": energy balances where it is caught", drift, 2e-2);
}

} // namespace

BILLET_MPI_TEST(timed_supports_in_motion) {
  check_motion("Explicit", "explicit", move_explicitly);
  check_motion("Implicit", "implicit dynamics", move_implicitly);

  const double caught = release + 1.5 * period, end = release + 3. * period;
  const std::vector<double> stops{release + 0.5 * period, caught + 0.2 * period, end - 0.2 * period};
  parameters::Scene scene = read("explicit", period, caught);
  testing::test_going_on<testing::ExplicitStops>(
      "Explicit", scene, stops,
      [](auto &run, const double time, testing::History &history) { run.run(time, 1, history); });
  scene = read("implicit dynamics", period, caught);
  testing::test_going_on<testing::ImplicitSolutionRun>(
      "Implicit", scene, stops,
      [](auto &run, const double time, testing::History &history) { run.run(time, history); });
}

} // namespace timed_supports_in_motion_test
