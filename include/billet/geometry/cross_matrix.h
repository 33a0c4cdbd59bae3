// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_GEOMETRY_CROSS_MATRIX_H
#define BILLET_GEOMETRY_CROSS_MATRIX_H

#include <deal.II/base/tensor.h>

namespace billet {

/// Returns the matrix [a]× with [a]× b = a × b.
inline dealii::Tensor<2, 3> cross_matrix(const dealii::Tensor<1, 3> &a) {
  dealii::Tensor<2, 3> matrix;
  for (unsigned int i = 0; i < 3; ++i) {
    const unsigned int j = (i + 1) % 3, k = (i + 2) % 3;
    matrix[i][j] = -a[k];
    matrix[i][k] = a[j];
  }
  return matrix;
}

} // namespace billet

#endif
