// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_RUN_H
#define BILLET_RUN_RUN_H

#include "billet/run/resumption.h"
#include "billet/run/run_output.h"
#include "billet/solve/run_review.h"
#include "billet/solve/stability_watch.h"

#include <memory>

namespace billet {

/// A solution method in the loop of run_to_end(), on the mesh that it makes. All that knows the mesh lives
/// and ends with the run; files and console (RunOutput) outlive it, so that another run, on another mesh, can
/// continue them. The constructor of a method sets up its problem, from a checkpoint where there is one; it
/// throws InputError before anything is written.
class Run {
public:
  Run(const Scene &scene, MPI_Comm communicator)
      : scene_(scene), parameters_(scene.parameters()), discretization_(scene, communicator),
        review_(scene, discretization_), stability_(scene, discretization_) {}
  virtual ~Run() = default;
  Run(const Run &) = delete;
  Run &operator=(const Run &) = delete;

  /// Before the first step: shows what is run, and reports doubts about the scene. `resumption`: null at time
  /// 0. Collective, as all that follow.
  virtual void begin(RunOutput &output, const Resumption *resumption) = 0;
  /// Whether the run has come to its end time.
  virtual bool is_finished() const = 0;
  /// Tries a step. Returns whether it is taken. Throws SolutionFailure, with the last state written, if the
  /// run cannot go on.
  virtual bool step(RunOutput &output) = 0;
  /// After a step that is taken: writes rows and fields, judges the state, and moves on. Throws as step().
  virtual void after_step(RunOutput &output) = 0;
  /// After the last step: reports what the whole run shows.
  virtual void end(RunOutput &output) = 0;

  virtual unsigned int n_steps() const = 0;
  virtual double time() const = 0;
  double end_time() const { return parameters_.time_stepping.end_time; }
  /// Whether a run could resume from the state as it is.
  virtual bool is_resumable() const { return true; }
  /// Saves what resumes the run bit by bit, and what tells whether a scene fits it.
  void save(StateWriter &writer) const;

protected:
  /// The part of save() that is the method's own.
  virtual void save_method(StateWriter &writer) const = 0;
  /// The part of begin() that all methods share. Forces out of balance are named above this part of them.
  void announce(const Solution &solution, RunOutput &output, const Resumption *resumption,
                double force_tolerance) const;

  const Scene &scene_;
  const parameters::Scene &parameters_;
  const Discretization discretization_;
  RunReview review_;
  StabilityWatch stability_;
};

/// Makes the method that the scene asks for. `resumption`: null at time 0. Collective.
std::unique_ptr<Run> make_run(const Scene &scene, MPI_Comm communicator, Resumption *resumption);

/// Runs from begin() to end(), or until a signal demands the end. Collective.
ExitCode run_to_end(Run &run, RunOutput &output, const Resumption *resumption);

} // namespace billet

#endif
