// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_RESTART_RUN_H
#define BILLET_TESTS_RESTART_RUN_H

#include "billet/output/checkpoint.h"

#include "explicit_run.h"
#include "scene_run.h"

#include <cstring>

namespace billet::testing {

/// Numbers over time, the same on all ranks.
using History = std::vector<std::vector<double>>;

/// What a step has led to: loads, energies, ways of the tools. Numbers of one kind, such as a vector's, stand
/// together: `kinds`, where it is given, becomes the number of each kind's numbers.
inline std::vector<double> numbers_of(const SolutionState &state, std::vector<std::size_t> *kinds = nullptr) {
  std::vector<double> numbers;
  const auto add = [&](const std::vector<double> &more, const std::vector<std::size_t> &sizes) {
    numbers.insert(numbers.end(), more.begin(), more.end());
    if (kinds != nullptr)
      kinds->insert(kinds->end(), sizes.begin(), sizes.end());
  };
  add({state.time}, {1});
  for (const auto *loads : {&state.tool_loads, &state.body_pair_loads})
    for (const auto &load : *loads)
      add(to_numbers(load), {3, 3, 1, 1, 1, 1});
  for (const auto &placement : state.placements)
    add(to_numbers(placement), {9, 3, 3, 1});
  add(to_numbers(state.energies), {10});
  for (const auto &moment : {state.momentum, state.angular_momentum})
    add({moment[0], moment[1], moment[2]}, {3});
  return numbers;
}

/// Largest difference of two histories, each number relative to the largest of its kind; not a number where
/// they are not as long.
inline double difference(const History &a, const History &b, const std::vector<std::size_t> &kinds) {
  if (a.size() != b.size() || a.empty())
    return std::nan("");
  WorstError error;
  std::size_t begin = 0;
  for (const std::size_t n : kinds) {
    double size = 1e-4; // mm, N: what augmentation leaves of penetrations is round-off
    for (const auto &row : a)
      for (std::size_t k = begin; k < begin + n; ++k)
        size = std::max(size, std::abs(row[k]));
    for (std::size_t i = 0; i < a.size(); ++i)
      for (std::size_t k = begin; k < begin + n; ++k)
        if (a[i][k] != b[i][k])
          error.add(std::abs(a[i][k] - b[i][k]) / size);
    begin += n;
  }
  return error.value();
}

inline bool are_same_bits(const History &a, const History &b) {
  if (a.size() != b.size() || a.empty())
    return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a[i].size() != b[i].size() ||
        std::memcmp(a[i].data(), b[i].data(), a[i].size() * sizeof(double)) != 0)
      return false;
  return true;
}

/// A quasi-static scene that can be stopped and gone on with.
class ImplicitSolutionRun {
public:
  ImplicitSolutionRun(const parameters::Scene &parameters, const MPI_Comm communicator)
      : scene(for_comparison(parameters)), discretization(scene, communicator),
        problem(scene, discretization), control(parameters.time_stepping, 0., scene.stops()) {}

  /// Until this time, all of whose steps it adds to the history.
  void run(const double until, History &history) {
    while (control.time() < until * (1. - 1e-9) && !control.is_finished()) {
      const double from = control.time(), to = control.next_time();
      const NewtonReport report = problem.step(to, previous);
      if (!report.converged) {
        if (!control.reject())
          throw SolutionFailure(report.failure);
        continue;
      }
      control.accept(static_cast<unsigned int>(report.hardest), problem.balance().time_error());
      previous = to - from;
      history.push_back(numbers_of(problem.state()));
    }
  }
  void save(const std::string &file) {
    CheckpointWriter writer(discretization.communicator(), file);
    writer.in("scene", [&] { save_scene(writer, scene, discretization); });
    writer.in("solution", [&] { problem.save(writer); });
    writer.in("steps", [&] {
      control.save(writer);
      writer.write("previous", {previous});
    });
    check_done(writer.finish());
  }
  RestartReport load(const std::string &file, const double release_time = 0.) {
    CheckpointReader reader(discretization.communicator(), file, "test");
    RestartReport report;
    reader.load("scene", [&] { check_scene(reader, scene, discretization); });
    reader.load("solution", [&] { report = problem.load(reader, release_time); });
    control.begin(report.time, 0);
    if (report.is_exact)
      reader.in("steps", [&] {
        control.load(reader);
        previous = reader.number("previous");
      });
    return report;
  }
  static void check_done(const std::string &failure) {
    if (!failure.empty())
      throw SolutionFailure(failure);
  }

