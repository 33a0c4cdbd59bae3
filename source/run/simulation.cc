// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/simulation.h"

#include "billet/output/capabilities_file.h"
#include "billet/run/output_folder.h"
#include "billet/run/run.h"

#include <memory>

namespace billet {

ExitCode run_simulation(const parameters::Scene &parameters, MPI_Comm communicator) {
  // All errors of the scene appear here, before anything is written.
  fail_together(communicator, [&] { check_output_folder(parameters); });
  const std::unique_ptr<Resumption> resumption = Resumption::open(parameters, communicator);
  std::unique_ptr<const Scene> built; // it reads mesh files, which may fail on one rank alone
  fail_together(communicator, [&] { built = std::make_unique<const Scene>(parameters); });
  const Scene &scene = *built;
  Diagnostics diagnostics(dealii::Utilities::MPI::this_mpi_process(communicator) == 0);
  ExitCode code = ExitCode::success;
  try {
    const std::unique_ptr<Run> run = make_run(scene, communicator, resumption.get());
    RunOutput output(scene, communicator, diagnostics, resumption.get());
    code = run_to_end(*run, output, resumption.get());
  } catch (const SolutionFailure &failure) { // on all ranks
    diagnostics.report(failure.diagnostic());
    diagnostics.write_summary(static_cast<int>(ExitCode::failed_solution));
    throw;
  }
  fail_together(communicator, [&] {
    if (!diagnostics.write_summary(static_cast<int>(code)))
      throw file_lost("'" + diagnostics.file_name() + "'");
  });
  write_capabilities(parameters.output.folder.value, communicator);
  return code;
}

} // namespace billet
