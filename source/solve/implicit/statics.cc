// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/implicit/statics.h"

namespace billet {

Statics::Statics(const Scene &scene, const Discretization &discretization)
    : nodes_(discretization), loads_(scene, discretization, nodes_,
                                     [&](const LocalNodes &nodes) {
                                       return Inertia(scene, discretization, false).nodal_masses(nodes);
                                     }),
      start_(discretization.make_owned_vector()) {}

void Statics::start_step(const double t_n, const double t, const Vector &displacements,
                         const std::vector<double> & /*offsets*/) {
  t_n_ = t_n;
  length_ = t - t_n;
  start_ = displacements;
}

double Statics::add_loads(const double t, const Vector &displacements, Vector &residual) {
  if (length_ > 0. && t <= t_n_) {
    residual -= loads_.at_start();
    return loads_.at_start().l2_norm();
  }
  Vector velocities = displacements;
  velocities -= start_;
  velocities *= length_ > 0. ? 1. / length_ : 0.;
  return loads_.subtract(t, displacements, velocities, residual);
}

bool Statics::add_load_change(const double t, const Vector &displacements, Vector &forces) {
  Vector at_rest = forces;
  at_rest = 0.;
  Vector change = loads_.at_start();
  loads_.subtract(t, displacements, at_rest, change);
  forces -= change;
  return true;
}

void Statics::add_tangent(const double t, const TangentSystem &system) const {
  loads_.add_tangent(t, length_ > 0. ? 1. / length_ : 0., system);
}

std::vector<LoadResult> Statics::commit(const Vector &displacements, const Vector &increment,
                                        const Vector &mean_forces, const double touching,
                                        EnergyLedger &energies) {
  ImplicitScheme::commit(displacements, increment, mean_forces, touching, energies);
  energies.external += loads_.commit(increment);
  return loads_.results();
}

void Statics::save(StateWriter &writer, const OwnedNodes &nodes) const { loads_.save(writer, nodes); }

void Statics::load(const StateReader &reader, const OwnedNodes &nodes) {
  if (reader.has("load forces"))
    loads_.load(reader, nodes);
}

} // namespace billet
