// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_MECHANICS_ELEMENTS_H
#define BILLET_TESTS_MECHANICS_ELEMENTS_H

#include "../sample_formulations.h"
#include "../sample_laws.h"
#include "../testing.h"

#include "billet/mechanics/element_block.h"

/// Single elements, their displacements, and nodal vectors as tensors that can be added and normed.
namespace billet::testing {

using dealii::SymmetricTensor;
using dealii::Tensor;

using NodalTensor = Tensor<1, n_element_dofs>;

inline const Tensor<2, 3> unit = dealii::unit_symmetric_tensor<3>();

inline NodalTensor to_tensor(const ElementVectors &v) {
  NodalTensor result;
  for (unsigned int k = 0; k < n_element_dofs; ++k)
    result[k] = v[k];
  return result;
}

inline ElementVectors to_array(const NodalTensor &v) {
  ElementVectors result;
  for (unsigned int k = 0; k < n_element_dofs; ++k)
    result[k] = v[k];
  return result;
}

inline Tensor<1, 3> node(const NodalTensor &v, const unsigned int a) {
  return Tensor<1, 3>({v[3 * a], v[3 * a + 1], v[3 * a + 2]});
}

/// A applied to the vector of each node.
inline NodalTensor transform(const Tensor<2, 3> &A, const NodalTensor &v) {
  NodalTensor result;
  for (unsigned int a = 0; a < n_element_nodes; ++a)
    for (unsigned int i = 0; i < 3; ++i)
      result[3 * a + i] = (A * node(v, a))[i];
  return result;
}

inline NodalTensor multiply(const ElementMatrix &K, const NodalTensor &v) {
  NodalTensor result;
  for (unsigned int r = 0; r < n_element_dofs; ++r)
    for (unsigned int c = 0; c < n_element_dofs; ++c)
      result[r] += K[r * n_element_dofs + c] * v[c];
  return result;
}

/// Σ_a f_a ⊗ x_a; its skew part is the moment.
inline Tensor<2, 3> virial(const NodalTensor &force, const NodalTensor &x) {
  Tensor<2, 3> sum;
  for (unsigned int a = 0; a < n_element_nodes; ++a)
    sum += outer_product(node(force, a), node(x, a));
  return sum;
}

inline Tensor<1, 3> resultant(const NodalTensor &force) {
  Tensor<1, 3> sum;
  for (unsigned int a = 0; a < n_element_nodes; ++a)
    sum += node(force, a);
  return sum;
}

inline NodalTensor random_nodal(Random &random, const double size) {
  NodalTensor result;
  for (unsigned int k = 0; k < n_element_dofs; ++k)
    result[k] = random(-size, size);
  return result;
}

/// Edge length 1, nodes in lexicographic order.
inline NodalTensor cube() {
  NodalTensor x;
  for (unsigned int k = 0; k < n_element_dofs; ++k)
    x[k] = ((k / 3) >> (k % 3)) & 1U;
  return x;
}

inline NodalTensor distorted_cube() {
  Random random;
  return cube() + random_nodal(random, 0.15);
}

/// Displacements of the uniform deformation gradient F.
inline NodalTensor displace(const Tensor<2, 3> &F, const NodalTensor &X) { return transform(F - unit, X); }

inline std::string name_of(const LawFormulation &formulation) {
  const std::string points =
      formulation.points_through > 2 ? std::to_string(formulation.points_through) + " points through, " : "";
  return std::string(formulation.element.name()) + ", " + points + formulation.elasticity;
}

/// Calls run(formulation) for every element and elasticity of metals.
template <class Function> void for_each_formulation(const Function &run) {
  for (const auto element : all_elements())
    for (const auto &elasticity : metal_elasticities()) {
      LawFormulation formulation;
      formulation.element = element;
      formulation.elasticity = elasticity;
      run(formulation);
    }
}

inline std::unique_ptr<ElementBlock> make_block(const SharedLaw &law, const NodalTensor &X,
                                                const ElementFormulation &formulation) {
  auto block = billet::make_element_block(law, formulation);
  std::size_t offender = 0;
  AssertThrow(block->initialize({to_array(X)}, offender), dealii::ExcInternalError());
  return block;
}

inline std::unique_ptr<ElementBlock> make_block(const MaterialLaw &material, const NodalTensor &X,
                                                const LawFormulation &formulation = {}) {
  return make_block(make_law(material, formulation.elasticity), X, formulation);
}

inline NodalTensor compute_force(ElementBlock &block, const NodalTensor &u, ElementMatrix *matrix = nullptr) {
  ElementVectors force;
  AssertThrow(block.evaluate(0, to_array(u), force, matrix), dealii::ExcInternalError());
  return to_tensor(force);
}

using MatrixTensor = Tensor<2, n_element_dofs>;

inline MatrixTensor to_tensor(const ElementMatrix &K) {
  MatrixTensor result;
  for (unsigned int r = 0; r < n_element_dofs; ++r)
    for (unsigned int c = 0; c < n_element_dofs; ++c)
      result[r][c] = K[r * n_element_dofs + c];
  return result;
}

/// Column c is the derivative of the force along displacement c; the history stays what was committed.
inline MatrixTensor compute_difference(ElementBlock &block, const NodalTensor &u, const double step) {
  MatrixTensor result;
  for (unsigned int c = 0; c < n_element_dofs; ++c) {
    const NodalTensor column = central_difference(
        [&](const double e) {
          NodalTensor moved = u;
          moved[c] += e;
          return compute_force(block, moved);
        },
        step);
    for (unsigned int r = 0; r < n_element_dofs; ++r)
      result[r][c] = column[r];
  }
  return result;
}

} // namespace billet::testing

#endif
