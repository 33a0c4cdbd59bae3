// SPDX-License-Identifier: LGPL-2.1-or-later
// A scene turned in space as a whole, its symmetry planes and die with it, gives the same forces: supports
// with any normals are as good as those along the axes. And supports that contradict each other are refused.
#include "scene_run.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>
#include <deal.II/physics/transformations.h>

#include "billet/scene/turning_supports.h"

#include <fstream>

namespace rotated_supports_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;

namespace {

/// A shaft about an axis beside the origin, with a support of these lines on its upper end, which by time 1
/// turns by 2 rad and, if it holds the radius, widens by 2 %.
parameters::Scene read_shaft(const std::string &lines) {
  std::ofstream("shaft.prm") << "subsection Bodies\n  subsection shaft\n    subsection Mesh\n"
                                "      set Primitive = subdivided_hyper_rectangle\n"
                                "      set Arguments = 2, 2, 6 : 2, -4, 0 : 4, -2, 12\n"
                                "    end\n    subsection Material\n"
                                "      set Young modulus = 1000\n      set Poisson ratio = 0.3\n"
                                "    end\n    subsection Supports\n"
                                "      subsection foot\n        set Boundary ids = 4\n      end\n"
                                "      subsection top\n        set Boundary ids = 5\n"
                                "        set Axes = cylindrical\n        set Axis point = 3, -3, 7\n"
                                "        set Axis direction = 0, 0, 2\n"
                             << lines
                             << "      end\n    end\n  end\nend\n"
                                "subsection Output\n  set Format = none\nend\n";
  return parameters::Scene::read("shaft.prm");
}

const std::string radius = "sqrt((x - 3)^2 + (y + 3)^2)", turn = radius + "*2*t";

bool warns(const std::string &lines) {
  const Scene scene(read_shaft(lines));
  const Discretization discretization(scene, MPI_COMM_WORLD);
  return !check_turning_supports(scene, discretization.dof_handler().get_triangulation(), MPI_COMM_WORLD)
              .empty();
}

/// A support that holds radius and circumference turns its nodes about the axis.
void check_twisted_shaft() {
  const std::string lines = "        set Displacement = 0.02*t*" + radius + " ; " + turn + " ; 0\n";
  SceneRun run(read_shaft(lines));
  run.finish();
  const dealii::Tensor<1, 3> middle({3., -3., 0.});
  const auto R =
      dealii::Physics::Transformations::Rotations::rotation_matrix_3d(dealii::Point<3>(0., 0., 1.), 2.);
  testing::WorstError error;
  for (const auto &element : run.discretization.elements(0))
    for (unsigned int a = 0; a < n_element_nodes; ++a) {
      const dealii::Tensor<1, 3> X = element.cell->vertex(a) - middle;
      dealii::Tensor<1, 3> x = X, wanted = R * (1.02 * X);
      wanted[2] = X[2];
      for (unsigned int i = 0; i < 3; ++i)
        x[i] += run.problem.state().displacements(element.dofs[3 * a + i]);
      if (X[2] > 11.9 && dealii::Tensor<1, 3>({X[0], X[1], 0.}).norm() > 1e-9) // the axis has no direction
        error.add((x - wanted).norm());
    }
  check("twisted shaft: a rotation, and a wider end", error.value(), 1e-10);
  check("twisted shaft: no warning", !warns(lines));
  const std::string alone = "        set Components = y\n";
  check("a free radius: large turns are warned of",
        warns(alone + "        set Displacement = " + turn + "\n"));
  check("a free radius: small turns are not",
        !warns(alone + "        set Displacement = 0.04*" + turn + "\n"));
}

} // namespace

BILLET_MPI_TEST(rotated_supports) {
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
  check_twisted_shaft();
}

} // namespace rotated_supports_test
