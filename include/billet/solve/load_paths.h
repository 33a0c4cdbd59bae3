// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_LOAD_PATHS_H
#define BILLET_SOLVE_LOAD_PATHS_H

#include "billet/scene/scene.h"

#include <cstddef>
#include <vector>

namespace billet {

/// Bodies that contact pairs connect, directly or by others, and the pairs. Forces pass through all
/// of them, and their penetrations add up. Tools are rigid and connect nothing.
struct LoadPath {
  std::vector<std::size_t> bodies, pairs;
  /// Whether it bears given loads, on bodies or driven tools. Then its forces are right at any
  /// penalty.
  bool bears_given_loads = false;
};
/// Finds the load paths. `bodies_of`: the one or two bodies of each pair.
std::vector<LoadPath> find_load_paths(std::size_t n_bodies,
                                      const std::vector<std::vector<std::size_t>> &bodies_of);

/// Finds the load paths of all contact pairs, those with tools first.
std::vector<LoadPath> find_load_paths(const Scene &scene);

} // namespace billet

#endif
