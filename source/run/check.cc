// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/check.h"

#include "billet/contact/faceted_curvature.h"
#include "billet/diagnostic_kinds.h"
#include "billet/discretization/inverted_corners.h"
#include "billet/errors.h"
#include "billet/output/checkpoint.h"
#include "billet/output/probe_reader.h"
#include "billet/run/output_folder.h"
#include "billet/scene/plausibility.h"
#include "billet/solve/explicit/explicit_dynamics.h"
#include "billet/solve/implicit/implicit_solution.h"

#include <memory>
#include <ostream>

namespace billet {

DiagnosticList check_meshes(const Scene &scene, const Discretization &discretization) {
  DiagnosticList messages = find_inverted_corners(scene, discretization);
  append(messages, find_faceted_curvature(scene, discretization));
  return messages;
}

namespace {

/// Sets up the solution as a run would. Returns the warnings of a run before its first step. Collective.
DiagnosticList check_start(const Scene &scene, MPI_Comm communicator) {
  const Discretization discretization(scene, communicator);
  DiagnosticList messages =
      check_plausibility(scene, discretization.dof_handler().get_triangulation(), communicator);
  const ProbeReader probes(scene, discretization); // refuses points outside bodies
  if (scene.parameters().restart.is_wanted())
    return messages;
  if (scene.parameters().is_explicit())
    append(messages, ExplicitDynamics(scene, discretization).initial_diagnostics());
  else
    append(messages, ImplicitSolution(scene, discretization).initial_diagnostics());
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

} // namespace

void check_simulation(const parameters::Scene &parameters, MPI_Comm communicator, std::ostream &stream,
                      const bool as_json) {
  fail_together(communicator, [&] { check_output_folder(parameters, EarlierResults::replaced); });
  if (parameters.restart.is_wanted())
    const CheckpointReader sound(communicator, parameters.restart.file.value, parameters.restart.file.origin);
  std::unique_ptr<const Scene> built; // it reads mesh files, which may fail on one rank alone
  fail_together(communicator, [&] { built = std::make_unique<const Scene>(parameters); });
  const Scene &scene = *built;
  constexpr std::size_t max_elements = 500000; // takes a minute and some GB on one rank
  DiagnosticList messages = parameters.warnings;
  append(messages, scene.count_elements() <= max_elements ? check_start(scene, communicator)
                                                          : check_outline(scene, communicator));
  append(messages, check_bricks(scene));
  if (dealii::Utilities::MPI::this_mpi_process(communicator) != 0)
    return;
  if (as_json) {
    stream << scene.describe_as_json(messages) << "\n";
    return;
  }
  scene.describe(stream);
  for (const auto &message : messages)
    stream << message.text() << "\n";
}

} // namespace billet
