// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_STATICS_H
#define BILLET_SOLVE_IMPLICIT_STATICS_H

#include "billet/solve/implicit/load_forces.h"
#include "billet/solve/implicit/scheme.h"

namespace billet {

/// Statics with loads. Velocities, which dashpots resist, are the step's means, Δu/Δt: the time of
/// the scene is that of the process. Before the first step there are no loads, so they grow during
/// it.
class Statics final : public ImplicitScheme {
public:
  Statics(const Scene &scene, const Discretization &discretization);

  void start_step(double t_n, double t, const Vector &displacements,
                  const std::vector<double> &offsets) override;
  /// At the start of the step, as opposed to its end, the loads are those of the last one.
  double add_loads(double t, const Vector &displacements, Vector &residual) override;
  bool add_load_change(double t, const Vector &displacements, Vector &forces) override;
  void add_tangent(double t, const TangentSystem &system) const override;
  /// Makes the loads of the last add_loads() those at the start of the step.
  void start_loads() override { loads_.start(); }
  std::vector<LoadResult> commit(const Vector &displacements, const Vector &increment,
                                 const Vector &mean_forces, double touching, EnergyLedger &energies) override;

  void save(StateWriter &writer, const OwnedNodes &nodes) const override;
  void load(const StateReader &reader, const OwnedNodes &nodes) override;

private:
  LocalNodes nodes_;
  LoadForces loads_;
  double t_n_ = 0., length_ = 0.; ///< of the step; length 0: none yet [time]
  Vector start_;                  ///< displacements at its start
};

} // namespace billet

#endif
