// SPDX-License-Identifier: LGPL-2.1-or-later
// Hertz: a rigid sphere pressed into an elastic half-space without friction, at the default penalty, five
// elements over the contact radius. With the effective modulus E* = E/(1 − ν²), travel d and radius R
// (Johnson, Contact Mechanics, 1985, ch. 4)
//   a² = R d,   F = 4/3 E* a³/R,   p = p_0 √(1 − r²/a²),   p_0 = 2 E* a/(π R).
// The contact radius is read from the pressures: p² is linear in r².
#include "scene_run.h"

#include "../geometry/make_surface.h"

#include <deal.II/base/mpi.h>

#include <filesystem>
#include <fstream>

namespace hertz_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

constexpr double E = 1000., nu = 0.3, R = 10., a = 0.1;

/// Graded steps from the axis: `n` elements over the contact radius and a half, then each longer than the
/// last, as far as sixty contact radii.
std::vector<double> make_grid(const unsigned int n) {
  const double growth = std::pow(1.5, 6. / n);
  std::vector<double> x{0.};
  double step = a / n;
  while (x.back() < 1.49 * a)
    x.push_back(x.back() + step);
  while (x.back() < 60. * a) {
    step *= growth;
    x.push_back(x.back() + step);
  }
  return x;
}

/// A quarter of the half-space, z <= 0, as a Gmsh file; boundary 1: x = 0, 2: y = 0, 3: top, 4: far away.
void write_mesh(const std::string &name, const std::vector<double> &grid) {
  const std::size_t n = grid.size();
  const auto node = [n](std::size_t i, std::size_t j, std::size_t k) { return 1 + i + n * (j + n * k); };
  std::ofstream out(name);
  out.precision(16);
  out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << n * n * n << "\n";
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = 0; i < n; ++i)
        out << node(i, j, k) << " " << grid[i] << " " << grid[j] << " " << -grid[k] << "\n";
  const std::size_t m = n - 1;
  out << "$EndNodes\n$Elements\n" << m * m * m + 6 * m * m << "\n";
  std::size_t element = 0;
  const auto quad = [&](const unsigned int id, std::size_t p, std::size_t q, std::size_t r, std::size_t s) {
    out << ++element << " 3 2 " << id << " " << id << " " << p << " " << q << " " << r << " " << s << "\n";
  };
  for (std::size_t p = 0; p < m; ++p)
    for (std::size_t q = 0; q < m; ++q) {
      quad(1, node(0, p, q), node(0, p + 1, q), node(0, p + 1, q + 1), node(0, p, q + 1));
      quad(4, node(m, p, q), node(m, p + 1, q), node(m, p + 1, q + 1), node(m, p, q + 1));
      quad(2, node(p, 0, q), node(p + 1, 0, q), node(p + 1, 0, q + 1), node(p, 0, q + 1));
      quad(4, node(p, m, q), node(p + 1, m, q), node(p + 1, m, q + 1), node(p, m, q + 1));
      quad(3, node(p, q, 0), node(p + 1, q, 0), node(p + 1, q + 1, 0), node(p, q + 1, 0));
      quad(4, node(p, q, m), node(p + 1, q, m), node(p + 1, q + 1, m), node(p, q + 1, m));
    }
  for (std::size_t k = 0; k < m; ++k)
    for (std::size_t j = 0; j < m; ++j)
      for (std::size_t i = 0; i < m; ++i)
        out << ++element << " 5 2 0 0 " << node(i, j, k + 1) << " " << node(i + 1, j, k + 1) << " "
            << node(i + 1, j + 1, k + 1) << " " << node(i, j + 1, k + 1) << " " << node(i, j, k) << " "
            << node(i + 1, j, k) << " " << node(i + 1, j + 1, k) << " " << node(i, j + 1, k) << "\n";
  out << "$EndElements\n";
}

} // namespace

BILLET_MPI_TEST(hertz) {
  write_mesh("half_space.msh", make_grid(5));
  std::filesystem::copy_file(std::string(SOURCE_DIR) + "/hertz.prm", "hertz.prm",
                             std::filesystem::copy_options::overwrite_existing);
  auto scene_parameters = parameters::Scene::read("hertz.prm");
  scene_parameters.solver.force_tolerance = 1e-4;
  SceneRun run(scene_parameters);
  run.finish();

  const double effective = E / (1. - nu * nu);
  const double force = 4. * std::abs(run.load().force[2]);
  check("force", std::abs(force / (4. / 3. * effective * a * a * a / R) - 1.), 0.02);

  // Least squares of p² = A − B r² over the nodes well inside: a² = A/B, p_0² = A.
  double s0 = 0., s1 = 0., s2 = 0., t0 = 0., t1 = 0.;
  std::map<DofIndex, dealii::Point<3>> positions;
  for (const auto &element : run.discretization.elements(0))
    for (const unsigned int v : element.cell->vertex_indices())
      positions[element.cell->vertex_dof_index(v, 0)] = element.cell->vertex(v);
  unsigned int n = 0;
  for (const auto &node : run.problem.equation().parts().contacts().of_tools()[0].measures().report()) {
    const auto x = positions.at(node.dofs[0]);
    const double r2 = x[0] * x[0] + x[1] * x[1];
    if (r2 > 0.7 * a * a || node.pressure == 0.)
      continue;
    const double p2 = node.pressure * node.pressure;
    ++n;
    s0 += 1.;
    s1 += r2;
    s2 += r2 * r2;
    t0 += p2;
    t1 += p2 * r2;
  }
  const double B = -(s0 * t1 - s1 * t0) / (s0 * s2 - s1 * s1), A = (t0 + B * s1) / s0;
  check("nodes well inside the contact", n > 15);
  check("contact radius", std::abs(std::sqrt(A / B) / a - 1.), 0.02);
  check("largest pressure", std::abs(std::sqrt(A) / (2. * effective * a / (M_PI * R)) - 1.), 0.02);
}

} // namespace hertz_test