  Scene scene;
  Discretization discretization;
  ImplicitSolution problem;
  StepControl control;
  double previous = 0.;
};

/// The same for an explicit one, which looks at the state after each `n_between` steps.
class ExplicitStops {
public:
  ExplicitStops(const parameters::Scene &parameters, const MPI_Comm communicator)
      : scene(parameters), discretization(scene, communicator), problem(scene, discretization) {}

  void run(const double until, const unsigned int n_between, History &history) {
    const double end = scene.parameters().time_stepping.end_time;
    while (problem.time() < until) {
      problem.prepare_step(end);
      if (problem.n_steps() % n_between == 0) {
        problem.update_state();
        history.push_back(numbers_of(problem.state()));
      }
      problem.finish_step();
    }
  }
  void save(const std::string &file) {
    CheckpointWriter writer(discretization.communicator(), file);
    writer.in("scene", [&] { save_scene(writer, scene, discretization); });
    writer.in("solution", [&] { problem.save(writer); });
    ImplicitSolutionRun::check_done(writer.finish());
  }
  RestartReport load(const std::string &file) {
    CheckpointReader reader(discretization.communicator(), file, "test");
    RestartReport report;
    reader.load("scene", [&] { check_scene(reader, scene, discretization); });
    reader.load("solution", [&] { report = problem.load(reader); });
    return report;
  }

  Scene scene;
  Discretization discretization;
  ExplicitDynamics problem;
};

inline History after(const History &all, const double time) {
  History rest;
  for (const auto &row : all)
    if (row[0] > time * (1. + 1e-9))
      rest.push_back(row);
  return rest;
}

/// Goes on from each of these times, on all numbers of ranks to as many as there are, and the other way
/// round. One run saves at all of them, which changes nothing: on one rank it is compared with one that does
/// not save.
template <class Run, class Until>
void test_going_on(const std::string &name, const parameters::Scene &scene, const std::vector<double> &stops,
                   const Until &until, const double tolerance = 1e-8) {
  const double end = scene.time_stepping.end_time;
  parameters::Scene resumed = scene;
  const auto file_of = [](const std::size_t i) { return "stopped_" + std::to_string(i) + ".h5"; };
  History on_one;
  std::vector<std::size_t> kinds;
  for (unsigned int n = 1; n <= n_ranks(); ++n) {
    History whole;
    std::vector<double> times;
    on_ranks(n, [&](MPI_Comm some) {
      Run run(scene, some);
      for (std::size_t i = 0; i < stops.size(); ++i) {
        until(run, stops[i], whole);
        run.save(file_of(i));
        times.push_back(whole.back()[0]);
      }
      if (n_ranks() > 1)
        until(run, end, whole);
      kinds.clear();
      numbers_of(run.problem.state(), &kinds);
    });
    if (n_ranks() == 1) {
      const History saved = whole;
      whole.clear();
      Run run(scene, MPI_COMM_WORLD);
      until(run, end, whole);
      check(name + " saves without a change",
            whole.size() > saved.size() &&
                are_same_bits(saved, {whole.begin(), whole.begin() + saved.size()}));
    }
    if (n == 1)
      on_one = whole;
    else if (is_first_rank())
      check(name + " without interruption, on 1 and on other ranks", difference(on_one, whole, kinds),
            tolerance);
    for (std::size_t i = 0; i < stops.size(); ++i) {
      resumed.restart.file.value = file_of(i);
      for (unsigned int now = 1; now <= n_ranks(); ++now) {
        if (n < n_ranks() && now < n_ranks()) // the same program does this on fewer ranks
          continue;
        History rest;
        on_ranks(now, [&](MPI_Comm some) {
          Run run(resumed, some);
          const RestartReport report = run.load(file_of(i));
          if (is_first_rank())
            check(name + " goes on", report.is_exact);
          until(run, end, rest);
        });
        if (!is_first_rank())
          continue;
        const History expected = after(whole, times[i]);
        const std::string what = name + " from " + std::to_string(stops[i] / end);
        // MUMPS on several ranks adds up in the order in which messages come.
        const bool has_solver = std::is_same_v<Run, ImplicitSolutionRun>;
        if (n == now && has_solver && n > 1)
          check(what + ", as many ranks", difference(expected, rest, kinds), 1e-8);
        else if (n == now)
          check(what + ", as many ranks, bit by bit", are_same_bits(expected, rest));
        else
          check(what + ", other ranks", difference(expected, rest, kinds), tolerance);
      }
    }
  }
}

} // namespace billet::testing

#endif
