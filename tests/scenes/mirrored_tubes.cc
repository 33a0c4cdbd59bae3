// SPDX-License-Identifier: LGPL-2.1-or-later
// The impact of two tubes that are mirror images of each other: they stay so, energy is kept, and they hardly
// enter each other; with their ends in the pair or without.
#include "billet/errors.h"
#include "billet/parameters/scene.h"
#include "billet/solve/explicit/explicit_dynamics.h"

#include "../testing.h"

#include <array>
#include <cmath>
#include <map>

namespace mirrored_tubes_test {

using namespace billet;
using namespace billet::testing;
using dealii::Tensor;

namespace {

constexpr double diameter = 0.2, wall = 0.01, speed = 50., end_time = 1e-3;

/// Nodes of both tubes at mirror images of each other, at y and −y.
std::vector<std::array<unsigned int, 2>> find_mates(const LocalNodes &nodes) {
  std::map<std::array<long, 3>, unsigned int> found;
  const auto key = [&](const unsigned int node, const double side) {
    Tensor<1, 3> x = get_vector(nodes.positions().data(), node) / diameter;
    x[1] *= side;
    return std::array<long, 3>{std::lround(1e6 * x[0]), std::lround(1e6 * x[1]), std::lround(1e6 * x[2])};
  };
  for (unsigned int node = 0; node < nodes.size(); ++node)
    found[key(node, 1.)] = node;
  std::vector<std::array<unsigned int, 2>> mates;
  for (unsigned int node = 0; node < nodes.size(); ++node) {
    const auto mate = found.find(key(node, -1.));
    if (mate != found.end())
      mates.push_back({node, mate->second});
  }
  return mates;
}

double run(const std::vector<unsigned int> &boundary_ids, const std::string &name) {
  parameters::Scene parameters =
      parameters::Scene::read(std::string(SOURCE_DIR) + "/../../prm/tube_impact.prm");
  parameters.pairs[0].boundary_ids.value = boundary_ids;
  parameters.pairs[0].second_boundary_ids.value = boundary_ids;
  const Scene scene(parameters);
  const Discretization discretization(scene, MPI_COMM_WORLD);
  ExplicitDynamics problem(scene, discretization);
  const LocalNodes nodes(discretization);
  const auto mates = find_mates(nodes);
  double asymmetry = 0., deepest = 0., drift = 0., momentum = 0.;
  bool is_finished = false;
  for (unsigned int step = 0; !is_finished; ++step) {
    is_finished = problem.time() >= end_time;
    problem.prepare_step(is_finished ? 2. * end_time : end_time);
    if (step % 10 == 0 || is_finished) {
      problem.update_state();
      deepest = std::max(deepest, problem.state().body_pair_loads[0].deepest);
      drift = std::max(drift, std::abs(problem.relative_drift()));
      momentum = std::max(momentum, problem.state().momentum.norm());
    }
    if (!is_finished)
      problem.finish_step();
  }
  const auto &u = problem.state().displacements;
  for (const auto &mate : mates)
    for (unsigned int i = 0; i < 3; ++i)
      asymmetry = std::max(
          asymmetry, std::abs(u[nodes.dofs(mate[0])[i]] - (i == 1 ? -1. : 1.) * u[nodes.dofs(mate[1])[i]]));
  check(name + ": every node has a mate", mates.size() == nodes.size());
  check(name + ": mirror images", asymmetry / diameter, 1e-9);
  check(name + ": penetration", deepest / wall, 0.01);
  check(name + ": they touch", deepest > 0.);
  check(name + ": energy", drift, 0.01);
  // Of one of them, m v: E = 2 m v²/2.
  check(name + ": momentum", momentum / (problem.state().energies.initial / speed), 1e-12);
  return problem.state().energies.kinetic / problem.state().energies.initial;
}

/// Circles of 0.1 m that start 2 mm in each other. Their crests are the middles of plane faces, below which,
/// by a thousandth of the element, the deepest point is.
void check_overlap() {
  parameters::Scene parameters =
      parameters::Scene::read(std::string(SOURCE_DIR) + "/../../prm/tube_impact.prm");
  parameters.bodies[1].mesh.translation[1] -= 0.003;
  std::string message;
  try {
    const Scene scene(parameters);
    const Discretization discretization(scene, MPI_COMM_WORLD);
    const ExplicitDynamics problem(scene, discretization);
  } catch (const InputError &error) {
    message = error.what();
  }
  const auto depth = message.find("penetration of ");
  const double degree = dealii::numbers::PI / 180.;
  const double thickness = 0.005 * std::cos(6. * degree) * 0.5 * (0.1 + 0.095) / 0.1,
               expected = 0.002 - 2. * 0.1 * (1. - std::cos(6. * degree)) - 1e-3 * thickness;
  check("an overlap is refused, with its depth",
        depth == std::string::npos ? 1. : std::abs(std::stod(message.substr(depth + 15)) / expected - 1.),
        1e-5);
}

} // namespace

BILLET_MPI_TEST(mirrored_tubes) {
  const double outside = run({1}, "outside"), all = run({1, 2, 3}, "with ends");
  check("ends change nothing that one sees", std::abs(all - outside), 1e-3);
  check_overlap();
}

} // namespace mirrored_tubes_test
