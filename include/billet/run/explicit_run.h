// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_EXPLICIT_RUN_H
#define BILLET_RUN_EXPLICIT_RUN_H

#include "billet/output/energy_watch.h"
#include "billet/run/run.h"
#include "billet/run/stops.h"
#include "billet/run/stopwatch.h"
#include "billet/solve/energy_errors.h"
#include "billet/solve/explicit/explicit_dynamics.h"

#include <memory>
#include <optional>
#include <string>

namespace billet {

/// Run of explicit dynamics; every step is accepted. The function step() completes the state at the
/// current time. Then after_step() checks it at intervals and advances to the next time.
class ExplicitRun final : public Run {
public:
  ExplicitRun(const Scene &scene, MPI_Comm communicator, Resumption *resumption);

  void begin(RunOutput &output, const Resumption *resumption) override;
  bool is_finished() const override { return is_finished_; }
  bool step(RunOutput &output) override;
  void after_step(RunOutput &output) override;
  void end(RunOutput &output) override;
  unsigned int n_steps() const override { return problem_.n_steps(); }
  double time() const override { return problem_.time(); }
  bool is_resumable() const override { return is_between_steps_; }
  /// A mesh that has just changed needs a step, with which its energy is counted.
  bool can_refine() const override { return !change_; }
  EnergyLedger hand_over(RunOutput &output) override;

protected:
  void save_method(StateWriter &writer) const override;

private:
  /// Steps and times of what does not happen in each step.
  struct LastTimes {
    unsigned int balanced_step = 0;  ///< last step with a balance of energies
    unsigned int watched_step = 0;   ///< that of the last watch()
    unsigned int estimated_step = 0; ///< that of the last estimate_mesh_error()
    double interval_start = 0.;      ///< of (W4) [time]
    double next_check = 0.;          ///< time of the next check_stability() [time]
  };

  void load(Resumption &resumption);
  /// Runs and times a part of a step. On failure, writes the state and throws an explanation.
  template <class Part> void attempt(RunOutput &output, const Part &part);
  /// Reports the refinement with which the run began, after its first forces.
  void report_change(RunOutput &output);
  /// Whether the state is to be watched: at the start, at regular times unless the last one is too
  /// near, and at the end. Call it once for each step.
  bool is_watch_due();
  /// Adds a state to the error of the mesh, unless the last one is too near.
  void estimate_mesh_error();
  void show_number_of_steps(RunOutput &output) const;
  void write_row(RunOutput &output);
  /// Reports what the state shows of contact, elements and energies.
  void watch(RunOutput &output);
  void write_fields(RunOutput &output);
  void check_stability(RunOutput &output);
  /// Returns advice on the law if it may cause the energy imbalance; otherwise an empty text.
  std::string advise_on_law(RunOutput &output);
  /// Throws SolutionFailure if the energies fail to balance for too long or are not finite.
  void check_drift(RunOutput &output);
  /// Shortens the steps if their energy errors are too large.
  void control_errors();

  ExplicitDynamics problem_;
  const Stops stops_;
  RegularTimes history_times_;
  /// Times that do not depend on the history's interval.
  RegularTimes watch_times_;
  /// Exists only for scenes that control their errors.
  std::unique_ptr<EnergyErrors> errors_;
  EnergyWatch energies_{EnergyWatch::Balance::is_left}; ///< check_drift() ends the run
  Stopwatch stopwatch_;                                 ///< for the steps, without output
  LastTimes last_;
  unsigned int first_step_ = 0;      ///< of this run, after those that it continues
  std::optional<MeshChange> change_; ///< until it is reported
  bool is_finished_ = false, is_between_steps_ = true;
};

} // namespace billet

#endif
