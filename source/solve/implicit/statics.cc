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
  length_ = t - t_n;
  start_ = displacements;
}

double Statics::add_loads(const double t, const Vector &displacements, Vector &residual) {
  Vector velocities = displacements;
  velocities -= start_;
  velocities *= length_ > 0. ? 1. / length_ : 0.;
  return loads_.subtract(t, displacements, velocities, residual);
}

void Statics::add_tangent(const double t, const TangentSystem &system) const {
  loads_.add_tangent(t, length_ > 0. ? 1. / length_ : 0., system);
}

void Statics::commit(const Vector &displacements, const Vector &increment, const Vector &mean_forces,
                     const double touching, EnergyLedger &energies) {
  ImplicitScheme::commit(displacements, increment, mean_forces, touching, energies);
  energies.external += loads_.commit(increment);
}

void Statics::save(StateWriter &writer, const OwnedNodes &nodes) const { loads_.save(writer, nodes); }

void Statics::load(const StateReader &reader, const OwnedNodes &nodes) {
  if (reader.has("load forces"))
    loads_.load(reader, nodes);
}

} // namespace billet
