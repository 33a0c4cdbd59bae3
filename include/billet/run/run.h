// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_RUN_H
#define BILLET_RUN_RUN_H

#include "billet/output/probe_reader.h"
#include "billet/run/resumption.h"
#include "billet/run/run_output.h"
#include "billet/solve/mesh_errors.h"
#include "billet/solve/run_review.h"
#include "billet/solve/softening_watch.h"
#include "billet/solve/stability_watch.h"

#include <memory>

namespace billet {

/// Solution method in the loop of run_to_end(), with its own mesh. All objects that depend on the
/// mesh end with the run. Files and console (RunOutput) outlive it, so that another run, on another
/// mesh, can continue them. The constructor of a method sets up its problem, from a checkpoint if
/// there is one; it throws InputError before anything is written.
class Run {
public:
  /// `resumption`: null at time 0.
  Run(const Scene &scene, MPI_Comm communicator, Resumption *resumption)
      : scene_(scene), parameters_(scene.parameters()),
        discretization_(scene, communicator,
                        resumption == nullptr ? MeshLevels() : resumption->find_levels(scene)),
        review_(scene, discretization_), stability_(scene, discretization_), softening_(scene),
        mesh_errors_(scene, discretization_), probes_(scene, discretization_) {}
  virtual ~Run() = default;
  Run(const Run &) = delete;
  Run &operator=(const Run &) = delete;

  /// Starts the run before the first step: shows the model and reports warnings about the scene,
  /// unless the run continues another one. `resumption`: null at time 0. Collective, as all
  /// functions below.
  virtual void begin(RunOutput &output, const Resumption *resumption) = 0;
  /// Whether the run has reached its end time.
  virtual bool is_finished() const = 0;
  /// Tries a step. Returns whether it is accepted. If the run cannot continue, writes the last
  /// state and throws SolutionFailure.
  virtual bool step(RunOutput &output) = 0;
  /// Completes an accepted step: writes rows and fields, checks the state, and advances. Throws as
  /// step().
  virtual void after_step(RunOutput &output) = 0;
  /// Completes the run after the last step: reports results of the whole run.
  virtual void end(RunOutput &output) = 0;

  virtual unsigned int n_steps() const = 0;
  virtual double time() const = 0;
  double end_time() const { return parameters_.time_stepping.end_time; }
  /// Whether a run could resume from the current state.
  virtual bool is_resumable() const { return true; }
  const Discretization &discretization() const { return discretization_; }
  /// Returns the bodies' meshes, with their errors so far. Collective.
  std::vector<BodyMesh> body_meshes() const;
  /// Whether the mesh may change at the current state.
  virtual bool can_refine() const { return true; }
  /// Saves the state that resumes the run bitwise, and the data that check whether a scene fits it.
  void save(StateWriter &writer) const;
  /// Ends the run at time(), for a run on another mesh that continues from what save() has saved.
  /// Completes the state there, and returns its energies. Nothing may follow. Throws as step().
  virtual EnergyLedger hand_over(RunOutput &output) = 0;

protected:
  /// Saves the method's own part of the state.
  virtual void save_method(StateWriter &writer) const = 0;
  /// Performs the part of begin() that all methods share. Unbalanced forces above this relative
  /// tolerance are reported.
  void announce(const Solution &solution, RunOutput &output, const Resumption *resumption,
                double force_tolerance) const;

  const Scene &scene_;
  const parameters::Scene &parameters_;
  const Discretization discretization_;
  RunReview review_;
  StabilityWatch stability_;
  SofteningWatch softening_;
  MeshErrors mesh_errors_;
  const ProbeReader probes_;
};

/// Builds the scene. It reads mesh files, which may fail on one rank alone. Throws InputError.
/// Collective.
std::unique_ptr<const Scene> build_scene(const parameters::Scene &parameters, MPI_Comm communicator);

/// Makes the method that the scene selects. `resumption`: null at time 0. Collective.
std::unique_ptr<Run> make_run(const Scene &scene, MPI_Comm communicator, Resumption *resumption);

/// Runs from begin() to end(), or until a signal requests the end. At 'Refinement times' another
/// run, on the finer mesh, replaces `run`. Collective.
ExitCode run_to_end(std::unique_ptr<Run> run, const Scene &scene, RunOutput &output,
                    const Resumption *resumption);

} // namespace billet

#endif
