// SPDX-License-Identifier: LGPL-2.1-or-later
// Which of two bodies is the slave changes results by the error of the mesh alone. Two bodies with wavy faces
// are pressed onto each other and dragged along each other, with either as the first body of the pair, in one
// pass. The forces F and F' of both runs differ by |F − F'| = O(h²) |F| with overlaps, which are integrated,
// and O(h) |F| with tractions at slave nodes. In every run the contact forces on both bodies add up to
// nothing but round-off.
#include "scene_run.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace swapped_roles_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;
using dealii::Tensor;

namespace {

constexpr std::size_t lower = 0, upper = 1;

struct Forces {
  std::array<Tensor<1, 3>, 2> on_body; ///< sums of the contact forces on its nodes
  double nodal = 0.;                   ///< sum of their magnitudes
};

Forces sum_forces(SceneRun &run) {
  Vector additive = run.discretization.make_additive_vector(),
         residual = run.discretization.make_owned_vector();
  run.problem.equation().parts().contacts().of_bodies()[0].with_matrix().add_forces(additive);
  additive.compress(dealii::VectorOperation::add);
  residual = additive;
  Forces forces;
  for (const std::size_t body : {lower, upper}) {
    std::set<DofIndex> counted;
    for (const auto &element : run.discretization.elements(body))
      for (unsigned int a = 0; a < n_element_nodes; ++a) {
        const DofIndex *dofs = &element.dofs[std::size_t{3} * a];
        if (!counted.insert(dofs[0]).second)
          continue;
        const Tensor<1, 3> force({-residual(dofs[0]), -residual(dofs[1]), -residual(dofs[2])});
        forces.on_body[body] += force;
        forces.nodal += force.norm();
      }
  }
  return forces;
}

/// Returns the force on the upper body; the slave is the first body of the pair, here the upper one unless
/// they are swapped.
Tensor<1, 3> solve(const std::string &name, parameters::Scene scene, const bool are_swapped) {
  auto &pair = scene.pairs[0];
  if (are_swapped) {
    std::swap(pair.body, pair.second_body);
    std::swap(pair.boundary_ids, pair.second_boundary_ids);
  }
  SceneRun run(scene);
  run.finish();
  const Forces forces = sum_forces(run);
  check(name + ": forces balance", (forces.on_body[lower] + forces.on_body[upper]).norm() / forces.nodal,
        1e-14);
  const Tensor<1, 3> &load = run.problem.state().body_pair_loads[0].force;
  check(name + ": the load is the force on the first body",
        (load - forces.on_body[are_swapped ? lower : upper]).norm() / load.norm(), 1e-12);
  std::set<DofIndex> slaves, of_slave;
  bool stick = false, slip = false;
  const auto reports = run.problem.report_contacts();
  for (const auto &node : reports[0])
    if (node.status != ContactStatus::open) {
      slaves.insert(node.dofs[0]);
      stick = stick || node.status == ContactStatus::stick;
      slip = slip || node.status == ContactStatus::slip;
    }
  for (const auto &element : run.discretization.elements(are_swapped ? lower : upper))
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      of_slave.insert(element.dofs[std::size_t{3} * a]);
  check(name + ": nodes of the first body touch",
        !slaves.empty() && std::includes(of_slave.begin(), of_slave.end(), slaves.begin(), slaves.end()));
  check(name + ": they slip, and on the fine mesh some stick", slip && (stick || slaves.size() < 20));
  return forces.on_body[upper];
}

/// Difference of the forces with n times as many bricks along each edge as the coarsest mesh has.
double difference(const std::string &name, const FacetMethod facets, const unsigned int n) {
  parameters::Scene scene = testing::read_test_scene("swapped_roles.prm");
  scene.pairs[0].facets.method.value = facets;
  const auto bricks = [n](const unsigned int along) {
    return std::to_string(along * n) + ", 1, " + std::to_string(n);
  };
  scene.bodies[lower].mesh.arguments = bricks(8) + " : -1, 0, -0.5 : 1, 0.2, 0 : true";
  scene.bodies[upper].mesh.arguments = bricks(6) + " : -1, 0, 0 : 1, 0.2, 0.5 : true";
  const std::string here = name + ", " + bricks(8) + " bricks";
  const Tensor<1, 3> one = solve(here, scene, false), other = solve(here + ", swapped", scene, true);
  const double result = (one - other).norm() / one.norm();
  std::cout << "  difference of the forces " << result << std::endl;
  return result;
}

} // namespace

BILLET_MPI_TEST(swapped_roles) {
  constexpr unsigned int n = 3;
  // Overlaps are integrated: h². Tractions at nodes with their areas end within facets: h.
  for (const auto &[facets, name, order] :
       {std::tuple<FacetMethod, std::string, double>{FacetMethod::overlap, "overlap", 2.},
        {FacetMethod::planed, "planed", 1.}}) {
    const double coarse = difference(name, facets, 1), fine = difference(name, facets, n);
    check(name + ": the difference is one of the mesh", coarse, order > 1. ? 0.005 : 0.03);
    check(name + ": it falls with its size", fine / coarse, std::pow(n, -order));
  }
}

} // namespace swapped_roles_test
