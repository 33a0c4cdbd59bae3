// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/explicit/explicit_motion.h"

#include "billet/discretization/support_parts.h"
#include "billet/fail_together.h"
#include "billet/solve/fading_names.h"

#include <algorithm>
#include <set>

namespace billet {

using dealii::Tensor;

ExplicitMotion::ExplicitMotion(const Scene &scene, const LocalNodes &nodes)
    : nodes_(nodes), held_(scene, nodes), u_(nodes.make_vectors()), v_(u_), v_before_(u_), supports_(u_) {
  find_twins();
}

void ExplicitMotion::find_twins() {
  std::set<std::pair<unsigned int, unsigned int>> twins; // the prisms along the axis share them
  for (std::size_t b = 0; b < nodes_.discretization().n_bodies(); ++b)
    for (const auto &element : nodes_.elements(b))
      for (unsigned int v = 0; v < n_element_nodes; ++v)
        for (unsigned int bit = 1; bit < n_element_nodes; bit *= 2) {
          // An edge's corners differ in one bit.
          const unsigned int first = element[v & ~bit], second = element[v | bit];
          const auto apart =
              get_vector(nodes_.positions().data(), first) - get_vector(nodes_.positions().data(), second);
          if (first != second && !(apart.norm() > 0.))
            twins.emplace(first, second);
        }
  twins_.assign(twins.begin(), twins.end());
}

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
  check_agreement(scene, nodes_.discretization());
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
  for (const auto &[first, second] : twins_) {
    const Tensor<1, 3> sum = get_vector(node_forces.data(), first) + get_vector(node_forces.data(), second);
    const double all = masses.values()[first] + masses.values()[second];
    for (const unsigned int node : {first, second})
      for (unsigned int i = 0; i < 3; ++i)
        node_forces[std::size_t{nodal_stride} * node + i] = masses.values()[node] / all * sum[i];
  }
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

void ExplicitMotion::switch_supports(const double t_forces, const double t) {
  const ConstraintFilter acts = holding_at(t);
  if (failure_ || !held_.acting().differ(acts))
    return;
  fading_.erase(std::remove_if(fading_.begin(), fading_.end(),
                               [t](const Fading &fading) { return fading.times.end() <= t; }),
                fading_.end());
  try {
    release_forces(t_forces, acts);
    for (const unsigned int node : held_.nodes())
      std::fill_n(&supports_[std::size_t{nodal_stride} * node], nodal_stride, 0.);
    held_.release(t);
    held_.take(t, u_);
  } catch (const SolutionFailure &) { // as in kick()
    failure_ = std::current_exception();
  }
}

void ExplicitMotion::release_forces(const double t_forces, const ConstraintFilter &acts) {
  const Scene &scene = held_.scene();
  const std::map<std::size_t, double> ended = fading_supports(scene, held_.acting(), acts);
  if (ended.empty())
    return;
  std::map<std::size_t, Fading> released;
  for (const auto &[support, fade_time] : ended)
    released[support] = {{t_forces, fade_time}, support, {}};
  for (const SupportedNode &held :
       collect_supported_nodes(scene, nodes_.discretization(), held_.acting(), support_indices(scene))) {
    const unsigned int node = nodes_.find(held.dofs[0]);
    if (node == dealii::numbers::invalid_unsigned_int) // only at ghost cells
      continue;
    for (const SupportPart &part : held.parts)
      if (const auto found = released.find(part.support); found != released.end())
        found->second.forces.emplace_back(node, part.force(get_vector(supports_.data(), node)));
  }
  for (const auto &[support, fading] : released)
    fading_.push_back(fading);
}

void ExplicitMotion::add_fading(const double t, NodalVectors &forces) const {
  for (const Fading &fading : fading_) {
    const double left = fading.times.left(t);
    if (left > 0.)
      for (const auto &[node, force] : fading.forces)
        if (nodes_.is_owned(node)) // every rank that has the node knows its force
          add_vector(forces.data(), node, left * force);
  }
}

void ExplicitMotion::add_fading(const double t, std::vector<Resultant> &of_supports) const {
  for (const Fading &fading : fading_) {
    const double left = fading.times.left(t);
    if (!fading.support || left <= 0.)
      continue;
    Resultant &resultant = of_supports[*fading.support];
    for (const auto &[node, force] : fading.forces)
      if (nodes_.is_owned(node)) {
        const Tensor<1, 3> x = get_vector(nodes_.positions().data(), node) + get_vector(u_.data(), node);
        resultant.force += left * force;
        resultant.moment += dealii::cross_product_3d(x, left * force);
      }
  }
}

void ExplicitMotion::save_supports(StateWriter &writer, const NodalRows &rows) const {
  std::set<double> starts;
  for (const auto &start : held_.starts())
    starts.insert(start.first);
  save_support_starts(writer, starts, [&](const std::string &name, const double time) {
    const NodalVectors &start = held_.starts().at(time);
    rows.save(writer, name, [&start](const unsigned int node) { return get_vector(start.data(), node); });
  });
  std::vector<FadeTimes> times;
  std::vector<std::optional<std::size_t>> supports;
  for (const Fading &fading : fading_) {
    times.push_back(fading.times);
    supports.push_back(fading.support);
  }
  save_fading_supports(writer, held_.scene(), supports);
  save_support_fades(writer, times, [&](const std::string &name, const std::size_t i) {
    NodalVectors forces = nodes_.make_vectors();
    for (const auto &[node, force] : fading_[i].forces)
      add_vector(forces.data(), node, force);
    rows.save(writer, name, [&forces](const unsigned int node) { return get_vector(forces.data(), node); });
  });
}

void ExplicitMotion::load_supports(const StateReader &reader, const NodalRows &rows, const double t) {
  std::map<double, NodalVectors> starts;
  const auto load = [&](const std::string &name, const double time) {
    starts[time] = nodes_.make_vectors();
    rows.load(reader, name, starts[time]);
  };
  for (const double time : load_support_starts(reader, late_beginnings(held_.scene(), holding_at(t)), load))
    starts[time] = u_;
  fail_together(nodes_.discretization().communicator(), [&] { held_.resume(t, std::move(starts)); });
  fading_.clear();
  load_support_fades(reader, [&](const std::string &name, const FadeTimes &times) {
    NodalVectors forces = nodes_.make_vectors();
    rows.load(reader, name, forces);
    fading_.push_back({times, std::nullopt, {}});
    for (unsigned int node = 0; node < nodes_.size(); ++node)
      if (const Tensor<1, 3> force = get_vector(forces.data(), node); force.norm_square() > 0.)
        fading_.back().forces.emplace_back(node, force);
  });
  const std::vector<std::optional<std::size_t>> supports =
      load_fading_supports(reader, held_.scene(), fading_.size());
  for (std::size_t i = 0; i < fading_.size(); ++i)
    fading_[i].support = supports[i];
}

void ExplicitMotion::save(StateWriter &writer, const NodalRows &rows, const double step) const {
  const auto vectors_of = [](const NodalVectors &values) {
    return [&values](const unsigned int node) { return get_vector(values.data(), node); };
  };
  rows.save(writer, "displacements", vectors_of(u_));
  rows.save(writer, "velocities after", vectors_of(v_));
  rows.save(writer, "velocities before", vectors_of(v_before_));
  save_supports(writer, rows);
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
