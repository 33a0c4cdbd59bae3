// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DISCRETIZATION_HELD_MOTION_H
#define BILLET_DISCRETIZATION_HELD_MOTION_H

#include "billet/discretization/local_nodes.h"
#include "billet/discretization/supports.h"
#include "billet/usage.h"

#include <vector>

namespace billet {

/// Supports, prescribed displacements and symmetry planes for schemes without a matrix: at a held node the
/// velocity's components along the planes' normals are what the planes prescribe, the rest stays free.
class HeldMotion {
public:
  HeldMotion(const Scene &scene, const LocalNodes &nodes);

  /// That are held.
  const std::vector<unsigned int> &nodes() const { return held_; }

  /// Puts the nodes to where the planes have them at time t.
  void set_displacements(double t, NodalVectors &displacements) const;

  /// Makes `velocities` those that bring `displacements` of time t to where the planes are at t + dt. Adds to
  /// `impulses` what the planes give the nodes for it, masses being one entry a node [force time].
  void constrain(double t, double dt, const NodalVectors &displacements, const std::vector<double> &masses,
                 NodalVectors &velocities, NodalVectors &impulses) const;

private:
  struct Term {
    const Hold *hold;
    double weight;
  };
  /// One of up to three orthonormal directions e at a node: e · u = Σ weight value(t).
  struct Direction {
    dealii::Tensor<1, 3> e;
    std::vector<Term> terms;
  };
  struct Node {
    unsigned int node;
    dealii::Point<3> position;
    std::vector<Direction> directions;
  };
  static double value(const Direction &direction, double t, const dealii::Point<3> &position);

  std::vector<Node> nodes_;
  std::vector<unsigned int> held_;
  std::size_t n_moving_ = 0; ///< nodes with a prescribed motion
  HeldMemory moving_memory_{Capability::moving_supports};
};

} // namespace billet

#endif
