// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_EXPLICIT_EXPLICIT_PARTS_H
#define BILLET_SOLVE_EXPLICIT_EXPLICIT_PARTS_H

#include "billet/solve/explicit/explicit_forces.h"

namespace billet {

/// Parts of an explicit scene; each is made from those before it.
struct ExplicitParts {
  /// Throws InputError, on all ranks, for a scene that is not admissible. Collective.
  ExplicitParts(const Scene &scene, const Discretization &discretization);

  const parameters::ExplicitDynamics &settings() const { return scene.parameters().explicit_dynamics; }
  MPI_Comm communicator() const { return discretization.communicator(); }

  const Scene &scene;
  const Discretization &discretization;
  ExplicitClock clock;
  LocalNodes nodes;
  ExplicitMotion motion;
  ExplicitElements elements;
  Contacts contacts;
  ExplicitForces forces; ///< before masses are scaled: loads do not act on the mass added
  NodalMasses masses;
  ExplicitTools tools;
};

} // namespace billet

#endif
