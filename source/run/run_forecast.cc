// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/run_forecast.h"

#include "billet/algebra/gather.h"
#include "billet/errors.h"
#include "billet/fail_together.h"
#include "billet/run/body_course.h"
#include "billet/run/body_report.h"
#include "billet/times.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace billet {

namespace mpi = dealii::Utilities::MPI;

namespace {

/// Memory in bytes, from the resident memory of --check and of runs. Blocks of 8000 to 216000
/// elements were checked; multigrid is that of doc/results/linear-solvers.md.
struct Memory {
  static constexpr double process = 185e6; ///< the program and its libraries, for each rank
  static constexpr double explicit_element = 2.4e3;
  static constexpr double implicit_element = 3.5e3;     ///< without the matrix
  static constexpr double matrix_dof = 81. * (8. + 4.); ///< of 27 nodes around each
  static constexpr double multigrid_dof = 2.2e3;
};

double memory_of_process(const Discretization &discretization) {
  return Memory::process * mpi::n_mpi_processes(discretization.communicator());
}

/// Returns the number of elements at the end of the run over that of the mesh, which is of time 0.
double growth_of_mesh(const Scene &scene, const Discretization &discretization) {
  const MeshLevels levels = find_mesh_levels(scene.parameters(), scene.parameters().time_stepping.end_time);
  const std::vector<std::size_t> counts = discretization.count_elements();
  double n = 0.;
  for (std::size_t body = 0; body < counts.size(); ++body)
    n += static_cast<double>(counts[body]) * std::pow(8., levels[body]);
  return n / static_cast<double>(discretization.n_global_elements());
}

/// Returns the factor by which refinements of this body increase the number of steps, whose length
/// follows its elements.
double growth_of_steps(const Scene &scene, const std::size_t body) {
  const double end = scene.parameters().time_stepping.end_time;
  double factor = 1., step = 1.;
  for (const double time : scene.parameters().bodies[body].refinement_times.value) {
    factor += (end - time) / end / step;
    step *= 0.5;
  }
  return factor;
}

/// Finds the element of all ranks that sets the stable step of the elements.
StableStepReport find_limiting_element(const Scene &scene, const ExplicitDynamics &problem,
                                       std::size_t &body) {
  const Discretization &discretization = problem.discretization();
  LimitingElement own;
  fail_together(discretization.communicator(), [&] { own = problem.find_limiting_element(); });
  std::array<double, 6> least{own.step, 0., 0., 0., 0., 0.}; // step, body, centre, edge
  if (std::isfinite(own.step)) {
    const CellIterator &cell = discretization.elements(own.body)[own.element].cell;
    least = {own.step,          static_cast<double>(own.body),
             cell->center()[0], cell->center()[1],
             cell->center()[2], min_edge(cell)};
  }
  for (const auto &of_rank : all_gather(discretization.communicator(), least))
    least = std::min(least, of_rank);
  StableStepReport report;
  report.of_elements = least[0];
  body = static_cast<std::size_t>(least[1]);
  report.body = scene.bodies()[body].name;
  report.element = dealii::Tensor<1, 3>({least[2], least[3], least[4]});
  report.min_edge = least[5];
  return report;
}

/// Counts the steps if contact lasts: where a pair meets, nodes that are near limit them from then
/// on.
double count_steps(const Scene &scene, ExplicitDynamics &problem, const SceneReport &of_scene,
                   StableStepReport &stable) {
  const double end = scene.parameters().time_stepping.end_time;
  std::vector<double> times;
  for (const PairReport &pair : of_scene.pairs)
    if (pair.meeting)
      times.push_back(pair.meeting->time);
  std::sort(times.begin(), times.end());
  const std::vector<BodyCourse> courses = find_courses(scene, of_scene.bodies);
  stable.shortest = stable.step;
  constexpr double shorter = 0.99; // of a step: less does not count
  double n = 0., before = 0.;
  for (const double t : times) {
    std::vector<dealii::Tensor<1, 3>> translations;
    for (const BodyCourse &course : courses)
      translations.push_back(course.displacement(t));
    const double step = problem.usual_step_at(t, translations);
    if (!(step < shorter * stable.shortest))
      continue;
    n += (t - before) / stable.shortest;
    before = t;
    stable.shortest = step;
    stable.shortest_from = t;
  }
  return times::count_steps(end, end / (n + (end - before) / stable.shortest));
}

/// Whether loads, such as springs, make explicit steps shorter.
bool limits_steps(const Scene &scene) {
  return std::any_of(scene.bodies().begin(), scene.bodies().end(), [](const Body &body) {
    return std::any_of(body.loads.begin(), body.loads.end(),
                       [](const AppliedLoad &load) { return load.load.limits_steps(); });
  });
}

} // namespace

RunReport forecast_run(const Scene &scene, ExplicitDynamics &problem, const SceneReport &of_scene) {
  const Discretization &discretization = problem.discretization();
  const double end = scene.parameters().time_stepping.end_time;
  RunReport report;
  report.n_dofs = discretization.dof_handler().n_dofs();
  report.memory =
      memory_of_process(discretization) + Memory::explicit_element * growth_of_mesh(scene, discretization) *
                                              static_cast<double>(discretization.n_global_elements());
  try {
    std::size_t body = 0;
    StableStepReport stable = find_limiting_element(scene, problem, body);
    problem.prepare_step(end);
    stable.step = problem.usual_step();
    const double growth = growth_of_steps(scene, body);
    report.n_steps = std::ceil(growth * times::count_steps(end, stable.step));
    const double in_contact = std::ceil(growth * count_steps(scene, problem, of_scene, stable));
    if (in_contact > report.n_steps)
      report.max_steps = in_contact;
    constexpr double part = 1. / 3.;
    stable.is_short_by_contact = std::min(stable.step, stable.shortest) < part * stable.of_elements &&
                                 scene.capabilities().contact && !limits_steps(scene);
    report.stable_step = stable;
  } catch (const SolutionFailure &) { // on all ranks
    report.is_minimum = true;
  }
  return report;
}

RunReport forecast_run(const Scene &scene, const ImplicitSolution &problem) {
  using Control = parameters::TimeStepping::Control;
  const Discretization &discretization = problem.discretization();
  const parameters::TimeStepping &steps = scene.parameters().time_stepping;
  RunReport report;
  report.n_dofs = discretization.dof_handler().n_dofs();
  const double growth = growth_of_mesh(scene, discretization),
               n_dofs = growth * static_cast<double>(report.n_dofs);
  report.memory =
      memory_of_process(discretization) +
      Memory::implicit_element * growth * static_cast<double>(discretization.n_global_elements()) +
      Memory::matrix_dof * n_dofs +
      (problem.solves_iteratively() ? Memory::multigrid_dof * n_dofs
                                    : direct_memory(n_dofs, !scene.capabilities().unsymmetric_matrix));
  report.is_minimum = steps.control == Control::automatic;
  report.n_steps =
      times::count_steps(steps.end_time, report.is_minimum ? steps.max_step : steps.initial_step);
  return report;
}

} // namespace billet
