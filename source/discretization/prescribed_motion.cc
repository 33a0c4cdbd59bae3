// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/discretization/prescribed_motion.h"

#include "billet/discretization/hanging_nodes.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

PrescribedMotion::PrescribedMotion(const Scene &scene, const LocalNodes &nodes)
    : scene_(scene), local_(nodes), acting_(scene, holding_at(0.)) {
  require_no_hanging_nodes(nodes.discretization().dof_handler(), "Explicit dynamics");
  rebuild();
}

double PrescribedMotion::start_of(const Constraint &constraint, const ConstrainedNode &held,
                                  const unsigned int node) const {
  if (!constraint.times.is_late())
    return 0.;
  const double place =
      get_vector(starts_.at(constraint.times.from).data(), node) * constraint.direction(held.position);
  return constraint.value != nullptr ? place - constraint.value->value(constraint.times.from, held.position)
                                     : place;
}

void PrescribedMotion::rebuild() {
  nodes_.clear();
  held_.clear();
  n_moving_ = 0;
  const auto acts = [this](const Constraint &constraint) { return acting_(constraint); };
  for (const auto &[dof, held] : collect_constrained_nodes(scene_, local_.discretization(), acts)) {
    Node node{local_.find(dof), held.position, {}};
    if (node.node == dealii::numbers::invalid_unsigned_int) // only at ghost cells
      continue;
    // Gram-Schmidt on the planes' unit normals. A dependent normal adds nothing.
    constexpr double min_independent = 1e-8;
    for (const Constraint *constraint : held.constraints) {
      const Tensor<1, 3> normal = constraint->direction(held.position);
      Direction direction{normal, {}, start_of(*constraint, held, node.node)};
      if (constraint->value != nullptr)
        direction.terms.push_back({constraint, 1.});
      for (const auto &before : node.directions) {
        const double part = normal * before.e;
        direction.e -= part * before.e;
        direction.start -= part * before.start;
        for (const auto &term : before.terms)
          direction.terms.push_back({term.constraint, -part * term.weight});
      }
      const double length = direction.e.norm();
      if (length < min_independent)
        continue;
      direction.e /= length;
      direction.start /= length;
      for (auto &term : direction.terms)
        term.weight /= length;
      node.directions.push_back(direction);
    }
    if (std::any_of(node.directions.begin(), node.directions.end(),
                    [](const Direction &direction) { return !direction.terms.empty(); }))
      ++n_moving_;
    nodes_.push_back(node);
    held_.push_back(node.node);
  }
  moving_memory_.set(n_moving_ * sizeof(Node));
}

void PrescribedMotion::release(const double t) {
  for (const double fade_time : acting_.fade_times(holding_at(t)))
    acting_.release(holding_at(t), fade_time);
  acting_.forget_ended(starts_);
  rebuild();
}

void PrescribedMotion::take(const double t, const NodalVectors &displacements) {
  for (const double time : acting_.take(holding_at(t)))
    starts_[time] = displacements;
  rebuild();
}

void PrescribedMotion::resume(const double t, std::map<double, NodalVectors> starts) {
  starts_ = std::move(starts);
  acting_.change_to(holding_at(t));
  rebuild();
}

double PrescribedMotion::value(const Direction &direction, const double t, const dealii::Point<3> &position) {
  double sum = direction.start; // 0 unless supports began within the run
  for (const auto &term : direction.terms)
    sum += term.weight * term.constraint->value->value(t, position);
  return sum;
}

void PrescribedMotion::set_displacements(const double t, NodalVectors &displacements) const {
  for (const auto &node : nodes_)
    for (const auto &direction : node.directions)
      add_vector(
          displacements.data(), node.node,
          (value(direction, t, node.position) - get_vector(displacements.data(), node.node) * direction.e) *
              direction.e);
}

void PrescribedMotion::constrain(const double t, const double dt, const NodalVectors &displacements,
                                 const std::vector<double> &masses, NodalVectors &velocities,
                                 NodalVectors &impulses) const {
  Usage::count_if(n_moving_ > 0, Capability::moving_supports, n_moving_);
  for (const auto &node : nodes_) {
    Tensor<1, 3> change;
    const Tensor<1, 3> velocity = get_vector(velocities.data(), node.node);
    for (const auto &direction : node.directions) {
      // The velocity starts at the node's current position, so that round-off does not accumulate.
      const double wanted = (value(direction, t + dt, node.position) -
                             get_vector(displacements.data(), node.node) * direction.e) /
                            dt;
      change += (wanted - velocity * direction.e) * direction.e;
    }
    add_vector(velocities.data(), node.node, change);
    add_vector(impulses.data(), node.node, masses[node.node] * change);
  }
}

} // namespace billet
