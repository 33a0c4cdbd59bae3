// SPDX-License-Identifier: LGPL-2.1-or-later
// A step that is tried to measure errors, and not taken, leaves nothing behind but where the next iterations
// begin.
#include "scene_run.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

namespace probe_test {

using namespace billet;
using billet::testing::check;
using billet::testing::near;
using billet::testing::SceneRun;

namespace {

/// The largest of a group, as part of it.
double difference(const ImplicitSolution::Results &a, const ImplicitSolution::Results &b) {
  double maximum = a.size() == b.size() ? 0. : 1.;
  for (std::size_t group = 0; group < a.size() && maximum < 1.; ++group)
    maximum = std::max(maximum, distance_of(a[group], b[group]) / size_of(b[group]));
  return maximum;
}

void check_scene(const std::string &name, parameters::Scene parameters, const unsigned int n_steps) {
  parameters.solver.force_tolerance = 1e-11;
  testing::set_fixed_steps(parameters, 2 * n_steps);
  SceneRun tried(parameters), untried(parameters);
  testing::set_fixed_steps(parameters, n_steps);
  SceneRun coarse(parameters);
  for (SceneRun *run : {&tried, &untried, &coarse})
    run->problem.set_penetration_allowed(1e9); // so that there are some, whatever pairs ask for
  coarse.advance();

  testing::WorstError forces, energies;
  unsigned int n_from_probe = 0, n_otherwise = 0;
  for (unsigned int n = 0; n < 4; ++n) {
    const double from = tried.control.time(), to = tried.control.next_time();
    const ImplicitSolution::Probe probe = tried.problem.probe(2. * to - from, n == 0 ? 0. : to - from);
    if (n == 0) {
      check(name + ": a probe gives what the step gives",
            difference(probe.results, coarse.problem.results().accepted()), 1e-8);
    }
    if (n < 2)
      tried.problem.measurement().ask();
    n_from_probe += static_cast<unsigned int>(tried.advance().iterations.size());
    const auto measured = tried.problem.measurement().take();
    check(name + ": the effect of penetrations is measured on request, and returned once",
          measured.has_value() == (n < 2) && !tried.problem.measurement().take());
    if (measured) {
      n_from_probe -= measured->n_iterations;
      check(name + ": that with penetrations is what the step gives",
            difference(measured->with, tried.problem.results().accepted()), 1e-12);
      check(name + ": without it is stiffer",
            !measured->without.empty() && measured->without[0][0].norm() > measured->with[0][0].norm());
      check(name + ": penetrations are seen, whether a pair asks for it or not", measured->penetration > 1.);
    }
    n_otherwise += static_cast<unsigned int>(untried.advance().iterations.size());
    forces.add(difference(tried.problem.results().accepted(), untried.problem.results().accepted()));
    const EnergyLedger &e = tried.problem.state().energies, &f = untried.problem.state().energies;
    energies.add(std::abs(e.plastic - f.plastic) + std::abs(e.elastic - f.elastic) +
                 std::abs(e.friction - f.friction) + std::abs(e.external - f.external));
  }
  check(name + ": forces are those without probes", forces.value(), 1e-8);
  check(name + ": energies are, too", energies.value() / tried.problem.state().energies.external, 1e-8);
  check(name + ": iterations begin nearer to their end", n_from_probe <= n_otherwise);
}

/// Contact that is augmented where it is too soft is so in a probe, too; what that teaches is forgotten.
void check_automatic(parameters::Scene parameters, const unsigned int n_steps) {
  testing::set_fixed_steps(parameters, n_steps);
  SceneRun coarse(parameters);
  coarse.advance();
  testing::set_fixed_steps(parameters, 2 * n_steps);
  SceneRun tried(parameters), untried(parameters);
  const ImplicitSolution::Probe probe = tried.problem.probe(2. * tried.control.next_time(), 0.);
  check("automatic: a probe gives what the step gives",
        difference(probe.results, coarse.problem.results().accepted()), 1e-8);
  tried.advance();
  untried.advance();
  check("automatic: it changes no step",
        difference(tried.problem.results().accepted(), untried.problem.results().accepted()), 5e-3);
}

/// A step that fails, or in which a tool stops after tractions have been augmented, leaves no measurement to
/// the next one, and none that compares two places of the tool.
void check_stop() {
  parameters::Scene parameters = testing::read_shipped_scene("billet_upsetting.prm");
  parameters.pairs[0].penetration_tolerance = 1e-5;
  parameters.tools[0].motion.control = parameters::Motion::Control::stop;
  parameters.tools[0].motion.load.value = "64000";
  parameters.tools[0].motion.direction = dealii::Tensor<1, 3>({0., 0., -1.});
  testing::set_fixed_steps(parameters, 40);
  SceneRun run(parameters);
  run.problem.measurement().ask();
  check("stop: all of it in one step fails", !run.problem.step(1., 0.).converged);
  run.advance();
  check("stop: the step after that measures nothing", !run.problem.measurement().take());
  testing::WorstError change;
  unsigned int n_missed = 0;
  for (unsigned int n = 0; n < 8; ++n) {
    run.problem.measurement().ask();
    run.advance();
    const auto measured = run.problem.measurement().take();
    if (!measured || measured->without.empty())
      ++n_missed;
    else
      change.add(difference(measured->with, run.problem.results().accepted()));
  }
  check("stop: nothing is measured where the tool stops", n_missed == 1);
  check("stop: penetrations make little of the forces", change.value(), 2e-3);
}

/// The force of a tool that a force drives is what it is: errors are those of its travel.
void check_force() {
  parameters::Scene parameters = testing::read_shipped_scene("billet_upsetting.prm");
  parameters::Motion &motion = parameters.tools[0].motion;
  motion.translation.value = {{"0", "0", "0"}};
  motion.control = parameters::Motion::Control::force;
  motion.load.value = "300e3*t";
  motion.direction = dealii::Tensor<1, 3>({0., 0., -1.});
  parameters.solver.force_tolerance = 1e-11;
  testing::set_fixed_steps(parameters, 40);
  SceneRun tried(parameters);
  testing::set_fixed_steps(parameters, 20);
  SceneRun coarse(parameters);
  coarse.advance();
  check("force: forces, and the travel",
        tried.problem.results().names() == std::vector<std::string>{"forces", "travel of 'die'"});
  const ImplicitSolution::Probe probe = tried.problem.probe(0.05, 0.);
  check("force: a probe gives what the step gives",
        difference(probe.results, coarse.problem.results().accepted()), 1e-8);
  for (unsigned int n = 0; n < 2; ++n) {
    tried.problem.measurement().ask();
    tried.advance();
    const auto measured = tried.problem.measurement().take();
    if (!measured || measured->without.empty()) {
      check("force: what penetrations make is measured", false);
      continue;
    }
    check("force: what is with penetrations is what the step gives",
          difference(measured->with, tried.problem.results().accepted()), 1e-12);
    check("force: without penetrations the tool presses as hard, and goes less far",
          near(measured->without[0][0].norm(), measured->with[0][0].norm(), 1e-4) &&
              measured->without[1][0].norm() < measured->with[1][0].norm());
  }
}

} // namespace

BILLET_MPI_TEST(probe) {
  parameters::Scene billet = testing::read_shipped_scene("billet_upsetting.prm");
  check_scene("billet", billet, 20);
  billet.pairs[0].penetration_tolerance = 1e-5;
  check_scene("billet, augmented", billet, 20);
  parameters::Scene ironing = testing::read_shipped_scene("ironing.prm");
  check_automatic(ironing, 70);
  ironing.pairs[0].penetration_tolerance = 0.;
  check_scene("ironing", ironing, 70);
  check_stop();
  check_force();
}

} // namespace probe_test
