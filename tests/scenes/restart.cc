// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs that stop and go on, through a file: the rest is that of the run without interruption, bit by bit on
// as many ranks, to 1e-8 on others. A press with friction, plasticity, a tool with a force, one that stops,
// one that is taken away; an impact with all that an explicit scene may have; a ring that touches itself.
#include "restart_run.h"

#include <deal.II/base/mpi.h>

using namespace billet;
using billet::testing::check;
using billet::testing::History;

namespace {

unsigned int n_ranks() { return dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD); }

History after(const History &all, const double time) {
  History rest;
  for (const auto &row : all)
    if (row[0] > time * (1. + 1e-9))
      rest.push_back(row);
  return rest;
}

/// Stops at each of these times.
template <class Run, class Until>
void test(const std::string &name, const parameters::Scene &scene, const std::vector<double> &stops,
          const Until &until) {
  const double end = scene.time_stepping.end_time;
  History on_one;
  std::vector<std::size_t> kinds;
  for (unsigned int n = 1; n <= n_ranks(); ++n) {
    History whole;
    testing::on_ranks(n, [&](MPI_Comm some) {
      Run run(scene, some);
      until(run, end, whole);
      kinds.clear();
      testing::numbers_of(run.problem.state(), &kinds);
    });
    if (n == 1)
      on_one = whole;
    else if (testing::is_first_rank())
      check(name + " without interruption, on 1 and on other ranks",
            testing::difference(on_one, whole, kinds), 1e-8);
    for (const double stop : stops) {
      double time = 0.;
      testing::on_ranks(n, [&](MPI_Comm some) {
        Run run(scene, some);
        History ignored;
        until(run, stop, ignored);
        run.save("stopped.h5");
        time = ignored.back()[0];
      });
      for (unsigned int now = 1; now <= n_ranks(); ++now) {
        History rest;
        testing::on_ranks(now, [&](MPI_Comm some) {
          Run run(scene, some);
          const RestartReport report = run.load("stopped.h5");
          if (testing::is_first_rank())
            check(name + " goes on", report.is_exact);
          until(run, end, rest);
        });
        if (!testing::is_first_rank())
          continue;
        const History expected = after(whole, time);
        const std::string what = name + " from " + std::to_string(stop / end);
        // MUMPS on several ranks adds up in the order in which messages come.
        const bool has_solver = std::is_same_v<Run, testing::QuasiStaticRun>;
        if (n == now && has_solver && n > 1)
          check(what + ", as many ranks", testing::difference(expected, rest, kinds), 1e-8);
        else if (n == now)
          check(what + ", as many ranks, bit by bit", testing::are_same_bits(expected, rest));
        else
          check(what + ", other ranks", testing::difference(expected, rest, kinds), 1e-8);
      }
    }
  }
}

} // namespace

int main(int argc, char *argv[]) {
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  {
    parameters::Scene scene = testing::read_test_scene("restart_press.prm");
    // What Newton's method leaves, and how many iterations it takes, depends on round-off, and so on the
    // ranks.
    scene.solver.force_tolerance = 1e-11;
    testing::set_fixed_steps(scene, 25);
    test<testing::QuasiStaticRun>(
        "Press", scene, {0.3, 0.6, 0.9},
        [](auto &run, const double time, History &history) { run.run(time, history); });
  }
  {
    parameters::Scene scene = testing::read_test_scene("explicit_ranks.prm");
    scene.time_stepping.end_time = 0.1e-3;
    scene.tools[0].motion.removal_time.value = 0.06e-3;
    scene.tools[0].motion.release_time = 0.02e-3;
    test<testing::ExplicitStops>(
        "Impact", scene, {0.04e-3, 0.07e-3},
        [](auto &run, const double time, History &history) { run.run(time, 1, history); });
  }
  {
    parameters::Scene scene = testing::read_test_scene("restart_ring.prm");
    double area = 0.;
    test<testing::ExplicitStops>("Ring", scene, {2.5e-6, 4e-6},
                                 [&](auto &run, const double time, History &history) {
                                   run.run(time, 1, history);
                                   for (const auto &row : history)
                                     area = std::max(area, row[7]); // no tools: after time, force and moment
                                 });
    if (testing::is_first_rank())
      check("Ring touches itself", area > 0.);
  }
  return testing::exit_code();
}
