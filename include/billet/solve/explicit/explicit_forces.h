// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_EXPLICIT_EXPLICIT_FORCES_H
#define BILLET_SOLVE_EXPLICIT_EXPLICIT_FORCES_H

#include "billet/forces/external_loads.h"
#include "billet/solve/explicit/explicit_motion.h"
#include "billet/solve/explicit/explicit_tools.h"
#include "billet/solve/explicit/stable_step.h"
#include "billet/solve/load_works.h"

#include <exception>
#include <string>
#include <vector>

namespace billet {

/// Forces F_n = F_ext + F_c − F_int at the nodes of a rank, and their bounds on the step.
class ExplicitForces {
public:
  /// Accelerations act on the present masses of the elements. `contact_resolution`: the square of
  /// it multiplies penalties in the bounds. Collective.
  ExplicitForces(const Scene &scene, const LocalNodes &nodes, const ExplicitElements &elements,
                 double contact_resolution);

  /// Failure of this rank, or none.
  using Failure = std::exception_ptr;
  /// Computes F_n, advances the histories of elements and contacts, and adds to `works`. Returns
  /// the failure of this rank. Collective, also if a rank fails.
  Failure compute(const ExplicitClock &clock, const ExplicitMotion &motion, ExplicitElements &elements,
                  Contacts &contacts, ExplicitTools &tools, ExplicitWorks &works);

  /// Returns F_n, of all ranks; zero once the nodes have been kicked [force].
  NodalVectors &values() { return forces_; }
  /// Returns the part of F_n by loads and removed tools on this rank. It is zero except at
  /// loaded_nodes().
  const NodalVectors &external() const { return external_; }
  /// Returns forces and works of each load.
  LoadWorks &of_loads() { return of_loads_; }
  const LoadWorks &of_loads() const { return of_loads_; }
  const std::vector<unsigned int> &loaded_nodes() const { return loaded_nodes_; }
  /// Returns the nodes of this rank that come through surfaces at t_n.
  const Crossings &crossings() const { return crossings_; }
  /// Returns the bounds on the step on this rank at the last forces. A rank that failed has a
  /// negative step.
  StepBounds bounds(const std::vector<double> &inverse_masses) const;
  /// Returns the largest Σ k/m of contacts at a node of this rank if the nodes were displaced so,
  /// and the tools so placed. Histories stay. Collective.
  double frequency_square_at(const NodalVectors &displacements, const std::vector<Placement> &placements,
                             Contacts &contacts, const std::vector<double> &inverse_masses);
  /// Returns the largest bound on the stiffness of contacts and springs at a node [force/length].
  double max_stiffness() const;

private:
  void find_touched_nodes(const Scene &scene);
  /// Returns why nodes of this rank have passed through a tool; empty if none has. Collective.
  Explanation add_contact_forces(const ExplicitClock &clock, const ExplicitMotion &motion, Contacts &contacts,
                                 ExplicitTools &tools, ExplicitWorks &works);

  const LocalNodes &nodes_;
  ExternalLoads loads_;
  LoadWorks of_loads_;
  double bound_factor_; ///< of contacts
  NodalVectors forces_, external_;
  /// Bounds of stiffness and damping beside the elements' own; zero except at bounded_nodes_.
  NodalVectors bounds_;
  std::vector<unsigned int> loaded_nodes_, bounded_nodes_; ///< of this rank; of all ranks
  /// Whether there are contacts, springs or dashpots on any rank.
  bool has_bounds_ = false;
  double element_step_ = 0.;
  Crossings crossings_;
};

} // namespace billet

#endif
