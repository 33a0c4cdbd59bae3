// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_LOAD_WORKS_H
#define BILLET_SOLVE_LOAD_WORKS_H

#include "billet/forces/external_loads.h"
#include "billet/solve/reactions.h"
#include "billet/solve/restart.h"

#include <string>
#include <vector>

namespace billet {

/// Forces of each load, and the works that they have done on the bodies.
class LoadWorks {
public:
  /// `loads` must outlive this object.
  LoadWorks(const Scene &scene, const LocalNodes &nodes, const ExternalLoads &loads);

  /// Computes the forces at time t, and adds them to `sum`.
  void evaluate(double t, const NodalVectors &displacements, const NodalVectors &velocities,
                NodalVectors &sum);
  /// Does the same with the loads that act after t, the end of a step at which loads may begin or
  /// end.
  void evaluate_after(double t, const NodalVectors &displacements, const NodalVectors &velocities,
                      NodalVectors &sum);
  /// Whether the force of a load jumps at t: it begins there, or it ends and does not fade.
  bool jumps_at(double t) const;
  /// Adds `factor` F · `motion` to the works, for the last forces F.
  void add_works(const NodalVectors &motion, double factor);
  /// Returns forces and works of all ranks, in the order of named_loads(). Collective.
  std::vector<LoadResult> results() const;

  /// Save and restore the works. A scene with other loads begins with none.
  void save(StateWriter &writer) const;
  void load(const StateReader &reader);
  /// The same for the forces.
  void save_forces(StateWriter &writer, const OwnedNodes &nodes) const;
  void load_forces(const StateReader &reader, const OwnedNodes &nodes);

private:
  /// A load with its nodes on this rank.
  struct OfLoad {
    const AppliedLoad *load;
    std::vector<unsigned int> nodes;
    std::vector<dealii::Tensor<1, 3>> forces; ///< this rank's shares
    double work;                              ///< this rank's share
  };
  void evaluate_load(OfLoad &of_load, double t, const NodalVectors &displacements,
                     const NodalVectors &velocities, NodalVectors &sum);
  std::vector<double> own_works() const;

  const LocalNodes &nodes_;
  const ExternalLoads &loads_;
  std::vector<OfLoad> of_loads_;
  std::string names_; ///< of all loads
  NodalVectors scratch_;
};

} // namespace billet

#endif
