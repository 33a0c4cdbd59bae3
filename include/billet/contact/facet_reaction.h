// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_REACTION_H
#define BILLET_CONTACT_FACET_REACTION_H

#include "billet/geometry/facet_projection.h"

namespace billet {

/// Forces on a facet's corners that balance a force F on a node at x, and its moment:
///   F_I = −w_I F + ω × r_I,   Σ_I (r_I·r_I 1 − r_I⊗r_I) ω = −(x − Σ w_I x_I) × F
/// with r_I = x_I − ¼ Σ x_J. The weights alone balance a force along x − Σ w_I x_I, such as a
/// pressure. The second term balances the moment of friction across the gap; it has no resultant
/// and the least norm. The facet must have an area, and the weights must sum to 1.
template <class Number> class FacetReactionOf {
public:
  explicit FacetReactionOf(const facet::ExpansionOf<Number> &surface);

  FacetCornersOf<Number> operator()(const std::array<Number, 4> &weights,
                                    const dealii::Tensor<1, 3, Number> &x,
                                    const dealii::Tensor<1, 3, Number> &force) const;

private:
  facet::ExpansionOf<Number> surface_;
  dealii::Tensor<2, 3, Number> inverse_second_moment_;
};
using FacetReaction = FacetReactionOf<double>;

} // namespace billet

#endif
