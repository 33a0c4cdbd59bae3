// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_EXPLICIT_RUN_H
#define BILLET_TESTS_EXPLICIT_RUN_H

#include "billet/errors.h"
#include "billet/solve/explicit/explicit_dynamics.h"

#include "../testing.h"
#include "scene_run.h"

#include <array>
#include <cmath>
#include <string>

namespace billet::testing {

/// An explicit scene that runs in memory, without output, its parameters changed at will before that.
class ExplicitRun {
public:
  explicit ExplicitRun(const parameters::Scene &parameters, const MPI_Comm communicator = MPI_COMM_WORLD)
      : scene(parameters), discretization(scene, communicator), problem(scene, discretization) {}

  /// Runs to the end time, and calls look() at the start, at every multiple of `interval` and at the end,
  /// with the state up to date.
  template <class Check> void finish(const double interval, const Check &inspect) {
    const double end = scene.parameters().time_stepping.end_time;
    for (;;) {
      const double time = problem.time();
      const double event =
          std::min(end, (std::floor(time / interval + 1e-9) + 1.) * interval) + (time >= end ? interval : 0.);
      problem.prepare_step(event);
      if (time >= end || std::abs(time / interval - std::round(time / interval)) < 1e-9) {
        problem.update_state();
        worst_drift = std::max(worst_drift, std::abs(problem.relative_drift()));
        inspect();
      }
      if (time >= end)
        return;
      problem.finish_step();
    }
  }

  const SolutionState &state() const { return problem.state(); }

  Scene scene;
  Discretization discretization;
  ExplicitDynamics problem;
  double worst_drift = 0.; ///< relative, where look() was called
};

/// Mean of a nodal field over a body whose elements are all alike. Collective.
inline dealii::Tensor<1, 3> mean_of_body(const ExplicitRun &run, const Vector &field,
                                         const std::size_t body) {
  std::array<double, 4> sums{};
  for (const auto &element : run.discretization.elements(body))
    for (unsigned int a = 0; a < n_element_nodes; ++a) {
      for (unsigned int i = 0; i < 3; ++i)
        sums[i] += field(element.dofs[3 * a + i]);
      sums[3] += 1.;
    }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 4, MPI_DOUBLE, MPI_SUM, run.discretization.communicator());
  return dealii::Tensor<1, 3>({sums[0] / sums[3], sums[1] / sums[3], sums[2] / sums[3]});
}

} // namespace billet::testing

#endif
