// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_MEAN_DILATATION_H
#define BILLET_MECHANICS_MEAN_DILATATION_H

#include "billet/material/moduli.h"

#include <array>

namespace billet {

constexpr unsigned int n_element_nodes = 8;
constexpr unsigned int n_element_dofs = 24;  ///< ordered node by node: 3 a + i
constexpr unsigned int n_element_points = 8; ///< 2 × 2 × 2 Gauss points

/// Nodal vectors of one hexahedron; nodes in lexicographic order (ξ fastest), the order of
/// deal.II's vertices.
using ElementVectors = std::array<double, n_element_dofs>;

/// Row-major 24 × 24 element matrix.
using ElementMatrix = std::array<double, std::size_t{n_element_dofs} * n_element_dofs>;

/// Geometry of the undeformed trilinear hexahedron at its Gauss points; computed once per element.
struct ReferenceElement {
  /// ∂N_a/∂X_i at each point, [1/length]
  std::array<std::array<std::array<double, 3>, n_element_nodes>, n_element_points> gradients;
  /// weight times det ∂X/∂ξ, [length³]
  std::array<double, n_element_points> volumes;
};

/// Fills `element` from nodal positions. Returns false if the Jacobian is not positive at a Gauss
/// point.
bool compute_reference_element(const ElementVectors &positions, ReferenceElement &element);

/// Kinematics of Q1/P0 (mean dilatation). At each point F̄ = (J̄/J)^{1/3} F, with J̄ = v/V the
/// ratio of the element's current to its reference volume (Nagtegaal, Parks & Rice 1974; Simo,
/// Taylor & Pister 1985). All volumes are exact, since 2 × 2 × 2 points integrate the Jacobian of a
/// trilinear map exactly.
struct MeanDilatationKinematics {
  std::array<dealii::Tensor<2, 3>, n_element_points> F_bar;
  /// ∂N_a/∂x_i in the current configuration, [1/length]
  std::array<std::array<std::array<double, 3>, n_element_nodes>, n_element_points> gradients;
  std::array<double, n_element_points> current_volumes; ///< J w, [length³]
  double current_volume;                                ///< v
  double volume_ratio;                                  ///< J̄
  ElementVectors mean_divergence;                       ///< (1/v) Σ J w ∂N_a/∂x_i
};

/// Computes the kinematics. Returns false if det F ≤ 0 or is not finite at a Gauss point: the step
/// must be cut.
bool compute_kinematics(const ReferenceElement &element, const ElementVectors &displacements,
                        MeanDilatationKinematics &kinematics);

/// Adds the nodal forces [force] of the stresses `tau` (Kirchhoff, at F̄):
///   f_a = Σ_q w [dev τ ∇N_a] + Π ∇̄N_a,   Π = Σ_q w tr τ / 3.
/// They are the gradient of the stored energy Σ_q w ψ(F̄_q) if the law has one.
void add_internal_force(const ReferenceElement &element, const MeanDilatationKinematics &kinematics,
                        const std::array<dealii::SymmetricTensor<2, 3>, n_element_points> &tau,
                        ElementVectors &force);

/// Overwrites `matrix` with ∂f/∂u [force/length]. With θ = (div̄ − tr L)/3, L = ∇u in the current
/// configuration and d̄ = sym L + θ I (bars over the virtual field likewise),
///   K = Σ_q w {δd̄:c:d̄ + ∇N_a·τ·∇N_b I + 2 θ τ:δd + 2 δθ τ:d + 2 θ δθ tr τ + tr τ/3 tr(δL L)}
///       + Π { (1/v) Σ_q J w [tr δL tr L − tr(δL L)] − δdiv̄ div̄ }.
/// The moduli must be symmetric, and so is the matrix; only part of unsymmetric moduli would be
/// used.
void compute_internal_tangent(const ReferenceElement &element, const MeanDilatationKinematics &kinematics,
                              const std::array<dealii::SymmetricTensor<2, 3>, n_element_points> &tau,
                              const std::array<SpatialModuli, n_element_points> &moduli,
                              ElementMatrix &matrix);

/// Overwrites `matrix` with ∂f/∂u for symmetric or unsymmetric moduli.
void compute_unsymmetric_internal_tangent(
    const ReferenceElement &element, const MeanDilatationKinematics &kinematics,
    const std::array<dealii::SymmetricTensor<2, 3>, n_element_points> &tau,
    const std::array<SpatialModuli, n_element_points> &moduli, ElementMatrix &matrix);

} // namespace billet

#endif
