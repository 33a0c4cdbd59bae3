// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_ELEMENTWISE_BLOCK_H
#define BILLET_MECHANICS_ELEMENTWISE_BLOCK_H

#include "billet/mechanics/explicit_block.h"

namespace billet {

/// Returns the block of explicit dynamics for elements and laws that the kernels do not support. It
/// computes the elements of implicit scenes one by one. Bulk viscosity is as in the kernels. The
/// stable step is bounded by that of full integration,
///   ω² ≤ max_q M(τ_q) ‖A²‖_∞^{1/2} / min_a m_a,   A_ab = Σ_q w_q ∇N_a·∇N_b, (X16)
/// with M the law's PointLaw::bound_stiffness(). The bound holds for elements that are not stiffer
/// than with full integration.
std::unique_ptr<ExplicitBlock> make_elementwise_block(std::shared_ptr<const PointLaw> law, double density,
                                                      const ExplicitFormulation &formulation);

} // namespace billet

#endif
