// SPDX-License-Identifier: LGPL-2.1-or-later
// A scene turned in space as a whole, its symmetry planes and die with it, gives the same forces: supports
// with any normals are as good as those along the axes. And supports that contradict each other are refused.
#include "scene_run.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>
#include <deal.II/physics/transformations.h>

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

int main(int argc, char *argv[]) {
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  parameters::Scene upright = testing::read_shipped_scene("billet_upsetting.prm");
  upright.time_stepping.end_time = 0.3;
  parameters::Scene turned = upright;
  dealii::Tensor<1, 3> axis({1. / 3., 2. / 3., 2. / 3.}), shift({5., -7., 11.});
  const double angle = 1.1;
  const auto R = dealii::Physics::Transformations::Rotations::rotation_matrix_3d(axis, angle);
  upright.solver.force_tolerance = turned.solver.force_tolerance = 1e-10;
  auto &body = turned.bodies[0];
  body.mesh.rotation_axis = axis;
  body.mesh.rotation_angle = angle;
  body.mesh.translation = shift;
  for (auto &plane : body.symmetry_planes.value) {
    plane.normal = R * plane.normal;
    plane.offset = plane.normal * shift;
  }
  auto &tool = turned.tools[0];
  tool.surface = testing::make_plane(R * dealii::Tensor<1, 3>({0., 0., 15.}) + shift,
                                     R * dealii::Tensor<1, 3>({0., 0., -1.}));
  for (unsigned int i = 0; i < 3; ++i)
    tool.motion.translation.value[i] = dealii::Utilities::to_string(R[i][2]) + "*(-9.6*t)";

  SceneRun a(upright), b(turned);
  testing::WorstError force_error;
  bool same_iterations = true;
  while (!a.control.is_finished()) {
    const auto first = a.advance(), second = b.advance();
    same_iterations = same_iterations && first.iterations.size() == second.iterations.size();
    force_error.add((R * a.load().force - b.load().force).norm() / a.load().force.norm());
  }
  check("turned scene: same iterations", same_iterations);
  check("turned scene: the force turns with it", force_error.value(), 1e-9);

  bool refused = false;
  try {
    parameters::Scene torn = parameters::Scene::read(std::string(SOURCE_DIR) + "/block_on_plane.prm");
    auto second = torn.bodies[0].supports[0];
    second.name = "side";
    second.boundary_ids.value = {0};
    second.displacement.value = {"0", "0", "0"};
    torn.bodies[0].supports.push_back(second);
    SceneRun run(torn);
    run.advance();
  } catch (const InputError &error) {
    refused = std::string(error.what()).find("contradict") != std::string::npos;
  }
  check("contradicting supports are refused", refused);
  return billet::testing::exit_code();
}
