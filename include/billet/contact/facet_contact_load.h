// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_CONTACT_LOAD_H
#define BILLET_CONTACT_FACET_CONTACT_LOAD_H

#include <deal.II/base/tensor.h>

namespace billet {

/// Load and energies of contact between surfaces in one step, over all ranks.
struct FacetContactLoad {
  dealii::Tensor<1, 3> force;  ///< on surface 0, by the others
  dealii::Tensor<1, 3> moment; ///< the same about the origin [force length]
  double stored_energy = 0.;   ///< in the penalty springs [energy]
  double dissipation = 0.;     ///< by friction in this step [energy]
  /// Work of the tangential springs in this step, see FrictionAccount [energy].
  double damping = 0.;
  double area = 0.;                     ///< of slaves in contact, over both passes [length²]
  double n_touching = 0.;               ///< slave nodes; a shared node counts on each of its ranks
  double deepest = 0.;                  ///< maximum penetration [length]
  double deepest_relative = 0.;         ///< the same, relative to the root of the facet's area
  double absolute_force = 0.;           ///< Σ |F|, the scale of the residuals below
  dealii::Tensor<1, 3> residual_force;  ///< Σ (F + Σ F_I): 0 up to round-off
  dealii::Tensor<1, 3> residual_moment; ///< the same of the moments [force length]
};

} // namespace billet

#endif
