// SPDX-License-Identifier: LGPL-2.1-or-later
// Hourglass modes of a brick resist in large shear, compression and stretch, and in ideally plastic flow: no
// eigenvalue of the tangent among the twelve deformations that vary within the brick is negative. Mean
// dilatation, which has no answer to compression but its points' shear, shows that the test can fail.

#include "elements.h"

#include "billet/mechanics/modal_geometry.h"

#include <deal.II/lac/lapack_full_matrix.h>

namespace element_stability_test {

using namespace billet;
using namespace billet::testing;

namespace {

constexpr unsigned int n_modes = 12;

/// Of the symmetric part of the tangent at the block's history, over the shear modulus and the edge; nodal
/// values ±1/√8 are orthogonal to every linear field of a parallelepiped.
double min_eigenvalue(ElementBlock &block, const NodalTensor &u) {
  ElementMatrix K;
  compute_force(block, u, &K);
  std::array<NodalTensor, n_modes> modes;
  for (unsigned int m = 0; m < 4; ++m)
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int a = 0; a < n_element_nodes; ++a)
        modes[3 * m + i][3 * a + i] = mode_values[3 + m][a] / std::sqrt(8.);
  dealii::LAPACKFullMatrix<double> matrix(n_modes);
  for (unsigned int r = 0; r < n_modes; ++r)
    for (unsigned int c = 0; c < n_modes; ++c)
      matrix(r, c) = 0.5 * (modes[r] * multiply(K, modes[c]) + modes[c] * multiply(K, modes[r]));
  dealii::FullMatrix<double> vectors;
  dealii::Vector<double> values;
  matrix.compute_eigenvalues_symmetric(-1e300, 1e300, 0., values, vectors);
  return *std::min_element(values.begin(), values.end()) / steel.shear;
}

Tensor<2, 3> stretch(const double x, const double y, const double z) {
  Tensor<2, 3> F;
  F[0][0] = x;
  F[1][1] = y;
  F[2][2] = z;
  return F;
}

double elastic(const LawFormulation &formulation, const Tensor<2, 3> &F) {
  const auto block = make_block({steel, {}}, cube(), formulation);
  return min_eigenvalue(*block, displace(F, cube()));
}

/// In the middle of ideal flow along a path of 50 small steps; the tangent is that of the next one.
double flowing(const LawFormulation &formulation, const Tensor<2, 3> &rate) {
  constexpr unsigned int n_steps = 50;
  const auto block = make_block({steel, LinearHardening{300., 0.}}, cube(), formulation);
  for (unsigned int step = 1; step <= n_steps; ++step) {
    compute_force(*block, displace(unit + 1e-3 * step * rate, cube()));
    block->commit();
  }
  return min_eigenvalue(*block, displace(unit + 1e-3 * (n_steps + 1) * rate, cube()));
}

} // namespace

BILLET_TEST(element_stability) {
  LawFormulation formulation;
  formulation.elasticity = neo_hookean;
  Tensor<2, 3> sheared = unit, shear_rate;
  sheared[0][1] = 2.;
  shear_rate[0][1] = 1.;
  const std::vector<std::pair<std::string, Tensor<2, 3>>> states = {
      {"undeformed", unit},
      {"sheared by 2", sheared},
      {"pressed to 0.4", stretch(1.2, 1.2, 0.4)},
      {"pressed to a quarter", stretch(2., 2., 0.25)},
      {"pressed in two directions", stretch(0.5, 0.5, 4.)},
      {"stretched to four", stretch(0.5, 0.5, 4.)}};
  const std::vector<std::pair<std::string, Tensor<2, 3>>> rates = {{"plane strain", stretch(1., 0., -1.)},
                                                                   {"upsetting", stretch(0.5, 0.5, -1.)},
                                                                   {"stretch", stretch(-0.5, -0.5, 1.)},
                                                                   {"shear", shear_rate}};
  for (const auto element :
       {ElementFormulation::Element::assumed_strain, ElementFormulation::Element::one_point}) {
    formulation.element = element;
    const std::string name = element.name();
    for (const auto &[state, F] : states)
      check(name + ", elastic, " + state, elastic(formulation, F) > 0.);
    formulation.elasticity = hencky;
    for (const auto &[state, rate] : rates)
      check(name + ", ideal flow, " + state, flowing(formulation, rate) > 0.);
    formulation.elasticity = neo_hookean;
  }
  formulation.element = ElementFormulation::Element::mean_dilatation;
  check("mean dilatation buckles, pressed to 0.4", elastic(formulation, stretch(1.2, 1.2, 0.4)) < -0.1);
}

} // namespace element_stability_test
