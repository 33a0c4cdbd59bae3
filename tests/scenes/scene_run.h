// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_SCENE_RUN_H
#define BILLET_TESTS_SCENE_RUN_H

#include "billet/errors.h"
#include "billet/friction/coulomb.h"
#include "billet/geometry/plane.h"
#include "billet/solve/implicit/implicit_solution.h"
#include "billet/solve/step_control.h"

#include "../testing.h"

#include <chrono>
#include <functional>
#include <thread>

namespace billet::testing {

/// With tolerances for comparisons to many digits, where the scene leaves them at their defaults.
inline parameters::Scene for_comparison(parameters::Scene scene) {
  if (scene.solver.force_tolerance == 5e-3)
    scene.solver.force_tolerance = 1e-6;
  if (scene.solver.energy_tolerance == 5e-5)
    scene.solver.energy_tolerance = 1e-10;
  return scene;
}

/// A scene that runs in memory, without output, its parameters changed at will before that.
class SceneRun {
public:
  explicit SceneRun(const parameters::Scene &parameters)
      : scene(for_comparison(parameters)), discretization(scene, MPI_COMM_WORLD),
        problem(scene, discretization),
        control(parameters.time_stepping, parameters.output.interval, scene.stops()) {}

  /// One accepted step, with cuts if need be. Throws where that is impossible.
  NewtonReport advance() {
    for (;;) {
      const double from = control.time(), to = control.next_time();
      const NewtonReport report = problem.step(to, previous_);
      n_iterations += static_cast<unsigned int>(report.iterations.size());
      if (report.converged) {
        control.accept(static_cast<unsigned int>(report.hardest), problem.balance().time_error());
        previous_ = to - from;
        return report;
      }
      if (!control.reject() && !problem.take_low_penalties())
        throw SolutionFailure("step from " + std::to_string(from) + " to " + std::to_string(to) +
                              " failed: " + report.failure + ". " + report.advice);
    }
  }

  void finish(const std::function<void(const NewtonReport &)> &after_step = {}) {
    while (!control.is_finished()) {
      const NewtonReport report = advance();
      if (after_step)
        after_step(report);
    }
  }

  const ContactLoad &load(const std::size_t tool = 0) const { return problem.state().tool_loads[tool]; }

  Scene scene;
  Discretization discretization;
  ImplicitSolution problem;
  StepControl control;
  unsigned int n_iterations = 0;

private:
  double previous_ = 0.;
};

inline parameters::Scene read_shipped_scene(const std::string &name) {
  return parameters::Scene::read(std::string(SOURCE_DIR) + "/../../prm/" + name);
}

inline parameters::Scene read_test_scene(const std::string &name) {
  return parameters::Scene::read(std::string(SOURCE_DIR) + "/" + name);
}

/// An infinite plane as the surface of a tool.
inline std::shared_ptr<const RigidSurface> make_plane(const dealii::Tensor<1, 3> &point,
                                                      const dealii::Tensor<1, 3> &normal) {
  return std::make_shared<const RigidSurface>(single_patch<Plane>(point, normal));
}

inline void set_fixed_steps(parameters::Scene &parameters, const unsigned int n) {
  parameters.time_stepping.control = parameters::TimeStepping::Control::fixed;
  parameters.time_stepping.initial_step = parameters.time_stepping.end_time / n;
}

inline unsigned int n_ranks() { return dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD); }
inline bool is_first_rank() { return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0; }

/// The first `n` ranks do this together, the others wait and leave them the processor.
template <class Run> void on_ranks(const unsigned int n, const Run &run) {
  const bool takes_part = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) < n;
  MPI_Comm some = MPI_COMM_NULL;
  MPI_Comm_split(MPI_COMM_WORLD, takes_part ? 0 : 1, 0, &some);
  if (takes_part)
    run(some);
  MPI_Comm_free(&some);
  MPI_Request all = MPI_REQUEST_NULL;
  MPI_Ibarrier(MPI_COMM_WORLD, &all);
  for (int has_come = 0; has_come == 0; MPI_Test(&all, &has_come, MPI_STATUS_IGNORE))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

} // namespace billet::testing

#endif
