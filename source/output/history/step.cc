// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/history_quantity.h"

namespace billet {

HistoryQuantity step_quantity();
HistoryQuantity solver_quantity();

HistoryQuantity step_quantity() {
  return {"step",
          {{"step", "Number of the step."},
           {"time", "Time at its end. [time]"},
           {"step_length", "Length of the step; in explicit scenes of the next one. [time]"}},
          [](const Scene &) -> std::vector<std::string> {
            return {"step", "time", "step_length"};
          },
          [](const HistorySample &sample) -> std::vector<double> {
            return {static_cast<double>(sample.step), sample.state.time, sample.length};
          }};
}

HistoryQuantity solver_quantity() {
  return {"solver",
          {{"iterations", "Iterations of Newton's method in the step."},
           {"residual", "Final residual over the forces."},
           {"total_iterations", "Iterations since the start, those of failed steps included."},
           {"total_cuts", "Steps that were cut since the start."},
           {"linear_iterations", "Iterations of the linear solver in the step; 0 of a direct one."}},
          [](const Scene &scene) -> std::vector<std::string> {
            if (!scene.parameters().scheme().has_matrix)
              return {};
            return {"iterations", "residual", "total_iterations", "total_cuts", "linear_iterations"};
          },
          [](const HistorySample &sample) -> std::vector<double> {
            const StepReport &report = *sample.report;
            return {static_cast<double>(report.newton.iterations.size()), report.newton.force,
                    static_cast<double>(report.total_iterations), static_cast<double>(report.total_cuts),
                    static_cast<double>(report.newton.linear_iterations)};
          }};
}

} // namespace billet
