// SPDX-License-Identifier: LGPL-2.1-or-later
// The mass matrix of an element against integrals in closed form.
#include "billet/mechanics/element_mass.h"

#include "../testing.h"
#include "elements.h"

namespace element_mass_test {

using namespace billet;
using billet::testing::check;
using billet::testing::WorstError;

namespace {

constexpr double density = 7.8;

ElementMass mass_of(const ElementVectors &positions) {
  ReferenceElement element{};
  compute_reference_element(positions, element);
  return compute_element_mass(element, density);
}

double sum(const ElementMass &mass) {
  double result = 0.;
  for (const double entry : mass)
    result += entry;
  return result;
}

} // namespace

BILLET_TEST(element_mass) {
  testing::Random random;
  // A parallelepiped: x = A (ξ + 1)/2.
  dealii::Tensor<2, 3> A = random.tensor(0.3);
  for (unsigned int i = 0; i < 3; ++i)
    A[i][i] += 1. + i;
  ElementVectors positions{};
  std::array<dealii::Tensor<1, 3>, n_element_nodes> corners;
  for (unsigned int a = 0; a < n_element_nodes; ++a) {
    dealii::Tensor<1, 3> xi;
    for (unsigned int i = 0; i < 3; ++i)
      xi[i] = (a >> i) & 1U;
    corners[a] = A * xi;
    for (unsigned int i = 0; i < 3; ++i)
      positions[3 * a + i] = corners[a][i];
  }
  const double volume = dealii::determinant(A);
  ElementMass mass = mass_of(positions);
  WorstError entries;
  for (unsigned int a = 0; a < n_element_nodes; ++a)
    for (unsigned int b = 0; b < n_element_nodes; ++b) {
      double expected = density * volume;
      for (unsigned int i = 0; i < 3; ++i) // ∫ N_a N_b over the unit interval
        expected *= (((a ^ b) >> i) & 1U) == 0U ? 1. / 3. : 1. / 6.;
      entries.add(std::abs(mass[8 * a + b] / expected - 1.));
    }
  check("entries of a parallelepiped", entries.value(), 1e-13);

  // ½ v·M v of v = ω × x is ½ ω·J ω, with J from ∫ x⊗x = V A (1/12 I + 1/4 1⊗1) Aᵀ.
  dealii::Tensor<1, 3> omega = random.vector(2.);
  double energy = 0.;
  for (unsigned int a = 0; a < n_element_nodes; ++a)
    for (unsigned int b = 0; b < n_element_nodes; ++b)
      energy += 0.5 * mass[8 * a + b] *
                (dealii::cross_product_3d(omega, corners[a]) * dealii::cross_product_3d(omega, corners[b]));
  dealii::Tensor<2, 3> moments;
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j)
      moments[i][j] = density * volume * (i == j ? 1. / 3. : 0.25);
  moments = A * moments * dealii::transpose(A);
  const double expected = 0.5 * (dealii::trace(moments) * omega.norm_square() - omega * (moments * omega));
  check("energy of a rotation", std::abs(energy / expected - 1.), 1e-13);

  lump(mass);
  double diagonal = 0.;
  for (unsigned int a = 0; a < n_element_nodes; ++a)
    diagonal += mass[std::size_t{9} * a];
  check("lumped: all of it on the diagonal",
        std::abs(diagonal - sum(mass)) + std::abs(diagonal / (density * volume) - 1.), 1e-13);

  // Any hexahedron: its volume by the divergence theorem, through the kinematics of an undeformed element.
  WorstError total;
  for (unsigned int n = 0; n < 20; ++n) {
    ElementVectors distorted = positions;
    for (double &x : distorted)
      x += random(-0.1, 0.1);
    ReferenceElement element{};
    compute_reference_element(distorted, element);
    MeanDilatationKinematics kinematics{};
    compute_kinematics(element, {}, kinematics);
    total.add(std::abs(sum(mass_of(distorted)) / (density * kinematics.current_volume) - 1.));
  }
  check("mass of distorted hexahedra", total.value(), 1e-13);
}

} // namespace element_mass_test
