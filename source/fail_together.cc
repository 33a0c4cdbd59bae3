// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/fail_together.h"

#include <deal.II/base/mpi.h>

#include <exception>
#include <stdexcept>
#include <string>

namespace billet {

namespace {

enum class Failure { none = 0, input, solution, other };

} // namespace

void fail_together(MPI_Comm communicator, const std::function<void()> &action) {
  Failure failure = Failure::none;
  std::string content; // all of the diagnostic; for other exceptions, the text
  try {
    action();
  } catch (const InputError &error) {
    failure = Failure::input;
    content = serialize(error.diagnostics());
  } catch (const SolutionFailure &error) {
    failure = Failure::solution;
    content = error.diagnostic().serialize();
  } catch (const std::exception &error) {
    failure = Failure::other;
    content = error.what();
  }

  // The lowest rank that failed provides the exception for all.
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(communicator);
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(communicator);
  const unsigned int speaker =
      dealii::Utilities::MPI::min(failure == Failure::none ? n_ranks : rank, communicator);
  if (speaker == n_ranks)
    return;
  const int kind = dealii::Utilities::MPI::broadcast(communicator, static_cast<int>(failure), speaker);
  content = dealii::Utilities::MPI::broadcast(communicator, content, speaker);
  switch (static_cast<Failure>(kind)) {
  case Failure::none: // the speaker has failed
  case Failure::other:
    break;
  case Failure::input:
    throw InputError(deserialize(content));
  case Failure::solution:
    throw SolutionFailure(Diagnostic::deserialize(content));
  }
  throw std::runtime_error(content);
}

} // namespace billet
