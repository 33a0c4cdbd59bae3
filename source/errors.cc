// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/errors.h"

#include <deal.II/base/mpi.h>

namespace billet {

namespace {

enum class Failure { none = 0, input, solution, other };

} // namespace

void fail_together(MPI_Comm communicator, const std::function<void()> &action) {
  Failure failure = Failure::none;
  std::string message;
  try {
    action();
  } catch (const InputError &error) {
    failure = Failure::input;
    message = error.what();
  } catch (const SolutionFailure &error) {
    failure = Failure::solution;
    message = error.what();
  } catch (const std::exception &error) {
    failure = Failure::other;
    message = error.what();
  }

  // The lowest rank that failed speaks for all.
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(communicator);
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(communicator);
  const unsigned int speaker =
      dealii::Utilities::MPI::min(failure == Failure::none ? n_ranks : rank, communicator);
  if (speaker == n_ranks)
    return;
  const int kind = dealii::Utilities::MPI::broadcast(communicator, static_cast<int>(failure), speaker);
  message = dealii::Utilities::MPI::broadcast(communicator, message, speaker);
  switch (static_cast<Failure>(kind)) {
  case Failure::input:
    throw InputError(message);
  case Failure::solution:
    throw SolutionFailure(message);
  default:
    throw std::runtime_error(message);
  }
}

void check_before_start(const std::function<void()> &action) {
  try {
    action();
  } catch (const SolutionFailure &error) {
    throw InputError(error.what());
  }
}

} // namespace billet
