// SPDX-License-Identifier: LGPL-2.1-or-later
// Hourglass modes of a brick resist in large shear, compression and stretch, and in ideally plastic flow: no
// eigenvalue of the tangent among the twelve deformations that vary within the brick is negative. Mean
// dilatation, which has no answer to compression but its points' shear, shows that the test can fail.
// A block of many bricks is pressed between plates without friction until its tangent has a negative
// eigenvalue: not before that of the continuum (Biot 1965).

#include "elements.h"

#include "billet/mechanics/modal_geometry.h"

#include <deal.II/lac/lapack_full_matrix.h>

using namespace billet;
using namespace billet::testing;

namespace {

constexpr unsigned int n_modes = 12;

/// Of the symmetric part of the tangent at the block's history, over the shear modulus and the edge; nodal
/// values ±1/√8 are orthogonal to every linear field of a parallelepiped.
double least_eigenvalue(ElementBlock &block, const NodalTensor &u) {
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

double elastic(const ElementFormulation &formulation, const Tensor<2, 3> &F) {
  const auto block = make_block({steel, {}}, cube(), formulation);
  return least_eigenvalue(*block, displace(F, cube()));
}

/// In the middle of ideal flow along a path of 50 small steps; the tangent is that of the next one.
double flowing(const ElementFormulation &formulation, const Tensor<2, 3> &rate) {
  constexpr unsigned int n_steps = 50;
  const auto block = make_block({steel, LinearHardening{300., 0.}}, cube(), formulation);
  for (unsigned int step = 1; step <= n_steps; ++step) {
    compute_force(*block, displace(unit + 1e-3 * step * rate, cube()));
    block->commit();
  }
  return least_eigenvalue(*block, displace(unit + 1e-3 * (n_steps + 1) * rate, cube()));
}

// --- blocks ---------------------------------------------------------------------------------------------

constexpr double bulk_over_shear = 5e3;

/// The stretch across, under the one along z, in plane strain with a free side.
double free_stretch(const double pressed) {
  // τ_xx = κ ln J + G J^{-2/3} (x² − tr b/3) = 0, by bisection.
  const auto stress = [pressed](const double x) {
    const double J = x * pressed;
    return bulk_over_shear * std::log(J) +
           std::pow(J, -2. / 3.) * (x * x - (x * x + 1. + pressed * pressed) / 3.);
  };
  double low = 0.5 / pressed, high = 2. / pressed;
  for (unsigned int i = 0; i < 100; ++i)
    (stress(0.5 * (low + high)) < 0. ? low : high) = 0.5 * (low + high);
  return low;
}

/// Of the tangent of a square of n x n bricks in plane strain: half of a block, nearly incompressible,
/// pressed along z between plates without friction to the stretch `pressed`, with a free side.
unsigned int n_negative(const ElementFormulation &formulation, const unsigned int n, const double pressed) {
  MaterialLaw law{steel, {}};
  law.elastic.bulk = bulk_over_shear * law.elastic.shear;
  const NodalTensor X = 1. / n * cube();
  const auto block = make_block(law, X, formulation);
  ElementMatrix K;
  compute_force(*block, displace(stretch(free_stretch(pressed), 1., pressed), X), &K);

  constexpr unsigned int held = dealii::numbers::invalid_unsigned_int;
  std::map<std::array<unsigned int, 3>, unsigned int> dofs; // of a node at (i, j) in x and z
  const auto dof = [&](const unsigned int i, const unsigned int j, const unsigned int component) {
    const bool is_held =
        component == 1 || (component == 0 && i == 0) || (component == 2 && (j == 0 || j == n));
    return is_held ? held
                   : dofs.emplace(std::array<unsigned int, 3>{i, j, component},
                                  static_cast<unsigned int>(dofs.size()))
                         .first->second;
  };
  const unsigned int size = n * (n + 1) + (n + 1) * (n - 1);
  dealii::LAPACKFullMatrix<double> matrix(size);
  for (unsigned int i = 0; i < n; ++i)
    for (unsigned int j = 0; j < n; ++j) {
      std::array<unsigned int, n_element_dofs> of_element{};
      for (unsigned int a = 0; a < n_element_nodes; ++a)
        for (unsigned int c = 0; c < 3; ++c)
          of_element[3 * a + c] = dof(i + (a & 1U), j + (a >> 2U), c);
      for (unsigned int r = 0; r < n_element_dofs; ++r)
        for (unsigned int c = 0; c < n_element_dofs; ++c)
          if (of_element[r] != held && of_element[c] != held)
            matrix(of_element[r], of_element[c]) +=
                0.5 * (K[r * n_element_dofs + c] + K[c * n_element_dofs + r]);
    }
  dealii::FullMatrix<double> vectors;
  dealii::Vector<double> negative;
  matrix.compute_eigenvalues_symmetric(-1e300, 0., 0., negative, vectors);
  return negative.size();
}

/// The stretch at which the first one appears.
double first_instability(const ElementFormulation &formulation, const unsigned int n) {
  double stable = 1., unstable = 0.2;
  if (n_negative(formulation, n, unstable) == 0)
    return 0.;
  while (stable - unstable > 1e-3) {
    const double middle = 0.5 * (stable + unstable);
    (n_negative(formulation, n, middle) > 0 ? unstable : stable) = middle;
  }
  return unstable;
}

/// Of the continuum with one half wave along z. f(x) cos kz is a stream function of symmetric modes where
/// (λ_x² ∂_xx + λ_z² ∂_zz) Δ(f cos kz) = 0, so that f is a sum of cosh kx and cosh rkx, r = λ_z/λ_x. The side
/// is free where (1 + r²)² tanh(r k a) = 4 r tanh(k a). Shorter waves come later, down to those of a half
/// space at 0.5437.
double continuum_instability() {
  const auto excess = [](const double stretch) {
    const double r = stretch * stretch, ka = dealii::numbers::PI / r; // width 1/λ_z, height λ_z
    return (1. + r * r) * (1. + r * r) * std::tanh(r * ka) - 4. * r * std::tanh(ka);
  };
  double stable = 0.9, unstable = 0.2;
  while (stable - unstable > 1e-9) {
    const double middle = 0.5 * (stable + unstable);
    (excess(middle) > 0. ? unstable : stable) = middle;
  }
  return unstable;
}

void check_blocks() {
  const double exact = continuum_instability();
  for (const auto element : all_elements) {
    ElementFormulation formulation;
    formulation.element = element;
    formulation.kinematics = ElementFormulation::Kinematics::neo_hookean;
    const std::string name = billet::name_of(element);
    const double coarse = first_instability(formulation, 8), fine = first_instability(formulation, 16);
    check(name + ", a block is not unstable before the continuum is", coarse < exact && fine < exact);
    check(name + ", but then, and the finer the nearer", coarse < fine && fine > 0.97 * exact);
  }
}

} // namespace

int main() {
  ElementFormulation formulation;
  formulation.kinematics = ElementFormulation::Kinematics::neo_hookean;
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
    const std::string name = billet::name_of(element);
    for (const auto &[state, F] : states)
      check(name + ", elastic, " + state, elastic(formulation, F) > 0.);
    formulation.kinematics = ElementFormulation::Kinematics::hencky;
    for (const auto &[state, rate] : rates)
      check(name + ", ideal flow, " + state, flowing(formulation, rate) > 0.);
    formulation.kinematics = ElementFormulation::Kinematics::neo_hookean;
  }
  formulation.element = ElementFormulation::Element::mean_dilatation;
  check("mean dilatation buckles, pressed to 0.4", elastic(formulation, stretch(1.2, 1.2, 0.4)) < -0.1);
  check_blocks();
  return exit_code();
}
