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

/// Lets ErrorControls, one for each group of ImplicitSolution::Results, choose the steps of a static scene,
/// and how deep contacts may go in: makes the measurements that they want. The strictest decides.
class ErrorWatch {
public:
  /// Whether the scene has an 'Error tolerance' of steps or a 'Target error'.
  static bool is_wanted(const parameters::Scene &parameters);
  ErrorWatch(const Scene &scene, const Discretization &discretization, ImplicitSolution &problem);

  /// Begins at this time, with another method's state.
  void begin(double time);

  /// Before a step: where a measurement is due, tries one of twice the length and steps back. Iterations that
  /// this took. `previous_step`: see ImplicitSolution::step().
  unsigned int before_step(StepControl &control, double previous_step);
  /// After an accepted step of this length, and control.accept().
  void after_step(StepControl &control, double length, const NewtonReport &report);
  /// After one that has failed.
  void after_failure();

  /// What is believed of the results that are off the most, and their name.
  struct Belief {
    ErrorControl::Estimate estimate;
    std::string of_what;
    double since = 0.;              ///< time from which on they are known
    bool has_results = false;       ///< that errors can be parts of
    bool knows_penetration = false; ///< see ErrorControl
  };
  Belief belief() const;
  unsigned int n_measurements() const { return controls_.front().n_measurements(); } ///< of steps
  /// Whether it chooses how deep contacts may go in; else the scene does.
  bool controls_penetration() const { return controls_penetration_; }
  /// Whether steps, or penetrations, are a source of errors in this scene.
  bool measures_steps() const { return measures_steps_; }
  bool measures_penetration() const { return measures_penetration_; }
  /// Messages before the end of the run: that very many steps are to come, that none can be compared any
  /// more.
  DiagnosticList check(const StepControl &control) const;
  /// Iterations of all measurements.
  unsigned int n_iterations() const { return n_iterations_; }

  void save(StateWriter &writer) const;
  /// Where the run up to there kept no account of some results, or none, that goes on from begin().
  void load(StateReader &reader);

private:
  void allow_penetration();
  void demand_accuracy(bool is_measured);
  /// Such as the longest step, of the strictest.
  double least(double (ErrorControl::*bound)() const) const;
  bool wants_measurement(double length) const;
  bool wants_penetration() const;
  void miss_measurement(double length, bool failed);
  /// Where a measurement of steps is due. Iterations that it took.
  unsigned int probe(StepControl &control, double previous_step);
  /// What the last step's penetrations made, if it has measured that.
  void take_measurement();

  ImplicitSolution &problem_;
  std::vector<ErrorControl> controls_; ///< of forces first
  double residual_factor_;             ///< of a force, over that of the residual
  double end_time_;
  bool measures_steps_, measures_penetration_, controls_penetration_;
  double accuracy_of_measurements_; ///< residuals of steps that are compared, over those of others
  ImplicitSolution::Probe probe_;
  double probe_length_ = 0.; ///< of each of the two steps that are compared with it; 0: none
  double probe_end_ = 0.;
  double last_residual_ = 0.;
  unsigned int n_iterations_ = 0;
  HeldMemory memory_{Capability::error_control};
};

} // namespace billet

#endif
