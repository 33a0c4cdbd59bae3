// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_LOAD_PATHS_H
#define BILLET_SOLVE_LOAD_PATHS_H

#include "billet/contact/contact_load.h"
#include "billet/scene/scene.h"

#include <cstddef>
#include <vector>

namespace billet {

/// Bodies that contact pairs connect, directly or by others, and the pairs: forces go through all of them,
/// and their penetrations add up. Tools are rigid and connect nothing.
struct LoadPath {
  std::vector<std::size_t> bodies, pairs;
  bool bears_given_loads = false; ///< of bodies, or of driven tools: its forces are right at any stiffness
};
/// `bodies_of`: the one or two bodies of each pair.
std::vector<LoadPath> find_load_paths(std::size_t n_bodies,
                                      const std::vector<std::vector<std::size_t>> &bodies_of);

/// Of all contact pairs, those with tools first.
std::vector<LoadPath> find_load_paths(const Scene &scene);

/// What penetration takes of the deformation now, of pairs that limit it, Scene's limits_softness; (L5) of
/// doc/theory.md.
class SoftnessLimit {
public:
  explicit SoftnessLimit(const Scene &scene);

  /// Whether any pair limits it.
  bool is_used() const;
  /// Energies of deformation at the start of the step and now.
  struct Deformation {
    double before = 0., now = 0.;
  };
  /// Of each pair, those with tools first: what its load path gives way by, as part of what is allowed; 0 of
  /// pairs that do not limit it. `deformations`: by body.
  std::vector<double> excess(const std::vector<SpringWork> &works,
                             const std::vector<Deformation> &deformations) const;

private:
  std::vector<LoadPath> paths_;
  std::vector<bool> limits_; ///< of the pairs
};

} // namespace billet

#endif
