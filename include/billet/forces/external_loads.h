// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_FORCES_EXTERNAL_LOADS_H
#define BILLET_FORCES_EXTERNAL_LOADS_H

#include "billet/discretization/local_nodes.h"
#include "billet/discretization/supports.h"
#include "billet/usage.h"

#include <vector>

namespace billet {

/// Accelerations, pressures, springs and dashpots on the elements and faces of a rank.
class ExternalLoads {
public:
  /// `masses` of the nodes, this rank's share, as accelerations act on them.
  ExternalLoads(const Scene &scene, const LocalNodes &nodes, std::vector<double> masses);

  /// Adds the forces [force] at time t. Pressures act on the faces where they are, F_a = −∫ p N_a n dA;
  /// springs and dashpots on their undeformed area A_a at a node, F_a = −A_a (k P u + c P v), P = I, or d ⊗ d
  /// along a direction d.
  void add_forces(double t, const NodalVectors &displacements, const NodalVectors &velocities,
                  NodalVectors &forces) const;

  /// Adds −∂F/∂u − `damping_factor` ∂F/∂v [force/length]. Of a pressure
  ///   −∂F_a/∂x_b = ∫ p N_a (N_b,ξ [· × x,η] + N_b,η [x,ξ × ·]) dξdη,
  /// which is symmetric only where the pressure is uniform and its border held, or none.
  void add_tangent(double t, const NodalVectors &displacements, double damping_factor,
                   const TangentSystem &system) const;

  /// Adds to bounds at the nodes: on the stiffness [force/length], component 0, and on the damping [force
  /// time/length], component 1.
  void add_bounds(NodalVectors &bounds) const;

private:
  struct Acceleration {
    const Load *load;
    std::vector<unsigned int> nodes;
  };
  struct PressedFacet {
    std::array<unsigned int, 4> nodes;
    dealii::Point<3> centre; ///< undeformed
  };
  struct Pressure {
    const Load *load;
    std::vector<PressedFacet> facets;
  };
  /// A spring or dashpot at a node.
  struct Resistance {
    unsigned int node;
    bool has_direction;
    dealii::Tensor<1, 3> direction;
    double stiffness, damping; ///< [force/length], [force time/length]
  };
  void add_resistances(const Load &load, std::size_t body);
  void add_pressure_tangent(const PressedFacet &facet, double pressure, const NodalVectors &displacements,
                            const TangentSystem &system) const;

  const LocalNodes &nodes_;
  std::vector<double> masses_;
  std::vector<Acceleration> accelerations_;
  std::vector<Pressure> pressures_;
  std::vector<Resistance> resistances_;
  HeldMemory memory_{Capability::loads};
};

} // namespace billet

#endif
