// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_OUTPUT_ELEMENT_FIELDS_H
#define BILLET_OUTPUT_ELEMENT_FIELDS_H

#include "billet/output/grid.h"
#include "billet/solve/solution.h"

#include <vector>

namespace billet {

/// Returns the element quantities that the scene requests, for each body: fields with one value for
/// each owned element, in the order of Discretization::elements(). All bodies have the same fields.
std::vector<std::vector<GridField>> collect_element_fields(const Scene &scene, const Solution &solution);

/// Element field averaged to the nodes.
struct NodalAverage {
  std::string name;
  unsigned int n_components;
  std::vector<Vector> sums; ///< times volumes: component c is entry c % 3 of a node in vector c / 3
  Vector volumes;           ///< their sum, in each entry of a node

  /// Returns a component at an owned node.
  double operator()(const DofIndex first_dof, const unsigned int c) const {
    return sums[c / 3](first_dof + c % 3) / volumes(first_dof);
  }
};

/// Returns the averages of the fields of floating-point numbers. A node has the mean of the
/// elements of its body around it, weighted by undeformed volume. The mean is exact for a linear
/// field at nodes in the inside of a regular mesh. `fields`: see collect_element_fields().
/// Collective.
std::vector<NodalAverage> average_to_nodes(const Discretization &discretization,
                                           const std::vector<std::vector<GridField>> &fields);

/// Returns the derivatives of trilinear positions x with respect to coordinates from 0 to 1, at
/// such a point.
dealii::Tensor<2, 3> jacobian_at(const dealii::Point<3> &coordinates, const ElementVectors &x);

/// Returns the mean over the undeformed element of the deformation gradient of nodal displacements.
dealii::Tensor<2, 3> mean_deformation_gradient(const ElementVectors &positions,
                                               const ElementVectors &displacements);

/// Returns the components xx, yy, zz, xy, xz and yz.
std::vector<double> list_components(const dealii::SymmetricTensor<2, 3> &tensor);

/// Returns the components of the Cauchy stress, those `in_axes`, with von Mises' stress and the
/// pressure.
std::vector<double> list_stress(const dealii::SymmetricTensor<2, 3> &stress,
                                const dealii::SymmetricTensor<2, 3> &in_axes);

/// Returns ln V = ½ ln(F Fᵀ), the logarithmic strain in space. Zero if F is singular or not finite.
dealii::SymmetricTensor<2, 3> logarithmic_strain(const dealii::Tensor<2, 3> &F);

} // namespace billet

#endif
