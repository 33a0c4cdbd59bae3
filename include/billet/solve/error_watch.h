// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_ERROR_WATCH_H
#define BILLET_SOLVE_ERROR_WATCH_H

#include "billet/solve/error_control.h"
#include "billet/solve/implicit/implicit_solution.h"
#include "billet/solve/step_control.h"
#include "billet/usage.h"

#include <string>
#include <vector>

namespace billet {

/// Controls the steps of a static scene, and the penetration allowed, by one ErrorControl for each
/// group of ImplicitSolution::Results. Makes the measurements that these need. The strictest
/// control decides.
class ErrorWatch {
public:
  /// Whether the scene has an 'Error tolerance' of steps or a 'Target error'.
  static bool is_wanted(const parameters::Scene &parameters);
  ErrorWatch(const Scene &scene, const Discretization &discretization, ImplicitSolution &problem);

  /// Begins at this time, from the state of another method.
  void begin(double time);

  /// Tries a step of twice the length and steps back, if a measurement is due before the next step.
  /// Returns the iterations of the measurement. `previous_step`: see ImplicitSolution::step().
  unsigned int before_step(StepControl &control, double previous_step);
  /// Updates the controls after an accepted step of this length, and control.accept().
  void after_step(StepControl &control, double length, const NewtonReport &report);
  /// Updates the controls after a failed step.
  void after_failure();

  /// Error estimate of the result with the largest error.
  struct EstimatedError {
    ErrorControl::Estimate estimate;
    std::string of_what;
    double since = 0.;              ///< time from which on errors are known
    bool has_results = false;       ///< whether there are results to normalise errors by
    bool knows_penetration = false; ///< see ErrorControl
  };
  EstimatedError estimated_error() const;
  unsigned int n_measurements() const { return controls_.front().n_measurements(); } ///< of steps
  /// Whether the target error sets the penetration allowed, instead of the scene.
  bool controls_penetration() const { return controls_penetration_; }
  /// Whether steps, or penetration, are a source of errors in this scene.
  bool measures_steps() const { return measures_steps_; }
  bool measures_penetration() const { return measures_penetration_; }
  /// Returns messages before the end of the run: very many steps remain, or no step can be compared
  /// any more.
  DiagnosticList check(const StepControl &control) const;
  /// Returns the iterations of all measurements.
  unsigned int n_iterations() const { return n_iterations_; }

  void save(StateWriter &writer) const;
  /// Loads the controls. If the earlier run had no account of some or all results, these start at
  /// begin().
  void load(StateReader &reader);

private:
  void allow_penetration();
  void demand_accuracy(bool is_measured);
  /// Returns the smallest value of a bound, such as the maximum step, over all controls.
  double minimum(double (ErrorControl::*bound)() const) const;
  bool wants_measurement(double length) const;
  bool wants_penetration() const;
  void miss_measurement(double length, bool failed);
  /// Tries the longer step if a measurement of steps is due. Returns its iterations.
  unsigned int probe(StepControl &control, double previous_step);
  /// Takes over the measured error by the last step's penetration, if there is one.
  void take_measurement();

  ImplicitSolution &problem_;
  std::vector<ErrorControl> controls_; ///< of forces first
  double penetration_allowed_ = 0.;    ///< since the last step but the first of a comparison
  double residual_factor_;             ///< residual of a resultant force over that of nodal forces
  double end_time_;
  bool measures_steps_, measures_penetration_, controls_penetration_;
  /// Residual tolerance of steps that are compared, over that of others.
  double accuracy_of_measurements_;
  ImplicitSolution::Probe probe_;
  double probe_length_ = 0.; ///< length of the two steps that are compared with the probe; 0: none
  double probe_end_ = 0.;
  double last_residual_ = 0.;
  unsigned int n_iterations_ = 0;
  HeldMemory memory_{Capability::error_control};
};

} // namespace billet

#endif
