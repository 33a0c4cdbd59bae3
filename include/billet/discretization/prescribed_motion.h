// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_DISCRETIZATION_PRESCRIBED_MOTION_H
#define BILLET_DISCRETIZATION_PRESCRIBED_MOTION_H

#include "billet/discretization/local_nodes.h"
#include "billet/discretization/supports.h"
#include "billet/usage.h"

#include <vector>

namespace billet {

/// Constraints by supports, prescribed displacements and symmetry planes for schemes without a
/// matrix. At a constrained node they prescribe the velocity's components along their normals; the
/// others stay free.
class PrescribedMotion {
public:
  PrescribedMotion(const Scene &scene, const LocalNodes &nodes);

  const Scene &scene() const { return scene_; }
  /// Returns the constraints that act.
  const ActingConstraints &acting() const { return acting_; }
  /// Lets those supports go that do not hold at t.
  void release(double t);
  /// Takes the supports that hold at t. Those that begin hold the nodes where these `displacements`
  /// put them.
  void take(double t, const NodalVectors &displacements);
  /// Returns the displacements at the times at which supports that act began, if later than 0.
  const std::map<double, NodalVectors> &starts() const { return starts_; }
  /// Takes the supports that hold at t, with their starts().
  void resume(double t, std::map<double, NodalVectors> starts);

  /// Returns the constrained nodes.
  const std::vector<unsigned int> &nodes() const { return held_; }

  /// Sets the constrained displacements to their values at time t.
  void set_displacements(double t, NodalVectors &displacements) const;

  /// Sets the constrained `velocities` so that `displacements` at time t reach their prescribed
  /// values at t + dt. Adds the impulses of the constraints to `impulses` [force time]. `masses`:
  /// one entry for each node.
  void constrain(double t, double dt, const NodalVectors &displacements, const std::vector<double> &masses,
                 NodalVectors &velocities, NodalVectors &impulses) const;

private:
  struct Term {
    const Constraint *constraint;
    double weight;
  };
  /// One of up to three orthonormal constrained directions e at a node: e · u = Σ weight value(t).
  struct Direction {
    dealii::Tensor<1, 3> e;
    std::vector<Term> terms;
    double start; ///< of supports that began within the run: the part that does not depend on time
  };
  struct Node {
    unsigned int node;
    dealii::Point<3> position;
    std::vector<Direction> directions;
  };
  /// Makes the nodes of the constraints that act.
  void rebuild();
  /// Returns the position n · u less the value at the time when a late support began.
  double start_of(const Constraint &constraint, const ConstrainedNode &held, unsigned int node) const;
  static double value(const Direction &direction, double t, const dealii::Point<3> &position);

  const Scene &scene_;
  const LocalNodes &local_;
  ActingConstraints acting_;
  std::map<double, NodalVectors> starts_;
  std::vector<Node> nodes_;
  std::vector<unsigned int> held_;
  std::size_t n_moving_ = 0; ///< nodes with a prescribed motion
  HeldMemory moving_memory_{Capability::moving_supports};
};

} // namespace billet

#endif
