// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/simulation.h"

#include "billet/diagnostic_kinds.h"
#include "billet/fail_together.h"
#include "billet/output/capabilities_file.h"
#include "billet/output/console_log.h"
#include "billet/run/output_folder.h"
#include "billet/run/run.h"

#include <iostream>
#include <memory>
#include <utility>

namespace billet {

namespace {

EarlierResults treat_earlier_results(const parameters::Scene &parameters, const Resumption *resumption,
                                     const RunOptions &options) {
  if (resumption != nullptr && resumption->is_from(parameters.output.folder.value))
    return EarlierResults::continued;
  return options.replaces_results ? EarlierResults::replaced : EarlierResults::moved_aside;
}

} // namespace

ExitCode run_simulation(const parameters::Scene &parameters, MPI_Comm communicator,
                        const RunOptions &options) {
  // All errors of the scene appear here, before anything is written.
  const bool is_first = dealii::Utilities::MPI::this_mpi_process(communicator) == 0;
  const std::unique_ptr<Resumption> resumption = Resumption::open(parameters, communicator);
  const EarlierResults earlier = treat_earlier_results(parameters, resumption.get(), options);
  fail_together(communicator, [&] { check_output_folder(parameters, earlier); });
  const std::unique_ptr<const Scene> built = build_scene(parameters, communicator);
  const Scene &scene = *built;
  Diagnostics diagnostics(is_first);
  ExitCode code = ExitCode::success;
  try {
    std::unique_ptr<Run> run = make_run(scene, communicator, resumption.get());
    std::string moved;
    fail_together(communicator, [&] {
      if (!is_first)
        return;
      moved = prepare_output_folder(parameters, earlier);
      if (options.log != nullptr)
        options.log->open(parameters.output.folder.value + "/" + log_file,
                          earlier == EarlierResults::continued);
    });
    RunOutput output(scene, communicator, diagnostics, resumption.get(), options);
    if (!moved.empty()) // no message of the run: it depends on what was there before
      output.progress().show_diagnostic(
          Severity::note,
          Diagnostic(diagnostic::results_moved, "The results of an earlier run are now in '" + moved + "'")
              .text());
    code = run_to_end(std::move(run), scene, output, resumption.get());
    output.report(write_capabilities(parameters.output.folder.value, communicator));
  } catch (const AlreadyComplete &complete) { // on all ranks
    if (is_first)
      std::cout << complete.diagnostic.text() << std::endl;
    return ExitCode::success;
  } catch (const SolutionFailure &failure) { // on all ranks
    diagnostics.report(failure.diagnostic());
    diagnostics.write_summary(static_cast<int>(ExitCode::failed_solution));
    throw;
  }
  fail_together(communicator, [&] {
    if (!diagnostics.write_summary(static_cast<int>(code)))
      throw file_lost("'" + diagnostics.file_name() + "'");
  });
  return code;
}

} // namespace billet
