// SPDX-License-Identifier: LGPL-2.1-or-later
// Volume that must be kept does not lock the elements with mean dilatation and with one point: a homogeneous
// upsetting, the thick-walled cylinder of MacNeal and Harder, and its plastic limit load. Full integration
// locks.

#include "elements.h"

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

namespace locking_test {

using namespace billet;
using namespace billet::testing;

/// Elements joined at few unknowns: nodal vectors of element e are u_e = D_e q, where the columns of D_e are
/// given directions. Unknowns below n_free are solved for, the rest is prescribed.
struct Assembly {
  std::unique_ptr<ElementBlock> block;
  std::vector<std::vector<std::pair<unsigned int, NodalTensor>>> directions; ///< per element
  unsigned int n_free;
  std::vector<double> q;

  NodalTensor displacement(const std::size_t e) const {
    NodalTensor u;
    for (const auto &[k, direction] : directions[e])
      u += q[k] * direction;
    return u;
  }

  /// Newton to round-off for the loads on the free unknowns; fills the reactions of all. Commits.
  bool solve(const std::vector<double> &loads, std::vector<double> &reactions) {
    double last_change = std::numeric_limits<double>::max();
    for (unsigned int iteration = 0; iteration < 50; ++iteration) {
      dealii::FullMatrix<double> K(n_free);
      dealii::Vector<double> residual(n_free), change(n_free);
      reactions.assign(q.size(), 0.);
      for (std::size_t e = 0; e < directions.size(); ++e) {
        ElementVectors force;
        ElementMatrix matrix;
        if (!block->evaluate(e, to_array(displacement(e)), force, &matrix))
          return false;
        for (const auto &[k, direction] : directions[e]) {
          reactions[k] += direction * to_tensor(force);
          const NodalTensor column = multiply(matrix, direction);
          for (const auto &[l, other] : directions[e])
            if (k < n_free && l < n_free)
              K(k, l) += other * column;
        }
      }
      for (unsigned int k = 0; k < n_free; ++k)
        residual(k) = loads[k] - reactions[k];
      K.gauss_jordan();
      K.vmult(change, residual);
      for (unsigned int k = 0; k < n_free; ++k)
        q[k] += change(k);
      // Quadratic to the end: as soon as the change is small and no longer falls, round-off is reached.
      if (change.l2_norm() < 1e-9 && !(change.l2_norm() < 0.5 * last_change)) {
        block->commit();
        return true;
      }
      last_change = change.l2_norm();
    }
    return false;
  }
};

/// Cube without friction to 0.4 of its height. Yield in Kirchhoff stress, |τ| = σ_y + H α, with
/// α = |ln 0.4| − |τ|/E; lateral log strain ν |τ|/E + α/2; Cauchy stress τ/J, ln J = −(1 − 2ν) |τ|/E.
void test_upsetting(const unsigned int n_steps, const LawFormulation &formulation, const double tolerance) {
  const NodalTensor X = cube();
  Assembly cube_on_planes;
  cube_on_planes.block = make_block({steel, linear}, X, formulation);
  cube_on_planes.n_free = 8; // x of the four nodes at x = 1, y of those at y = 1; the top comes last
  cube_on_planes.directions.resize(1);
  unsigned int n = 0;
  NodalTensor top;
  for (unsigned int k = 0; k < n_element_dofs; ++k)
    if (X[k] == 1.) {
      NodalTensor direction;
      direction[k] = 1.;
      if (k % 3 == 2)
        top += direction;
      else
        cube_on_planes.directions[0].emplace_back(n++, direction);
    }
  cube_on_planes.directions[0].emplace_back(n, top);
  cube_on_planes.q.assign(9, 0.);

  const std::string name =
      name_of(formulation) + ", upsetting to 0.4 in " + std::to_string(n_steps) + " steps";
  std::vector<double> reactions;
  for (unsigned int step = 1; step <= n_steps; ++step) {
    cube_on_planes.q[8] = -0.6 * step / n_steps;
    if (!cube_on_planes.solve(std::vector<double>(8, 0.), reactions))
      return check(name, false);
  }
  const double alpha = (-std::log(0.4) - linear.yield_stress / young) / (1. + linear.modulus / young);
  const double tau = linear.yield_stress + linear.modulus * alpha;
  const double sigma = tau * std::exp((1. - 2. * poisson) * tau / young);
  const double width = std::exp(poisson * tau / young + 0.5 * alpha);
  const ElementSummary summary = cube_on_planes.block->summarize(0, to_array(cube_on_planes.displacement(0)));
  check(name + ", Cauchy stress", std::abs(summary.cauchy_stress[2][2] / -sigma - 1.), tolerance);
  check(name + ", plastic strain", std::abs(summary.equivalent_plastic_strain / alpha - 1.), tolerance);
  check(name + ", width", std::abs((1. + cube_on_planes.q[0]) / width - 1.), tolerance);
  check(name + ", force", std::abs(reactions[8] / (-sigma * width * width) - 1.), tolerance);
  check(name + ", printed reference values",
        std::abs(sigma - 975.324) < 5e-4 && std::abs(alpha - 0.911424) < 5e-7);
}

/// Sector of angle φ and thickness 1 in plane strain, one element in angle, nodes at `radii`; the unknowns
/// are the radial displacements, numbered from the outside so that the inner one comes last.
Assembly make_sector(const MaterialLaw &material, const std::vector<double> &radii, const double phi,
                     const LawFormulation &formulation) {
  Assembly sector;
  std::vector<ElementVectors> positions;
  const std::size_t n = radii.size() - 1;
  for (std::size_t e = 0; e < n; ++e) {
    NodalTensor X, inner, outer;
    for (unsigned int a = 0; a < n_element_nodes; ++a) {
      const bool outside = a & 1U;
      const double angle = (a >> 1 & 1U) * phi, radius = radii[e + (outside ? 1 : 0)];
      NodalTensor &direction = outside ? outer : inner;
      direction[3 * a] = std::cos(angle);
      direction[3 * a + 1] = std::sin(angle);
      X[3 * a] = radius * std::cos(angle);
      X[3 * a + 1] = radius * std::sin(angle);
      X[3 * a + 2] = a >> 2;
    }
    positions.push_back(to_array(X));
    sector.directions.push_back({{n - e, inner}, {n - e - 1, outer}});
  }
  sector.block = make_element_block(material, formulation);
  std::size_t offender = 0;
  AssertThrow(sector.block->initialize(positions, offender), dealii::ExcInternalError());
  sector.n_free = n + 1;
  sector.q.assign(n + 1, 0.);
  return sector;
}

/// Relative error of the inner displacement under inner pressure p, here small enough to be linear. Exact
/// (Lamé, plane strain): u(a) = p a (1 + ν) ((1 − 2ν) a² + b²) / (E (b² − a²)). The radii are those of
/// MacNeal & Harder (1985), each interval divided `refinement` times. The pressure on the inner facet, a
/// chord, works on u(a) with p a sin φ.
double cylinder_error(const double nu, const unsigned int refinement, const LawFormulation &formulation) {
  const std::vector<double> coarse = {3., 3.5, 4.2, 5.2, 6.75, 9.};
  std::vector<double> radii = {coarse[0]};
  for (std::size_t i = 1; i < coarse.size(); ++i)
    for (unsigned int j = 1; j <= refinement; ++j)
      radii.push_back(coarse[i - 1] + (coarse[i] - coarse[i - 1]) * j / refinement);
  const double E = 1000., p = 1e-4, a = 3., b = 9., phi = M_PI / 18. / refinement;
  Assembly sector = make_sector({ElasticModuli::from_young_poisson(E, nu), {}}, radii, phi, formulation);
  std::vector<double> loads(radii.size(), 0.), reactions;
  loads.back() = p * a * std::sin(phi);
  if (!sector.solve(loads, reactions))
    return std::nan("");
  const double exact = p * a * (1. + nu) * ((1. - 2. * nu) * a * a + b * b) / (E * (b * b - a * a));
  return std::abs(sector.q.back() / exact - 1.);
}

/// Relative error of the limit pressure (2/√3) σ_y ln(b/a) of a cylinder with b = 2 a, perfectly plastic,
/// whose inner radius is driven far beyond yield at strains so small that its shape stays.
double limit_load_error(const double nu, const LawFormulation &formulation, const unsigned int n = 8) {
  constexpr unsigned int n_steps = 10;
  const double E = 2e5, yield_stress = 2., phi = 0.05;
  std::vector<double> radii;
  for (unsigned int i = 0; i <= n; ++i)
    radii.push_back(1. + 1. * i / n);
  Assembly sector = make_sector({ElasticModuli::from_young_poisson(E, nu), LinearHardening{yield_stress, 0.}},
                                radii, phi, formulation);
  sector.n_free = n;
  std::vector<double> reactions;
  for (unsigned int step = 1; step <= n_steps; ++step) {
    sector.q.back() = 20. * yield_stress / E * step / n_steps;
    if (!sector.solve(std::vector<double>(n, 0.), reactions))
      return std::nan("");
  }
  return std::abs(reactions.back() / std::sin(phi) / (2. / std::sqrt(3.) * yield_stress * std::log(2.)) - 1.);
}

BILLET_TEST(locking) {
  using Element = ElementFormulation::Element;
  for_each_formulation([](const LawFormulation &formulation) {
    const std::string name = name_of(formulation) + ", ";
    // The closed form is the Hencky law's; that of midpoint strains has an error of second order in the step.
    if (formulation.elasticity == hencky)
      for (const unsigned int n_steps : {5, 50})
        test_upsetting(n_steps, formulation, 1e-10);
    else if (formulation.elasticity == hypoelastic)
      test_upsetting(200, formulation, 1e-4);
    check(name + "thick cylinder, Poisson's ratio 0.3", cylinder_error(0.3, 1, formulation), 0.02);
    for (const auto &[ratio, nu] :
         {std::pair("0.49", 0.49), std::pair("0.499", 0.499), std::pair("0.4999", 0.4999)}) {
      const double error = cylinder_error(nu, 1, formulation);
      check(name + "thick cylinder, Poisson's ratio " + ratio, error, 0.02);
      check(name + "thick cylinder, refined, Poisson's ratio " + ratio, cylinder_error(nu, 2, formulation),
            0.3 * error);
    }
    for (const auto &[ratio, nu] : {std::pair("0.3", 0.3), std::pair("0.4999", 0.4999)}) {
      const double error = limit_load_error(nu, formulation);
      const std::string load = name + "plastic limit load, Poisson's ratio " + ratio;
      if (formulation.element == Element::one_point) {
        // Flow within an element meets the stabilisation at its limit; its share goes with the size.
        check(load, error, 0.04);
        check(load + ", refined", limit_load_error(nu, formulation, 16), 0.6 * error);
      } else
        check(load, error, 5e-3);
    }
  });
}

} // namespace locking_test
