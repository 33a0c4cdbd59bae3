// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/law_messages.h"

#include "billet/algebra/gather.h"
#include "billet/material/user_subroutine.h"
#include "billet/scene/law_checks.h"

#include <algorithm>

namespace billet {

DiagnosticList gather_law_messages(const Scene &scene, const MPI_Comm communicator, const double time) {
  const bool has_subroutines =
      std::any_of(scene.bodies().begin(), scene.bodies().end(),
                  [](const Body &body) { return find_user_subroutine(*body.law) != nullptr; });
  if (!has_subroutines)
    return {};
  DiagnosticList own = describe(take_subroutine_messages());
  if (dealii::Utilities::MPI::max(own.size(), communicator) == 0)
    return {};
  for (Diagnostic &message : own)
    message.time(time);
  DiagnosticList all;
  for (const std::string &of_rank : all_gather(communicator, serialize(own)))
    append(all, deserialize(of_rank));
  return all;
}

} // namespace billet
