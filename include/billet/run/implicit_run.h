// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_IMPLICIT_RUN_H
#define BILLET_RUN_IMPLICIT_RUN_H

#include "billet/output/energy_watch.h"
#include "billet/run/run.h"
#include "billet/solve/energy_errors.h"
#include "billet/solve/error_watch.h"
#include "billet/solve/implicit/implicit_solution.h"
#include "billet/solve/step_control.h"

#include <array>
#include <memory>
#include <vector>

namespace billet {

/// Run of statics or implicit dynamics: Newton's method solves the steps, and failed steps are cut.
class ImplicitRun final : public Run {
public:
  ImplicitRun(const Scene &scene, MPI_Comm communicator, Resumption *resumption);

  void begin(RunOutput &output, const Resumption *resumption) override;
  bool is_finished() const override { return control_.is_finished(); }
  bool step(RunOutput &output) override;
  void after_step(RunOutput &output) override;
  void end(RunOutput &output) override;
  unsigned int n_steps() const override { return control_.n_steps(); }
  double time() const override { return control_.time(); }
  EnergyLedger hand_over(RunOutput &) override { return problem_.state().energies; }

protected:
  void save_method(StateWriter &writer) const override;

private:
  /// Loads the checkpoint into the problem, if there is one. Returns the times at which steps have
  /// to end.
  std::vector<double> load_problem(Resumption *resumption);
  /// Returns the time over which unbalanced forces fade; 0: until the end.
  double release_time(const Resumption &resumption) const;
  /// Reads the step control and the rest of the checkpoint.
  void load_control(Resumption &resumption);
  /// Passes the accepted step to the error control.
  void control_errors(RunOutput &output);
  EnergyWatch::Cause find_cause_of_imbalance() const;
  /// Throws SolutionFailure if the energy imbalance exceeds the allowed drift.
  void check_energies(RunOutput &output);
  /// Cuts the failed step. Throws SolutionFailure if that is not allowed.
  void reject_step(double from, double to, RunOutput &output);

  ImplicitSolution problem_;
  StepControl control_;
  std::unique_ptr<ErrorWatch> watch_; ///< only for static scenes that control their errors
  /// Exists only for dynamic ones; their steps follow another estimate.
  std::unique_ptr<EnergyErrors> errors_;
  EnergyWatch energies_;
  StepReport report_;
  unsigned int n_failed_ = 0; ///< attempts in a row
  double continued_ = 0.;     ///< length of the last step, if its increment may be continued
};

} // namespace billet

#endif
