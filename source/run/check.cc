// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/check.h"

#include "billet/contact/faceted_curvature.h"
#include "billet/diagnostic_kinds.h"
#include "billet/discretization/inverted_corners.h"
#include "billet/fail_together.h"
#include "billet/output/checkpoint.h"
#include "billet/output/probe_reader.h"
#include "billet/run/body_report.h"
#include "billet/run/output_folder.h"
#include "billet/run/pair_report.h"
#include "billet/run/run.h"
#include "billet/run/run_forecast.h"
#include "billet/run/scene_report_text.h"
#include "billet/scene/plausibility.h"
#include "billet/solve/explicit/explicit_dynamics.h"
#include "billet/solve/implicit/implicit_solution.h"

#include <nlohmann/json.hpp>

#include <memory>
#include <optional>
#include <ostream>

namespace billet {

DiagnosticList check_meshes(const Scene &scene, const Discretization &discretization) {
  DiagnosticList messages = find_inverted_corners(scene, discretization);
  append(messages, find_faceted_curvature(scene, discretization));
  return messages;
}

namespace {

/// Sets up the solution as a run would. Returns the warnings of a run before its first step, and
/// fills the report. Collective.
DiagnosticList check_start(const Scene &scene, MPI_Comm communicator, SceneReport &report) {
  const Discretization discretization(scene, communicator);
  DiagnosticList messages =
      check_plausibility(scene, discretization.dof_handler().get_triangulation(), communicator);
  const ProbeReader probes(scene, discretization); // refuses points outside bodies
  report.bodies = report_bodies(scene, discretization);
  if (scene.parameters().restart.is_wanted())
    return messages;
  if (!scene.parameters().scheme().has_matrix) {
    ExplicitDynamics problem(scene, discretization);
    append(messages, problem.initial_diagnostics());
    report.pairs = report_pairs(scene, discretization, report.bodies);
    report.run = forecast_run(scene, problem, report);
  } else {
    const ImplicitSolution problem(scene, discretization);
    append(messages, problem.initial_diagnostics());
    report.run = forecast_run(scene, problem);
    report.pairs = report_pairs(scene, discretization, report.bodies);
  }
  append(messages, check_flights(scene, report.bodies, report.pairs));
  append(messages, check_meshes(scene, discretization));
  return messages;
}

/// Checks only the outlines of the meshes, which fit into any memory. Collective.
DiagnosticList check_outline(const Scene &scene, MPI_Comm communicator) {
  DiagnosticList messages;
  fail_together(communicator, [&] {
    dealii::Triangulation<3> outline;
    scene.build_mesh(MeshDetail::outline, outline);
    messages = check_plausibility(scene, outline, MPI_COMM_SELF);
  });
  messages.emplace_back(diagnostic::outline_checked,
                        "The mesh is too large to build for a check, so overlaps of bodies and shapes of "
                        "elements remain unchecked");
  return messages;
}

/// Checks the files that a run reads and writes, and builds the scene. Collective.
std::unique_ptr<const Scene> open_scene(const parameters::Scene &parameters, MPI_Comm communicator) {
  fail_together(communicator, [&] { check_output_folder(parameters, EarlierResults::replaced); });
  if (parameters.restart.is_wanted())
    const CheckpointReader sound(communicator, parameters.restart.file.value, parameters.restart.file.origin);
  return build_scene(parameters, communicator);
}

} // namespace

void check_quietly(const parameters::Scene &parameters, MPI_Comm communicator) {
  const std::unique_ptr<const Scene> scene = open_scene(parameters, communicator);
  constexpr std::size_t max_elements = 50000; // takes seconds
  SceneReport report;
  if (scene->count_elements() <= max_elements)
    check_start(*scene, communicator, report);
  else
    check_outline(*scene, communicator);
}

void check_simulation(const parameters::Scene &parameters, MPI_Comm communicator, std::ostream &stream,
                      const bool as_json) {
  const std::unique_ptr<const Scene> built = open_scene(parameters, communicator);
  const Scene &scene = *built;
  constexpr std::size_t max_elements = 500000; // takes a minute and some GB on one rank
  DiagnosticList messages = scene.parameters().warnings;
  std::optional<SceneReport> report; // none of outlines
  if (scene.count_elements() <= max_elements)
    append(messages, check_start(scene, communicator, report.emplace()));
  else
    append(messages, check_outline(scene, communicator));
  append(messages, check_bricks(scene));
  if (dealii::Utilities::MPI::this_mpi_process(communicator) != 0)
    return;
  if (as_json) {
    nlohmann::ordered_json object = nlohmann::ordered_json::parse(scene.describe_as_json(messages));
    if (report)
      object["report"] = nlohmann::ordered_json::parse(describe_as_json(*report));
    stream << object.dump() << "\n";
    return;
  }
  scene.describe(stream);
  if (report)
    print(*report, stream);
  for (const auto &message : messages)
    stream << message.text() << "\n";
}

} // namespace billet
