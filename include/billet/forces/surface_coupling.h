// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_FORCES_SURFACE_COUPLING_H
#define BILLET_FORCES_SURFACE_COUPLING_H

#include "billet/discretization/supports.h"
#include "billet/loads/load.h"
#include "billet/scene/scene.h"

#include <vector>

namespace billet {

/// Throws InputError if a load on a surface acts on too many nodes for a matrix. Collective.
void check_surface_couplings(const Scene &scene, const Discretization &discretization);

/// Adds the entries by which loads on surfaces couple their nodes. Collective.
void add_surface_couplings(const Scene &scene, const Discretization &discretization,
                           const Constraints &constraints, SparsityPattern &pattern);

/// Matrix Σ_k left_k ⊗ right_k of one surface, summed over faces and ranks.
class SurfaceCoupling {
public:
  explicit SurfaceCoupling(const Discretization &discretization);

  /// Adds the factors of a node.
  void add(const std::array<DofIndex, 3> &dofs, const SurfaceLoad::Coupling &coupling);
  /// Adds the matrix. Values of the constraints do not enter a lift: the steps that ask for one are
  /// guesses. Collective.
  void add_to(const TangentSystem &system);

private:
  static constexpr unsigned int n_factors = 6; ///< two of three columns
  const Discretization &discretization_;
  std::vector<Vector> left_, right_; ///< additive
};

} // namespace billet

#endif
