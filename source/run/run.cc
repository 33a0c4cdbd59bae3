// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/run.h"

#include "billet/run/check.h"
#include "billet/run/explicit_run.h"
#include "billet/run/implicit_run.h"

namespace billet {

std::unique_ptr<const Scene> build_scene(const parameters::Scene &parameters, const MPI_Comm communicator) {
  std::unique_ptr<const Scene> scene;
  fail_together(communicator, [&] { scene = std::make_unique<const Scene>(parameters); });
  return scene;
}

void Run::announce(const Solution &solution, RunOutput &output, const Resumption *resumption,
                   const double force_tolerance) const {
  output.progress().start(discretization_, solution);
  output.report(scene_.parameters().warnings);
  output.report(solution.initial_diagnostics());
  output.report(review_.start());
  if (resumption == nullptr)
    output.report(check_meshes(scene_, discretization_));
  else
    output.report(resumption->describe(force_tolerance));
}

void Run::save(StateWriter &writer) const {
  writer.in("scene", [&] { save_scene(writer, scene_, discretization_); });
  save_method(writer);
}

std::unique_ptr<Run> make_run(const Scene &scene, const MPI_Comm communicator, Resumption *resumption) {
  using Scheme = parameters::TimeStepping::Scheme;
  switch (scene.parameters().time_stepping.scheme) {
  case Scheme::explicit_dynamics:
    return std::make_unique<ExplicitRun>(scene, communicator, resumption);
  case Scheme::quasi_static:
  case Scheme::implicit_dynamics:
    return std::make_unique<ImplicitRun>(scene, communicator, resumption);
  }
  return nullptr;
}

namespace {

/// Writes a checkpoint after a step if one is due or a signal requests it. Returns whether a signal requests
/// the end before the end time; then `has_checkpoint` says whether there is a checkpoint of the current
/// state.
bool heed_signals(Run &run, RunOutput &output, bool &has_checkpoint) {
  const Checkpoints &checkpoints = output.checkpoints();
  const bool is_finished = run.is_finished();
  const Signals::Request request = output.signals().poll();
  const bool is_last = is_finished && checkpoints.is_regular();
  const bool is_demanded = request != Signals::Request::none && run.is_resumable();
  const bool is_due = run.time() < run.end_time() && checkpoints.is_due(run.n_steps(), run.time());
  has_checkpoint = (is_last || is_demanded || is_due) &&
                   output.write_checkpoint(run.time(), [&](StateWriter &writer) { run.save(writer); });
  return request == Signals::Request::end && !is_finished;
}

} // namespace

ExitCode run_to_end(Run &run, RunOutput &output, const Resumption *resumption) {
  run.begin(output, resumption);
  while (!run.is_finished()) {
    if (!run.step(output))
      continue;
    run.after_step(output);
    bool has_checkpoint = false;
    if (heed_signals(run, output, has_checkpoint))
      return output.stop(run.n_steps(), run.time(), has_checkpoint);
  }
  run.end(output);
  return output.finish();
}

} // namespace billet
