// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MATERIAL_LOG_MAP_H
#define BILLET_MATERIAL_LOG_MAP_H

#include "billet/material/moduli.h"

#include <array>

namespace billet {

/// Vector and matrix of symmetric tensors in Kelvin's notation: 11, 22, 33, √2 12, √2 13, √2 23.
/// Products and norms are those of the tensors.
using Vector6 = std::array<double, 6>;
using Matrix6 = std::array<std::array<double, 6>, 6>;

Vector6 to_kelvin(const dealii::SymmetricTensor<2, 3> &tensor);
dealii::SymmetricTensor<2, 3> from_kelvin(const Vector6 &vector);
double dot(const Vector6 &a, const Vector6 &b);
Vector6 multiply(const Matrix6 &A, const Vector6 &b);
/// Adds factor b to a.
void add(Vector6 &a, double factor, const Vector6 &b);
void add(Matrix6 &A, double factor, const Matrix6 &B);
/// Subtracts the mean of the normal components.
void remove_trace(Vector6 &a);
/// Returns the matrix K for which K a is Kelvin's vector of Q A Qᵀ.
Matrix6 rotation_of(const dealii::Tensor<2, 3> &Q);

/// Solution of six linear equations by elimination with column pivots.
class LinearSystem6 {
public:
  explicit LinearSystem6(const Matrix6 &A);

  /// Whether all pivots are finite and not zero.
  bool is_regular() const { return is_regular_; }
  /// Returns A⁻¹ b.
  Vector6 solve(const Vector6 &b) const;

private:
  Matrix6 factors_;
  std::array<unsigned int, 6> rows_{};
  bool is_regular_ = true;
};

/// Eigenvalues of a symmetric tensor and the rotation whose columns are its eigenvectors.
struct Eigensystem {
  std::array<double, 3> values{};
  dealii::Tensor<2, 3> frame;

  /// Returns false if the tensor is not finite.
  bool compute(const dealii::SymmetricTensor<2, 3> &A);
  /// Returns Σ values_A n_A ⊗ n_A for these values.
  dealii::SymmetricTensor<2, 3> compose(const std::array<double, 3> &values) const;
  /// Returns the derivative of an isotropic function along `rate`; `ratios` are its divided
  /// differences (f(λ_A) − f(λ_B))/(λ_A − λ_B) (Daleckii & Krein 1965).
  dealii::SymmetricTensor<2, 3> differentiate(const std::array<std::array<double, 3>, 3> &ratios,
                                              const dealii::SymmetricTensor<2, 3> &rate) const;
};

/// Inverse elastic stretch Y = exp(−ε) and its derivatives along Kelvin's six unit strains.
struct InverseStretch {
  dealii::SymmetricTensor<2, 3> value;
  std::array<dealii::SymmetricTensor<2, 3>, 6> derivatives;

  bool compute(const dealii::SymmetricTensor<2, 3> &strain);
};

/// Deviator of ½ ln(Y M Y): the logarithmic strain that M has beside the elastic stretch Y⁻¹, (H2)
/// of doc/theory.md.
class RelativeStrain {
public:
  /// Returns false if M is not positive definite or not finite.
  bool compute(const InverseStretch &Y, const dealii::SymmetricTensor<2, 3> &M);

  const Vector6 &value() const { return value_; }
  /// Returns the derivative with respect to ε, column by column.
  Matrix6 derivative() const;
  /// Returns the derivative along a rate of M.
  Vector6 along(const dealii::SymmetricTensor<2, 3> &rate_of_M) const;

private:
  const InverseStretch *Y_ = nullptr;
  dealii::Tensor<2, 3> product_; ///< M Y
  Eigensystem eigensystem_;
  std::array<std::array<double, 3>, 3> ratios_{};
  Vector6 value_{};
};

} // namespace billet

#endif
