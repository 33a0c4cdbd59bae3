// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/run.h"

#include "billet/diagnostic_kinds.h"
#include "billet/fail_together.h"
#include "billet/run/check.h"
#include "billet/run/explicit_run.h"
#include "billet/run/implicit_run.h"
#include "billet/run/law_messages.h"

#include <filesystem>
#include <utility>

namespace billet {

std::unique_ptr<const Scene> build_scene(const parameters::Scene &parameters, const MPI_Comm communicator) {
  std::unique_ptr<const Scene> scene;
  fail_together(communicator, [&] { scene = std::make_unique<const Scene>(parameters); });
  return scene;
}

void Run::announce(const Solution &solution, RunOutput &output, const Resumption *resumption,
                   const double force_tolerance) const {
  if (resumption != nullptr && resumption->is_refinement()) {
    resumption->change().check(parameters_.file_name, resumption->report().energy_change,
                               solution.state().energies);
    output.report(resumption->describe(force_tolerance));
    return;
  }
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

std::vector<BodyMesh> Run::body_meshes() const {
  const std::vector<std::size_t> counts = discretization_.count_elements();
  const std::vector<double> errors = mesh_errors_.of_bodies(), geometry = mesh_errors_.geometry_of_bodies();
  const bool is_resolved = mesh_errors_.sees_variation() && review_.describe_unresolved().empty();
  std::vector<BodyMesh> bodies;
  for (std::size_t b = 0; b < counts.size(); ++b)
    bodies.push_back({counts[b], errors[b] + geometry[b], is_resolved,
                      discretization_.centre().norm() + discretization_.radius()});
  return bodies;
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

/// Writes a checkpoint after a step if one is due or a signal requests it. Returns whether a signal
/// requests the end before the end time; then `has_checkpoint` says whether there is a checkpoint
/// of the current state.
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

/// Returns the refinement that the scene demands at the run's time, each body at most once; none if
/// there is none. Collective.
std::optional<MeshChange> find_change(const Run &run, const Scene &scene) {
  const MeshLevels &now = run.discretization().levels(),
                   wanted = find_mesh_levels(scene.parameters(), run.time());
  if (run.is_finished() || now == wanted || !run.can_refine())
    return {};
  const std::vector<std::size_t> counts = run.discretization().count_elements();
  MeshChange change{now, {}, run.time(), ""};
  for (std::size_t b = 0; b < now.size(); ++b) {
    change.is_refined.push_back(now[b] < wanted[b]);
    if (now[b] >= wanted[b])
      continue;
    ++change.levels[b];
    change.text += (change.text.empty() ? "'" : ", '") + scene.bodies()[b].name + "' (" +
                   std::to_string(counts[b]) + " elements become " + std::to_string(8 * counts[b]) + ")";
  }
  return change;
}

/// File that its owner removes, on the first rank.
struct TransientFile {
  std::string name;
  bool is_first;

  ~TransientFile() {
    std::error_code ignored;
    if (is_first)
      std::filesystem::remove(name, ignored);
  }
};

/// Ends the run and starts one from its state on the finer mesh. Collective.
std::unique_ptr<Run> refine(std::unique_ptr<Run> run, const Scene &scene, RunOutput &output,
                            MeshChange change) {
  MPI_Comm communicator = run->discretization().communicator();
  const TransientFile file{scene.parameters().output.folder.value + "/refinement.h5",
                           dealii::Utilities::MPI::this_mpi_process(communicator) == 0};
  CheckpointWriter writer(communicator, file.name);
  run->save(writer);
  writer.in("mesh", [&] { save_mesh(writer, run->discretization()); });
  if (const std::string failure = writer.finish(); !failure.empty())
    throw SolutionFailure(Diagnostic(diagnostic::solution_failed,
                                     scene.parameters().file_name +
                                         ": the state for the refined mesh cannot be stored: " + failure)
                              .time(change.time));
  change.before = run->hand_over(output);
  run.reset(); // its memory is free for the finer mesh
  Resumption resumption(file.name, communicator, change);
  try {
    run = make_run(scene, communicator, &resumption);
  } catch (const InputError &error) { // on all ranks
    throw SolutionFailure(
        Diagnostic(diagnostic::solution_failed, scene.parameters().file_name +
                                                    ": the run cannot continue with finer elements of " +
                                                    change.text + ": " + error.what())
            .time(change.time)
            .advice("Choose an earlier time in 'Refinement times', when elements are less distorted"));
  }
  run->begin(output, &resumption);
  return run;
}

/// Tries a step, and reports what material subroutines say in it.
bool try_step(Run &run, const Scene &scene, RunOutput &output) {
  const auto report = [&] {
    output.report(gather_law_messages(scene, run.discretization().communicator(), run.time()));
  };
  try {
    const bool is_accepted = run.step(output);
    report();
    return is_accepted;
  } catch (const SolutionFailure &) { // on all ranks
    report();
    throw;
  }
}

} // namespace

ExitCode run_to_end(std::unique_ptr<Run> run, const Scene &scene, RunOutput &output,
                    const Resumption *resumption) {
  run->begin(output, resumption);
  while (!run->is_finished()) {
    if (const auto change = find_change(*run, scene)) {
      run = refine(std::move(run), scene, output, *change);
      continue;
    }
    if (!try_step(*run, scene, output))
      continue;
    run->after_step(output);
    bool has_checkpoint = false;
    if (heed_signals(*run, output, has_checkpoint))
      return output.stop(run->n_steps(), run->time(), has_checkpoint);
  }
  run->end(output);
  return output.finish(run->body_meshes());
}

} // namespace billet
