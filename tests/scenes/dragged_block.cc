// SPDX-License-Identifier: LGPL-2.1-or-later
// A block held at its top, pressed onto a tool, with sliding friction: pulled over a plane; on a cylinder
// that turns under it; on a plane that turns under it. At every node the friction is μ p, and against the
// velocity of the node relative to the tool, as near as a step of finite length tells.
#include "materials.h"
#include "scene_run.h"

#include "../geometry/make_surface.h"

#include <deal.II/base/mpi.h>

namespace dragged_block_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;
using dealii::Tensor;

namespace {

constexpr double mu = 0.2;

struct Sliding {
  double cone = 1., direction = 1., sum = 1.; ///< errors
  bool all_slide = false;
};

/// `rate`: of the tool's rotation about its axis; `pull`: of the block's top along x.
Sliding slide(const parameters::Scene &parameters, const double rate, const double pull) {
  SceneRun run(parameters);
  run.finish();
  const Tool &tool = run.scene.tools()[0];
  const Placement &placement = run.problem.state().placements[0];
  Sliding result;
  testing::WorstError cone, direction;
  Tensor<1, 3> normal_force;
  unsigned int n_slide = 0, n_touch = 0;
  for (const auto &node : run.problem.equation().parts().contacts().of_tools()[0].measures().report()) {
    if (node.status == ContactStatus::open)
      continue;
    ++n_touch;
    n_slide += node.status == ContactStatus::slip ? 1 : 0;
    Tensor<1, 3> x;
    for (unsigned int i = 0; i < 3; ++i)
      x[i] = run.problem.state().displacements(node.dofs[i]);
    for (const auto &element : run.discretization.elements(0))
      for (const unsigned int v : element.cell->vertex_indices())
        if (element.cell->vertex_dof_index(v, 0) == node.dofs[0])
          for (unsigned int i = 0; i < 3; ++i)
            x[i] = run.problem.state().displacements(node.dofs[i]) + element.cell->vertex(v)[i];
    const Tensor<1, 3> n = placement.rotation * tool.surface().project(placement.to_tool(x)).normal;
    const Tensor<1, 3> tangential = node.traction - (node.traction * n) * n;
    Tensor<1, 3> velocity({pull, 0., 0.}); // of the node, steady, less that of the tool below it
    velocity -= rate * dealii::cross_product_3d(tool.rotation_axis(), x - placement.moved_centre());
    velocity -= (velocity * n) * n;
    if (velocity.norm() > 0.05 * std::abs(rate)) { // not at the axis of a turning plane, where it sticks
      cone.add(std::abs(tangential.norm() / (mu * node.pressure) - 1.));
      direction.add((tangential / tangential.norm() + velocity / velocity.norm()).norm());
    }
    normal_force += node.area * node.pressure * n;
  }
  result.cone = cone.value();
  result.direction = direction.value();
  result.all_slide = n_touch > 2 && n_slide == n_touch;
  const Tensor<1, 3> friction = run.load().force - normal_force;
  result.sum = std::abs(friction.norm() / (mu * normal_force.norm()) - 1.);
  return result;
}

parameters::Scene make_scene(const testing::SurfacePart &part, const Tensor<1, 3> &axis, const double rate,
                             const double pull, const double step) {
  parameters::Scene scene = parameters::Scene::read(std::string(SOURCE_DIR) + "/block_on_plane.prm");
  const std::string press = std::to_string(-0.02) + "*min(t, 1)";
  scene.bodies[0].supports[0].displacement.value = {dealii::Utilities::to_string(pull) + "*t", "0", press};
  testing::set_hardening(scene.bodies[0].material,
                         LinearHardening{1e6, testing::linear_hardening(scene.bodies[0].material).modulus});
  auto &tool = scene.tools[0];
  tool.surface = testing::make_surface(part.shape, part.lines);
  tool.motion.rotation_axis = axis;
  tool.motion.rotation_angle.value = dealii::Utilities::to_string(rate) + "*t";
  tool.motion.translation.value = {"0", "0", "0"};
  tool.motion.centre = Tensor<1, 3>({0.5, 0.5, 0.});
  scene.pairs[0].friction = make_coulomb(mu);
  scene.time_stepping.initial_step = step;
  scene.time_stepping.end_time = 3.;
  scene.solver.force_tolerance = 1e-13;
  scene.solver.energy_tolerance = 1e-20;
  return scene;
}

} // namespace

BILLET_MPI_TEST(dragged_block) {
  const Tensor<1, 3> y({0., 1., 0.}), z({0., 0., 1.});

  const auto pulled = slide(make_scene({"plane", ""}, z, 0., 0.4, 0.1), 0., 0.4);
  check("pulled over a plane: all nodes slide", pulled.all_slide);
  check("pulled over a plane: friction is mu p at every node", pulled.cone, 1e-10);
  check("pulled over a plane: friction is mu N", pulled.sum, 1e-10);
  check("pulled over a plane: against the velocity", pulled.direction, 1e-9);

  // The same over a floor of tiles, whose seams the nodes cross.
  auto plane_scene = make_scene({"plane", ""}, z, 0., 0.4, 0.1), tiled_scene = plane_scene;
  std::vector<testing::SurfacePart> tiles;
  for (int i = -2; i < 8; ++i)
    for (int j = -2; j < 6; ++j)
      tiles.push_back({"rectangle",
                       "set Length = 0.37\nset Width = 0.29\nset Centre = " + std::to_string(0.37 * i + 0.1) +
                           ", " + std::to_string(0.29 * j) + ", 0"});
  tiled_scene.tools[0].surface = testing::make_surface(tiles);
  SceneRun on_plane(plane_scene), on_tiles(tiled_scene);
  testing::WorstError seams;
  while (!on_plane.control.is_finished()) {
    on_plane.advance();
    on_tiles.advance();
    seams.add((on_plane.load().force - on_tiles.load().force).norm() / on_plane.load().force.norm());
    const auto one = on_plane.problem.equation().parts().contacts().of_tools()[0].measures().report(),
               other = on_tiles.problem.equation().parts().contacts().of_tools()[0].measures().report();
    for (std::size_t i = 0; i < one.size(); ++i)
      seams.add((one[i].traction - other[i].traction).norm() / on_plane.load().force.norm());
  }
  check("a floor of tiles is a floor", seams.value(), 1e-10);

  auto on_cylinder = make_scene({"cylinder", "set Point = 0.5, 0.5, -8\nset Axis = 0, 1, 0\nset Radius = 8"},
                                y, 0.05, 0., 0.1);
  on_cylinder.tools[0].motion.centre = Tensor<1, 3>({0.5, 0.5, -8.});
  const auto turned = slide(on_cylinder, 0.05, 0.);
  check("cylinder turning under it: all nodes slide", turned.all_slide);
  check("cylinder turning under it: friction is mu p at every node", turned.cone, 1e-10);
  check("cylinder turning under it: against the velocity", turned.direction, 1e-3);

  const auto spun = slide(make_scene({"plane", ""}, z, 0.5, 0., 0.1), 0.5, 0.);
  const auto spun_finely = slide(make_scene({"plane", ""}, z, 0.5, 0., 0.025), 0.5, 0.);
  check("plane turning under it: friction is mu p at every node", spun.cone, 1e-10);
  check("plane turning under it: against the velocity, as near as the step", spun.direction, 0.05);
  check("plane turning under it: ... and nearer with shorter steps",
        std::abs(spun_finely.direction / spun.direction - 0.25), 0.1);
}

} // namespace dragged_block_test
