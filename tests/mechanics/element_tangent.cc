// SPDX-License-Identifier: LGPL-2.1-or-later
// The element matrix against differences of the nodal forces, and its properties: symmetry, rigid body modes,
// and the single volumetric mode of the mean dilatation.

#include "elements.h"

#include "billet/material/plastic.h"

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/lapack_full_matrix.h>
#include <deal.II/lac/vector.h>

namespace element_tangent_test {

using namespace billet;
using namespace billet::testing;

/// The matrix at X + u. K(ω × x) = ω × f and K t = 0: a rotation turns the forces, a translation does
/// nothing.
void test_matrix(const std::string &name, ElementBlock &block, const NodalTensor &X, const NodalTensor &u,
                 const double step = 1e-5, const double tolerance = 1e-9) {
  ElementMatrix K;
  const NodalTensor force = compute_force(block, u, &K);
  check(name + ", force is the same with and without matrix", (force - compute_force(block, u)).norm() == 0.);
  const MatrixTensor matrix = to_tensor(K);
  check(name + ", differences", (matrix - compute_difference(block, u, step)).norm() / matrix.norm(),
        tolerance);

  WorstError symmetry, rigid;
  for (unsigned int r = 0; r < n_element_dofs; ++r)
    for (unsigned int c = 0; c < n_element_dofs; ++c)
      symmetry.add(std::abs(matrix[r][c] - matrix[c][r]) / matrix.norm());
  check(name + ", symmetry", symmetry.value(), 1e-13);
  for (unsigned int i = 0; i < 3; ++i) {
    NodalTensor translation;
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      translation[3 * a + i] = 1.;
    rigid.add(multiply(K, translation).norm() / matrix.norm());
    Tensor<2, 3> spin;
    spin[i][(i + 1) % 3] = -1.;
    spin[(i + 1) % 3][i] = 1.;
    rigid.add((multiply(K, transform(spin, X + u)) - transform(spin, force)).norm() / matrix.norm());
  }
  check(name + ", rigid body motions", rigid.value(), 1e-13);
}

/// Number of Gauss points that a step from the virgin state makes plastic.
unsigned int count_plastic(const NodalTensor &X, const NodalTensor &u) {
  const HenckyPlasticity law(steel, make_hardening(linear));
  ReferenceElement element;
  MeanDilatationKinematics kinematics;
  AssertThrow(compute_reference_element(to_array(X), element), dealii::ExcInternalError());
  AssertThrow(compute_kinematics(element, to_array(u), kinematics), dealii::ExcInternalError());
  unsigned int n = 0;
  for (const Tensor<2, 3> &F : kinematics.F_bar) {
    HenckyPlasticity::History history;
    SymmetricTensor<2, 3> tau;
    AssertThrow(law.update(F, {}, history, tau, nullptr), dealii::ExcInternalError());
    n += history.equivalent_plastic_strain > 0. ? 1 : 0;
  }
  return n;
}

/// Undeformed: exactly six zero eigenvalues, no hourglass mode; with G = 0 a single volumetric mode, K = κ V
/// b̄ b̄ᵀ; with κ = 0 no resistance to uniform dilation.
void test_undeformed(const std::string &name, const NodalTensor &X) {
  ElementMatrix K;
  compute_force(*make_block({steel, {}}, X), NodalTensor(), &K);
  dealii::LAPACKFullMatrix<double> matrix(n_element_dofs);
  dealii::FullMatrix<double> eigenvectors;
  dealii::Vector<double> eigenvalues;
  for (unsigned int r = 0; r < n_element_dofs; ++r)
    for (unsigned int c = 0; c < n_element_dofs; ++c)
      matrix(r, c) = K[r * n_element_dofs + c];
  const double size = to_tensor(K).norm();
  matrix.compute_eigenvalues_symmetric(-size, 2. * size, 0., eigenvalues, eigenvectors);
  std::sort(eigenvalues.begin(), eigenvalues.end());
  check(name + ", six rigid body modes", eigenvalues.size() == n_element_dofs &&
                                             std::abs(eigenvalues[0]) < 1e-14 * size &&
                                             std::abs(eigenvalues[5]) < 1e-14 * size);
  check(name + ", no other soft mode", eigenvalues[6] > 1e-2 * size);

  ReferenceElement element;
  MeanDilatationKinematics kinematics;
  AssertThrow(compute_reference_element(to_array(X), element), dealii::ExcInternalError());
  AssertThrow(compute_kinematics(element, ElementVectors{}, kinematics), dealii::ExcInternalError());
  const NodalTensor b = to_tensor(kinematics.mean_divergence);
  compute_force(*make_block({{3., 0.}, {}}, X), NodalTensor(), &K);
  check(name + ", bulk modulus alone: one mode",
        (to_tensor(K) - 3. * kinematics.current_volume * outer_product(b, b)).norm() / to_tensor(K).norm(),
        1e-14);
  compute_force(*make_block({{0., 3.}, {}}, X), NodalTensor(), &K);
  check(name + ", shear modulus alone: free dilation", multiply(K, X).norm() / to_tensor(K).norm(), 1e-14);
}

BILLET_TEST(element_tangent) {
  Random random;
  const NodalTensor X = distorted_cube();
  const auto deform = [&](const double uniform, const double nodal) {
    return displace(random.rotation() * (unit + random.tensor(uniform)), X) + random_nodal(random, nodal);
  };
  test_undeformed("undeformed cube", cube());
  test_undeformed("undeformed distorted element", X);

  const MaterialLaw elastic{steel, {}};
  test_matrix("elastic, undeformed", *make_block(elastic, X), X, NodalTensor());
  test_matrix("elastic, large deformation", *make_block(elastic, X), X, deform(0.4, 0.1));
  test_matrix("elastic, Poisson's ratio 0", *make_block({ElasticModuli::from_young_poisson(2e5, 0.), {}}, X),
              X, deform(0.4, 0.1));
  test_matrix("elastic, Poisson's ratio 0.4999",
              *make_block({ElasticModuli::from_young_poisson(2e5, 0.4999), {}}, X), X, deform(0.4, 0.1));

  for_each_hardening([&](const std::string &name, const auto &hardening) {
    const auto block = make_block({steel, hardening}, X);
    const NodalTensor u = deform(0.1, 0.05);
    test_matrix(name + ", first step", *block, X, u);
    compute_force(*block, u);
    block->commit();
    test_matrix(name + ", second step", *block, X, 1.5 * u);
  });
  const auto nearly_incompressible = make_block({ElasticModuli::from_young_poisson(2e5, 0.4999), linear}, X);
  test_matrix("plastic, Poisson's ratio 0.4999", *nearly_incompressible, X, deform(0.2, 0.1));

  // Smaller steps, lest a point crosses yield.
  const NodalTensor mixed = deform(0., 0.0025);
  const unsigned int n_plastic = count_plastic(X, mixed);
  check("mixed, some points yield, some do not", 2 <= n_plastic && n_plastic <= 6);
  test_matrix("mixed", *make_block({steel, linear}, X), X, mixed, 1e-7, 1e-7);
}

} // namespace element_tangent_test
