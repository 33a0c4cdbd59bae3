// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_SWITCHED_SUPPORTS_H
#define BILLET_SOLVE_IMPLICIT_SWITCHED_SUPPORTS_H

#include "billet/discretization/supports.h"
#include "billet/solve/implicit/dead_forces.h"
#include "billet/solve/restart.h"

#include <optional>
#include <vector>

namespace billet {

/// Supports that begin and end between steps. Their reactions at the end become dead forces on
/// their nodes, and fade.
class SwitchedSupports {
public:
  SwitchedSupports(const Scene &scene, const Discretization &discretization)
      : scene_(scene), discretization_(discretization), supports_(scene, discretization) {}

  const Supports &get() const { return supports_; }
  /// Whether the set of supports changes after t.
  bool is_due(const double t) const { return supports_.acting().differ(holding_after(t)); }
  /// Lets supports go and takes others as they are due at t. `reactions`: sum of all forces on the
  /// bodies, without constraints, with the sign of the residual. Returns the part of them that the
  /// supports that ended have borne and that remains at t as forces on the bodies. Collective.
  Vector switch_supports(double t, const Vector &reactions, const Vector &displacements);

  /// Whether the fading forces differ between t and t_n.
  bool changes(double t_n, double t) const;
  /// Subtracts the fading forces at t from the residual.
  void add_forces(double t, Vector &residual) const;
  /// Calls visit(index in named_supports(), part that is left at t, forces) for fading forces of
  /// supports of this scene.
  template <class Visit> void visit_fading(const double t, const Visit &visit) const {
    for (const Fading &fading : fading_)
      if (const double left = fading.times.left(t); left > 0. && fading.support)
        visit(*fading.support, left, fading.forces);
  }
  /// Returns their work from t_n to t.
  double work(double t_n, double t, const Vector &increment) const;

  void save(StateWriter &writer, const OwnedNodes &nodes) const;
  /// Takes the supports that act after t. Those of which the state does not know where their nodes
  /// were hold them at these `displacements` (relevant dofs). Collective.
  void load(const StateReader &reader, const OwnedNodes &nodes, double t, const Vector &displacements);

private:
  struct Fading {
    FadeTimes times;
    std::optional<std::size_t> support; ///< index in named_supports(); none: of another scene
    DeadForces forces;
  };
  /// Returns the forces of supports that end, by their indices in named_supports(). Collective.
  std::vector<Fading> release_forces(double t, Vector reactions) const;

  const Scene &scene_;
  const Discretization &discretization_;
  Supports supports_;
  std::vector<Fading> fading_;
};

} // namespace billet

#endif
