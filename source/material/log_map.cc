// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/material/log_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace billet {

using dealii::SymmetricTensor;
using dealii::Tensor;

namespace {

constexpr unsigned int log_rows[6] = {0, 1, 2, 0, 0, 1}, log_columns[6] = {0, 1, 2, 1, 2, 2};
const double root_2 = std::sqrt(2.);

} // namespace

Vector6 to_kelvin(const SymmetricTensor<2, 3> &tensor) {
  Vector6 vector;
  for (unsigned int i = 0; i < 6; ++i)
    vector[i] = (i < 3 ? 1. : root_2) * tensor[log_rows[i]][log_columns[i]];
  return vector;
}

SymmetricTensor<2, 3> from_kelvin(const Vector6 &vector) {
  SymmetricTensor<2, 3> tensor;
  for (unsigned int i = 0; i < 6; ++i)
    tensor[log_rows[i]][log_columns[i]] = vector[i] / (i < 3 ? 1. : root_2);
  return tensor;
}

double dot(const Vector6 &a, const Vector6 &b) {
  double sum = 0.;
  for (unsigned int i = 0; i < 6; ++i)
    sum += a[i] * b[i];
  return sum;
}

Vector6 multiply(const Matrix6 &A, const Vector6 &b) {
  Vector6 result;
  for (unsigned int i = 0; i < 6; ++i)
    result[i] = dot(A[i], b);
  return result;
}

void add(Vector6 &a, const double factor, const Vector6 &b) {
  for (unsigned int i = 0; i < 6; ++i)
    a[i] += factor * b[i];
}

void add(Matrix6 &A, const double factor, const Matrix6 &B) {
  for (unsigned int i = 0; i < 6; ++i)
    add(A[i], factor, B[i]);
}

void remove_trace(Vector6 &a) {
  const double mean = (a[0] + a[1] + a[2]) / 3.;
  for (unsigned int i = 0; i < 3; ++i)
    a[i] -= mean;
}

Matrix6 rotation_of(const Tensor<2, 3> &Q) {
  Matrix6 K;
  for (unsigned int j = 0; j < 6; ++j) {
    Vector6 one{};
    one[j] = 1.;
    const Vector6 column =
        to_kelvin(dealii::symmetrize(Q * Tensor<2, 3>(from_kelvin(one)) * dealii::transpose(Q)));
    for (unsigned int i = 0; i < 6; ++i)
      K[i][j] = column[i];
  }
  return K;
}

LinearSystem6::LinearSystem6(const Matrix6 &A) : factors_(A) {
  for (unsigned int k = 0; k < 6; ++k) {
    unsigned int pivot = k;
    for (unsigned int i = k + 1; i < 6; ++i)
      if (std::abs(factors_[i][k]) > std::abs(factors_[pivot][k]))
        pivot = i;
    rows_[k] = pivot;
    std::swap(factors_[k], factors_[pivot]);
    if (!(std::abs(factors_[k][k]) > 0.) || !std::isfinite(factors_[k][k])) {
      is_regular_ = false;
      return;
    }
    for (unsigned int i = k + 1; i < 6; ++i) {
      factors_[i][k] /= factors_[k][k];
      for (unsigned int j = k + 1; j < 6; ++j)
        factors_[i][j] -= factors_[i][k] * factors_[k][j];
    }
  }
}

Vector6 LinearSystem6::solve(const Vector6 &b) const {
  Vector6 x = b;
  for (unsigned int k = 0; k < 6; ++k)
    std::swap(x[k], x[rows_[k]]);
  for (unsigned int i = 1; i < 6; ++i)
    for (unsigned int j = 0; j < i; ++j)
      x[i] -= factors_[i][j] * x[j];
  for (unsigned int i = 6; i-- > 0;) {
    for (unsigned int j = i + 1; j < 6; ++j)
      x[i] -= factors_[i][j] * x[j];
    x[i] /= factors_[i][i];
  }
  return x;
}

