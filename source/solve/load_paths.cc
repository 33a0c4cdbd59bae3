// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/solve/load_paths.h"

#include <algorithm>
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
  std::vector<LoadPath> paths = find_load_paths(scene.bodies().size(), bodies_of);
  for (LoadPath &path : paths)
    path.bears_given_loads =
        std::any_of(path.bodies.begin(), path.bodies.end(),
                    [&](const std::size_t body) { return !scene.bodies()[body].loads.empty(); }) ||
        (!scene.parameters().scheme().has_inertia && // in dynamics the tool's inertia drives
         std::any_of(path.pairs.begin(), path.pairs.end(), [&](const std::size_t pair) {
           return pair < scene.pairs().size() && scene.tools()[scene.pairs()[pair].tool].is_driven();
         }));
  return paths;
}

} // namespace billet
