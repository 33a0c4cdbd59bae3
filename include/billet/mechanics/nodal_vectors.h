// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MECHANICS_NODAL_VECTORS_H
#define BILLET_MECHANICS_NODAL_VECTORS_H

#include <deal.II/base/tensor.h>

namespace billet {

/// Stride of nodal vectors: x, y, z and one unused number, so that each node begins at a multiple
/// of 32 bytes.
constexpr unsigned int nodal_stride = 4;

inline dealii::Tensor<1, 3> get_vector(const double *nodal_vectors, const unsigned int node) {
  const double *v = nodal_vectors + std::size_t{nodal_stride} * node;
  return dealii::Tensor<1, 3>({v[0], v[1], v[2]});
}
inline void add_vector(double *nodal_vectors, const unsigned int node, const dealii::Tensor<1, 3> &value) {
  double *v = nodal_vectors + std::size_t{nodal_stride} * node;
  for (unsigned int i = 0; i < 3; ++i)
    v[i] += value[i];
}

} // namespace billet

#endif