bool Eigensystem::compute(const SymmetricTensor<2, 3> &A) {
  if (!std::isfinite(A.norm()))
    return false;
  const auto pairs = dealii::eigenvectors(A, dealii::SymmetricTensorEigenvectorMethod::jacobi);
  for (unsigned int a = 0; a < 3; ++a) {
    values[a] = pairs[a].first;
    for (unsigned int i = 0; i < 3; ++i)
      frame[i][a] = pairs[a].second[i];
  }
  return true;
}

SymmetricTensor<2, 3> Eigensystem::compose(const std::array<double, 3> &given) const {
  SymmetricTensor<2, 3> result;
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = i; j < 3; ++j)
      for (unsigned int a = 0; a < 3; ++a)
        result[i][j] += given[a] * frame[i][a] * frame[j][a];
  return result;
}

SymmetricTensor<2, 3> Eigensystem::differentiate(const std::array<std::array<double, 3>, 3> &ratios,
                                                 const SymmetricTensor<2, 3> &rate) const {
  Tensor<2, 3> local = dealii::transpose(frame) * Tensor<2, 3>(rate) * frame;
  for (unsigned int a = 0; a < 3; ++a)
    for (unsigned int b = 0; b < 3; ++b)
      local[a][b] *= ratios[a][b];
  return dealii::symmetrize(frame * local * dealii::transpose(frame));
}

bool InverseStretch::compute(const SymmetricTensor<2, 3> &strain) {
  Eigensystem system;
  if (!system.compute(strain))
    return false;
  std::array<double, 3> values{};
  for (unsigned int a = 0; a < 3; ++a)
    values[a] = std::exp(-system.values[a]);
  value = system.compose(values);
  std::array<std::array<double, 3>, 3> ratios{};
  for (unsigned int a = 0; a < 3; ++a)
    for (unsigned int b = 0; b < 3; ++b) {
      const double apart = system.values[a] - system.values[b];
      ratios[a][b] = values[b] * (apart == 0. ? -1. : std::expm1(-apart) / apart);
    }
  for (unsigned int k = 0; k < 6; ++k) {
    Vector6 one{};
    one[k] = 1.;
    derivatives[k] = system.differentiate(ratios, from_kelvin(one));
  }
  return true;
}

bool RelativeStrain::compute(const InverseStretch &Y, const SymmetricTensor<2, 3> &M) {
  Y_ = &Y;
  product_ = Tensor<2, 3>(M) * Tensor<2, 3>(Y.value);
  if (!eigensystem_.compute(dealii::symmetrize(Tensor<2, 3>(Y.value) * product_)))
    return false;
  const std::array<double, 3> &z = eigensystem_.values;
  std::array<double, 3> strains{};
  for (unsigned int a = 0; a < 3; ++a) {
    if (!(z[a] > 0.))
      return false;
    strains[a] = 0.5 * std::log(z[a]);
  }
  const double mean = (strains[0] + strains[1] + strains[2]) / 3.;
  for (double &strain : strains)
    strain -= mean;
  value_ = to_kelvin(eigensystem_.compose(strains));
  for (unsigned int a = 0; a < 3; ++a)
    for (unsigned int b = 0; b < 3; ++b) {
      const double x = (z[a] - z[b]) / z[b];
      ratios_[a][b] = 0.5 * (x == 0. ? 1. : std::log1p(x) / x) / z[b];
    }
  return true;
}

Matrix6 RelativeStrain::derivative() const {
  Matrix6 result;
  for (unsigned int k = 0; k < 6; ++k) {
    const SymmetricTensor<2, 3> rate = 2. * dealii::symmetrize(Tensor<2, 3>(Y_->derivatives[k]) * product_);
    Vector6 column = to_kelvin(eigensystem_.differentiate(ratios_, rate));
    remove_trace(column);
    for (unsigned int i = 0; i < 6; ++i)
      result[i][k] = column[i];
  }
  return result;
}

Vector6 RelativeStrain::along(const SymmetricTensor<2, 3> &rate_of_M) const {
  const Tensor<2, 3> Y = Y_->value;
  Vector6 result =
      to_kelvin(eigensystem_.differentiate(ratios_, dealii::symmetrize(Y * Tensor<2, 3>(rate_of_M) * Y)));
  remove_trace(result);
  return result;
}

} // namespace billet
