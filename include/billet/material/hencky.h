// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_HENCKY_H
#define BILLET_MATERIAL_HENCKY_H

#include "billet/material/moduli.h"

namespace billet {

/// Elastic left Cauchy-Green tensor in its principal frame.
struct PrincipalElasticState {
  std::array<double, 3> stretches_squared;        ///< eigenvalues b_A
  std::array<dealii::Tensor<1, 3>, 3> directions; ///< orthonormal eigenvectors n_A
  std::array<double, 3> deviatoric_log_strains;   ///< dev of ε_A = ½ ln b_A
  double volumetric_log_strain;                   ///< Σ ε_A = ln J_e
};

/// Solves the eigenproblem of `b`. Returns false if b is not positive definite or not finite: the
/// state is inadmissible and the step must be cut.
bool compute_principal_state(const dealii::SymmetricTensor<2, 3> &b, PrincipalElasticState &state);

/// Returns sym(a ⊗ b) in the order 11, 22, 33, 12, 13, 23.
std::array<double, 6> symmetric_dyad(const dealii::Tensor<1, 3> &a, const dealii::Tensor<1, 3> &b);

/// Returns exp(A), from the eigenvectors of A.
dealii::SymmetricTensor<2, 3> exponential(const dealii::SymmetricTensor<2, 3> &A);

/// Response of an isotropic law with logarithmic elasticity in the principal frame of the trial
/// state. It has the Kirchhoff stress τ_A = κ tr ε + 2G β dev ε_A and its derivative
///   ∂τ_A/∂ε_B = κ + 2Gβ (δ_AB − 1/3) − 2G γ ν_A ν_B,   ν = dev ε / |dev ε|,
/// with β = 1, γ = 0 in elasticity (Simo & Hughes, Computational Inelasticity, box 9.1 and eq.
/// 9.2.33 ff.).
struct PrincipalResponse {
  std::array<double, 3> stress;
  double beta = 1.;
  double gamma = 0.;
  std::array<double, 3> flow_direction{};
};

/// Returns Σ_A τ_A n_A ⊗ n_A.
dealii::SymmetricTensor<2, 3> compute_kirchhoff_stress(const PrincipalElasticState &trial,
                                                       const PrincipalResponse &response);

/// Computes the exact spatial moduli of the response above,
///   c = Σ_AB (∂τ_A/∂ε_B − 2 τ_A δ_AB) m_A ⊗ m_B + Σ_{A<B} 4 g_AB s_AB ⊗ s_AB,
///   m_A = n_A ⊗ n_A,  s_AB = sym(n_A ⊗ n_B),  g_AB = (τ_A b_B − τ_B b_A) / (b_A − b_B)
/// (Simo & Hughes, eq. 9.2.38). Because τ_A − τ_B = Gβ ln(b_A/b_B) holds exactly for this class of
/// laws, g_AB = Gβ ln(1 + x)/x − τ_B with x = b_A/b_B − 1: no cancellation, and equal stretches are
/// no special case.
void compute_spatial_moduli(const PrincipalElasticState &trial, const PrincipalResponse &response,
                            const ElasticModuli &elastic, SpatialModuli &moduli);

} // namespace billet

#endif
