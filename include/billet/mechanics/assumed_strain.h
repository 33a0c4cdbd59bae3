// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_ASSUMED_STRAIN_H
#define BILLET_MECHANICS_ASSUMED_STRAIN_H

#include "billet/mechanics/mean_dilatation.h"

namespace billet {

/// Deformation gradients of a brick at its eight points, with the reference volume of each.
struct PointDeformations {
  std::array<dealii::Tensor<2, 3>, n_element_points> F;
  std::array<double, n_element_points> volumes;
};

/// Computes deformation gradients of an assumed field without parasitic shear, (L1) to (L3) of doc/theory.md:
/// the mean gradient, and strains that vary linearly through the brick in the planes of its fibres. Bending
/// of bricks with parallel edges is exact at any aspect ratio, and all points share one volume ratio. False
/// if the brick, or its mean deformation, is inside out. `poisson`: Poisson's ratio, < 0.5.
bool compute_assumed_strain(const ElementVectors &positions, const ElementVectors &displacements,
                            double poisson, PointDeformations &result);

} // namespace billet

#endif
