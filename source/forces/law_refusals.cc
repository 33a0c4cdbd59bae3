// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/forces/law_refusals.h"

#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"
#include "billet/fail_together.h"
#include "billet/material/user_subroutine.h"

#include <deal.II/base/mpi.h>

namespace billet {

std::string describe_refusal(const PointLaw &law) {
  const auto *const user_law = find_user_subroutine(law);
  return user_law != nullptr ? user_law->refusal().what : "";
}

std::string find_law_refusal(const parameters::Scene &scene, MPI_Comm communicator) {
  std::string own;
  bool has_user_laws = false;
  fail_together(communicator, [&] {
    for (const parameters::Body &body : scene.bodies) {
      const auto *const law = find_user_subroutine(*body.material.law);
      has_user_laws = has_user_laws || law != nullptr;
      if (law == nullptr || law->refusal().what.empty())
        continue;
      if (law->refusal().is_final)
        throw SolutionFailure(Diagnostic(diagnostic::solution_failed, law->refusal().what)
                                  .body(body.name)
                                  .advice("Correct the library; 'billet --certify' tries it out"));
      if (own.empty())
        own = law->refusal().what;
    }
  });
  if (!has_user_laws) // on all ranks or on none
    return "";
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(communicator);
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(communicator);
  const unsigned int speaker = dealii::Utilities::MPI::min(own.empty() ? n_ranks : rank, communicator);
  return speaker < n_ranks ? dealii::Utilities::MPI::broadcast(communicator, own, speaker) : "";
}

} // namespace billet
