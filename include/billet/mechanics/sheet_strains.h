// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_SHEET_STRAINS_H
#define BILLET_MECHANICS_SHEET_STRAINS_H

#include "billet/mechanics/modal_geometry.h"

#include <deal.II/base/tensor.h>

namespace billet {

/// Strains of a sheet.
struct SheetStrains {
  double major = 0., minor = 0.; ///< principal logarithmic strains in its plane
  double thinning = 0.;          ///< 1 less the thickness over the undeformed one
};

/// Returns the unit normal of the sheet that an undeformed brick belongs to: of the plane of its
/// two longer mean edges.
dealii::Tensor<1, 3> find_sheet_normal(const ElementVectors &positions);

/// Returns the strains at a deformation gradient, in the plane with this normal before the
/// deformation, (B17) of doc/theory. Zero if F is singular or not finite.
SheetStrains compute_sheet_strains(const dealii::Tensor<2, 3> &F, const dealii::Tensor<1, 3> &normal);

} // namespace billet

#endif
