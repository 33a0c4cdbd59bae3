// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/facet_areas.h"

#include "billet/geometry/derivative.h"

#include <cmath>

namespace billet {

using dealii::Tensor;

template <class Number>
FacetAreasOf<Number>::FacetAreasOf(const facet::ExpansionOf<Number> &surface)
    // ν = (e_1 + η e_3) × (e_2 + ξ e_3), in which e_3 × e_3 vanishes.
    : constant_(surface.mean_area_vector()), along_xi_(dealii::cross_product_3d(surface.e_1, surface.e_3)),
      along_eta_(dealii::cross_product_3d(surface.e_3, surface.e_2)) {}

template <class Number>
Number FacetAreasOf<Number>::share(const unsigned int corner, const Tensor<1, 3, Number> &normal) const {
  static const double gauss = 1. / std::sqrt(3.);
  const Number middle = constant_ * normal, along_xi = gauss * (along_xi_ * normal),
               along_eta = gauss * (along_eta_ * normal);
  const auto &[xi, eta] = facet::signs[corner];
  Number share = 0.;
  for (const auto &sign : facet::signs) {
    const Number seen = middle + sign[0] * along_xi + sign[1] * along_eta;
    if (seen < 0.)
      share -= 0.25 * (1. + gauss * xi * sign[0]) * (1. + gauss * eta * sign[1]) * seen;
  }
  return share;
}

template class FacetAreasOf<double>;
template class FacetAreasOf<Derivative>;

} // namespace billet
