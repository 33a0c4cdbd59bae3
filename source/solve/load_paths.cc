// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/load_paths.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace billet {

std::vector<LoadPath> find_load_paths(const std::size_t n_bodies,
                                      const std::vector<std::vector<std::size_t>> &bodies_of) {
  std::vector<std::size_t> path(n_bodies);
  std::iota(path.begin(), path.end(), std::size_t{0});
  for (const auto &bodies : bodies_of)
    for (const std::size_t body : bodies) {
      const std::size_t from = path[body], to = path[bodies.front()];
      std::replace(path.begin(), path.end(), from, to);
    }
  std::vector<LoadPath> result;
  for (std::size_t p = 0; p < n_bodies; ++p) {
    LoadPath load_path;
    for (std::size_t body = 0; body < n_bodies; ++body)
      if (path[body] == p)
        load_path.bodies.push_back(body);
    for (std::size_t pair = 0; pair < bodies_of.size(); ++pair)
      if (path[bodies_of[pair].front()] == p)
        load_path.pairs.push_back(pair);
    if (!load_path.pairs.empty())
      result.push_back(std::move(load_path));
  }
  return result;
}

std::vector<LoadPath> find_load_paths(const Scene &scene) {
  std::vector<std::vector<std::size_t>> bodies_of;
  for (const auto &pair : scene.pairs())
    bodies_of.push_back({pair.body});
  for (const auto &pair : scene.body_pairs())
    bodies_of.push_back({pair.bodies[0], pair.bodies[1]});
  return find_load_paths(scene.bodies().size(), bodies_of);
}

SoftnessLimit::SoftnessLimit(const Scene &scene) : paths_(find_load_paths(scene)) {
  for (const auto &pair : scene.pairs())
    limits_.push_back(pair.limits_softness);
  for (const auto &pair : scene.body_pairs())
    limits_.push_back(pair.limits_softness);
}

bool SoftnessLimit::is_used() const {
  return std::any_of(limits_.begin(), limits_.end(), [](const bool limits) { return limits; });
}

std::vector<double> SoftnessLimit::excess(const std::vector<SpringWork> &works,
                                          const std::vector<Deformation> &deformations) const {
  constexpr double allowed = 2e-3; // of the forces, to first order
  // Slip is accounted for by the step. Where bodies hardly deform in one, it is nothing beside what they have
  // done before.
  constexpr double least_growth = 0.05;
  std::vector<double> result(limits_.size());
  for (const LoadPath &path : paths_) {
    SpringWork all, limited;
    for (const std::size_t pair : path.pairs) {
      all.normal += works[pair].normal;
      if (!limits_[pair])
        continue;
      limited.normal += works[pair].normal;
      limited.tangential += works[pair].tangential;
    }
    Deformation deformation;
    for (const std::size_t body : path.bodies) {
      deformation.before += deformations[body].before;
      deformation.now += deformations[body].now;
    }
    const double total = all.normal + deformation.now,
                 grown = std::abs(deformation.now - deformation.before) + least_growth * total;
    const double part = (total > 0. ? limited.normal / total : 0.) +
                        (limited.tangential > 0. ? limited.tangential / (limited.tangential + grown) : 0.);
    for (const std::size_t pair : path.pairs)
      if (limits_[pair])
        result[pair] = part / allowed;
  }
  return result;
}

} // namespace billet
