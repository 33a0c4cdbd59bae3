// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_RUN_PREVIEW_H
#define BILLET_RUN_PREVIEW_H

#include "billet/parameters/scene.h"

#include <mpi.h>

#include <iosfwd>
#include <string>

namespace billet {

/// Checks a scene as a run would, and writes it undeformed to the folder `preview` in its output
/// folder. It writes bodies with their ids, contact surfaces, tools at the start and at the end,
/// supports and loads as arrows. Says on the first rank what to open, and draws a picture if
/// ParaView's pvbatch is there. Throws InputError. Collective.
void preview_simulation(const parameters::Scene &parameters, MPI_Comm communicator, std::ostream &stream);

/// Draws the results that a ParaView script shows, without a display. Returns the name of the
/// picture, or why there is none.
struct Picture {
  std::string file, reason;
};
Picture draw_picture(const std::string &script, const std::string &file);

} // namespace billet

#endif
