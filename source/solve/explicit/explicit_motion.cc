// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/explicit/explicit_motion.h"

#include <algorithm>

namespace billet {

ExplicitMotion::ExplicitMotion(const Scene &scene, const LocalNodes &nodes)
    : nodes_(nodes), held_(scene, nodes), u_(nodes.make_vectors()), v_(u_), v_before_(u_), supports_(u_) {}

void ExplicitMotion::begin(const Scene &scene) {
  fail_together(nodes_.discretization().communicator(), [&] {
    check_before_start([&] {
      for (std::size_t b = 0; b < scene.bodies().size(); ++b)
        for (const auto &element : nodes_.elements(b))
          for (const unsigned int node : element) {
            const dealii::Point<3> position(get_vector(nodes_.positions().data(), node));
            for (unsigned int i = 0; i < 3; ++i)
              v_[std::size_t{nodal_stride} * node + i] =
                  scene.bodies()[b].initial_velocity[i].value(0., position);
          }
    });
  });
  // Contradictory planes are detected here, if they contradict each other at one of these times.
  const Supports supports(scene, nodes_.discretization());
  constexpr unsigned int n_checks = 16;
  check_before_start([&] {
    for (unsigned int check = 0; check <= n_checks; ++check)
      supports.at_time(scene.parameters().time_stepping.end_time * check / n_checks);
  });
  held_.set_displacements(0., u_);
}

NodalVectors ExplicitMotion::mean_velocities() const {
  NodalVectors v = v_;
  for (std::size_t k = 0; k < v.size(); ++k)
    v[k] = 0.5 * (v_[k] + v_before_[k]);
  return v;
}

NodalVectors ExplicitMotion::displacements_before(const double step) const {
  NodalVectors u = u_;
  for (std::size_t k = 0; k < u.size(); ++k)
    u[k] -= step * v_[k];
  return u;
}

double ExplicitMotion::max_displacement() const {
  double maximum = 0.;
  for (unsigned int node = 0; node < nodes_.size(); ++node)
    maximum = std::max(maximum, get_vector(u_.data(), node).norm());
  return maximum;
}

void ExplicitMotion::kick(const ExplicitClock &clock, const NodalMasses &masses, NodalVectors &node_forces) {
  Usage::count(Capability::inertia, masses.inverse().size());
  const bool is_first = clock.is_at_start();
  const double half_sum = is_first ? clock.step() : 0.5 * (clock.step_before() + clock.step());
  // At the start v_ is v_0, and v_{−½} follows below.
  const double weight = is_first ? 0.5 * clock.step() : half_sum;
  std::swap(v_, v_before_);
  double *v = v_.data(), *forces = node_forces.data();
  const double *v_before = v_before_.data();
  for (const double inverse_mass : masses.inverse()) {
    const double factor = weight * inverse_mass;
    for (unsigned int i = 0; i < nodal_stride; ++i) {
      v[i] = v_before[i] + factor * forces[i];
      forces[i] = 0.; // now, while it is in the cache, for the next step
    }
    v += nodal_stride;
    v_before += nodal_stride;
    forces += nodal_stride;
  }
  for (const unsigned int node : held_.nodes())
    std::fill_n(&supports_[std::size_t{nodal_stride} * node], nodal_stride, 0.);
  try {
    held_.constrain(clock.time(), clock.step(), u_, masses.values(), v_, supports_);
  } catch (const SolutionFailure &) { // of this rank; the others do not know until the next forces
    failure_ = std::current_exception();
  }
  for (const unsigned int node : held_.nodes())
    for (unsigned int i = 0; i < 3; ++i)
      supports_[std::size_t{nodal_stride} * node + i] /= weight;
  if (is_first)
    for (std::size_t k = 0; k < v_.size(); ++k)
      v_before_[k] = 2. * v_before_[k] - v_[k];
}

void ExplicitMotion::move(const double step) {
  for (std::size_t k = 0; k < u_.size(); ++k)
    u_[k] += step * v_[k];
}

void ExplicitMotion::save(StateWriter &writer, const NodalRows &rows, const double step) const {
  const auto vectors_of = [](const NodalVectors &values) {
    return [&values](const unsigned int node) { return get_vector(values.data(), node); };
  };
  rows.save(writer, "displacements", vectors_of(u_));
  rows.save(writer, "velocities after", vectors_of(v_));
  rows.save(writer, "velocities before", vectors_of(v_before_));
  // Histories belong to the last forces; another method resumes from the state of that time.
  rows.save(writer, "displacements before", [&](const unsigned int node) {
    return get_vector(u_.data(), node) - step * get_vector(v_.data(), node);
  });
  rows.save(writer, "velocities", [&](const unsigned int node) {
    return 0.5 * (get_vector(v_.data(), node) + get_vector(v_before_.data(), node));
  });
}

void ExplicitMotion::load(const StateReader &reader, const NodalRows &rows) {
  rows.load(reader, "displacements", u_);
  rows.load(reader, "velocities after", v_);
  rows.load(reader, "velocities before", v_before_);
}

void ExplicitMotion::load_foreign(const StateReader &reader, const NodalRows &rows) {
  rows.load(reader, reader.has("displacements before") ? "displacements before" : "displacements", u_);
  if (reader.has("velocities"))
    rows.load(reader, "velocities", v_);
}

} // namespace billet
