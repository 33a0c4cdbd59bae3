// SPDX-License-Identifier: LGPL-2.1-or-later
// The assembled tangent of a whole scene (elements, contact, supports) against central differences of its
// residual, with nodes that stick, slip and enter, on tools of every shape that turn and move, for every
// friction law.
#include "billet/friction/pressure_dependent.h"
#include "billet/friction/shear_limited.h"
#include "billet/friction/static_kinetic.h"
#include "tangent_check.h"

#include <deal.II/base/mpi.h>

#include <fstream>

namespace tangent_of_scene_test {

using namespace billet;
using billet::testing::check;
using billet::testing::make_curved;
using billet::testing::SceneRun;
using billet::testing::tangent_error;

namespace {

/// A few triangles of a paraboloid that touches the block, smoothed by their reading.
void write_dome(const std::string &name) {
  std::ofstream out(name);
  out << "solid dome\n";
  const int n = 6;
  const auto vertex = [&](const int i, const int j) {
    const double x = -1. + 0.53 * i, y = -1. + 0.51 * j;
    const double z = -0.01 - 0.06 * ((x - 0.45) * (x - 0.45) + (y - 0.55) * (y - 0.55));
    out << "vertex " << x << " " << y << " " << z << "\n";
  };
  const auto facet = [&](const std::array<std::array<int, 2>, 3> &corners) {
    out << "facet normal 0 0 1\nouter loop\n";
    for (const auto &corner : corners)
      vertex(corner[0], corner[1]);
    out << "endloop\nendfacet\n";
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      facet({{{i, j}, {i + 1, j}, {i + 1, j + 1}}});
      facet({{{i, j}, {i + 1, j + 1}, {i, j + 1}}});
    }
  out << "endsolid dome\n";
}

void check_curved() {
  write_dome("dome.stl");
  const std::vector<testing::SurfacePart> parts{
      {"sphere", "set Centre = 0.45, 0.55, -5\nset Radius = 5"},
      {"sphere", "set Centre = 0.45, 0.55, 4.9\nset Radius = 5\nset Side = inside"},
      {"cylinder", "set Point = 0.45, 0.55, -3\nset Radius = 3\nset Axis = 1, 0.4, 0.1"},
      {"cone", "set Apex = -4, 0.6, -1.5\nset Axis = 1, 0, 0\nset Half angle = 18\nset To height = 12"},
      {"torus", "set Centre = 0.45, 0.55, -8\nset Axis = 0, 1, 0\nset Ring radius = 5\nset Tube radius = 3"},
      {"torus",
       "set Centre = 0.45, 0.55, 4.98\nset Axis = 0, 1, 0.05\nset Ring radius = 7\nset Tube radius = 2"},
      {"extruded profile", "set Origin = 0.45, 0.55, -0.05\nset Axis = 0, 1, 0\nset Outside = right\n"
                           "set Corners = -2, -0.6 ; via 0, 0.05 to 2, -0.6"},
      {"coons patch", "set Curves = arc: -1, -1, -0.3 via 0.5, -1, -0.04 to 2, -1, -0.3 ; "
                      "arc: 2, -1, -0.3 via 2, 0.5, -0.2 to 2, 2, -0.3 ; "
                      "arc: 2, 2, -0.3 via 0.5, 2, -0.04 to -1, 2, -0.3 ; "
                      "arc: -1, 2, -0.3 via -1, 0.5, -0.2 to -1, -1, -0.3"},
      {"STL", "set Closed = false\nset File = dome.stl"},
      {"revolved profile",
       "set Origin = 0.45, 0.55, 0\nset Corners = 0, 0 ; 0.35, 0 : 1 ; 1, -0.2\nset Outside = left"}};
  for (const auto &part : parts)
    testing::check_curved(part.shape, part);
  // Trimmed planes and cavities.
  const std::vector<std::pair<std::string, testing::SurfacePart>> more{
      {"rectangle",
       {"rectangle", "set Centre = 0.6, 0.5, -0.005\nset Normal = 0.04, 0.02, 1\nset Direction = "
                     "1, 0.3, 0\nset Length = 1.3\nset Width = 1.1"}},
      {"disc", {"disc", "set Centre = 0.52, 0.51, -0.005\nset Normal = 0.04, 0.02, 1\nset Radius = 0.61"}},
      {"cylinder from inside",
       {"cylinder",
        "set Side = inside\nset Point = 0.45, 0.55, 4.95\nset Radius = 5\nset Axis = 1, 0.4, 0.01"}},
      {"cone from inside",
       {"cone", "set Side = inside\nset Apex = -4, 0.6, -0.06\nset Axis = 0.8660254037844386, 0, 0.5\nset "
                "Half angle = 30\nset To height = 12"}},
      {"torus from inside",
       {"torus", "set Side = inside\nset Centre = 0.45, 0.55, 7.94\nset Axis = 0, 1, "
                 "0\nset Ring radius = 5\nset Tube radius = 3"}},
      {"inner side of a torus from inside",
       {"torus", "set Side = inside\nset Centre = 0.45, 0.55, -2.03\nset Axis = 0, 1, 0\nset Ring radius = "
                 "5\nset Tube radius = 3"}}};
  for (const auto &[name, part] : more)
    testing::check_curved(name, part);
  // A tool that presses with a force, and one that a moment turns: the bordered system.
  for (const auto &[name, friction] : {std::pair<std::string, double>{"force, much friction", 0.8},
                                       {"force, little friction", 0.03},
                                       {"moment, much friction", 0.8}}) {
    const bool turns = name.front() == 'm';
    parameters::Scene pressed =
        make_curved({"sphere", "set Centre = 0.45, 0.55, -4.98\nset Radius = 5"}, friction);
    auto &motion = pressed.tools[0].motion;
    motion.control = turns ? parameters::Motion::Control::moment : parameters::Motion::Control::force;
    motion.direction = dealii::Tensor<1, 3>({0.6, 0., 0.8});
    motion.load.value = turns ? "0.02*t" : "5 + 10*t";
    pressed.solver.contact_tangent = parameters::ContactTangent::exact;
    SceneRun run(pressed);
    check(name + ": exact tangent with the tool's travel", tangent_error(run, 0.75, 3), 1e-6);
  }
  for (const double friction : {0.8, 0.03}) {
    parameters::Scene scene = make_curved(parts[4], friction);
    scene.solver.contact_tangent = parameters::ContactTangent::numerical;
    SceneRun numerical(scene);
    const std::string name = friction > 0.5 ? "torus, sticking" : "torus, slipping";
    check(name + ": numerical tangent", tangent_error(numerical, 0.75, 3), 1e-6);
    unsigned int n_stick = 0, n_slip = 0;
    for (const auto &node :
         numerical.problem.equation().parts().contacts().of_tools()[0].measures().report()) {
      n_stick += node.status == ContactStatus::stick;
      n_slip += node.status == ContactStatus::slip;
    }
    check(name + ": most nodes do", friction > 0.5 ? n_stick > n_slip : n_slip > n_stick);
  }
}

/// Some nodes are nearest to the edge where a floor meets a ramp.
void check_edge() {
  for (const double friction : {0.8, 0.03, 0.}) {
    // Nodes that stick go less far.
    const std::string edge = friction > 0.5 ? "1.0045" : "1.01";
    parameters::Scene scene =
        make_curved({"extruded profile", "set Axis = 0, -1, 0\nset Direction = 1, 0, 0\nset Corners = -3, "
                                         "-0.01 ; " +
                                             edge + ", -0.01 ; 3, 1.2"},
                    friction);
    scene.solver.contact_tangent = parameters::ContactTangent::exact;
    SceneRun run(scene);
    const std::string name = "edge of a profile" + std::string(friction > 0.5  ? ", much friction"
                                                               : friction > 0. ? ", little friction"
                                                                               : ", no friction");
    check(name + ": exact tangent", tangent_error(run, 0.75, 3), 1e-6);
    unsigned int n_on_edge = 0;
    const Tool &tool = run.scene.tools()[0];
    const auto &state = run.problem.state();
    for (const auto &element : run.discretization.elements(0))
      for (const unsigned int v : element.cell->vertex_indices()) {
        dealii::Tensor<1, 3> x = element.cell->vertex(v);
        if (x[2] > 0.)
          continue;
        for (unsigned int i = 0; i < 3; ++i)
          x[i] += state.displacements(element.dofs[3 * v + i]);
        const auto projection = tool.surface().project(state.placements[0].to_tool(x));
        n_on_edge += projection.gap < 0. && projection.turning.norm() > 1. ? 1 : 0; // else it is flat
      }
    check(name + ": nodes are on it", n_on_edge > 0);
  }
}

void check_friction_laws() {
  const std::vector<std::pair<std::string, FrictionPointer>> laws{
      {"shear limited", std::make_shared<const ShearLimited>(0.1, 1.)},
      {"static-kinetic", std::make_shared<const StaticKinetic>(0.1, 0.05, 5.)},
      {"pressure dependent", std::make_shared<const PressureDependent>(0.1, 10., 0.6)}};
  for (const auto &[name, law] : laws) {
    parameters::Scene scene = make_curved({"sphere", "set Centre = 0.45, 0.55, -5\nset Radius = 5"}, 0.1);
    scene.pairs[0].friction = law;
    scene.time_stepping.initial_step = 0.1;
    SceneRun run(scene);
    check(name + " friction on a sphere: exact tangent", tangent_error(run, 0.75, 3), 1e-6);
  }
}

} // namespace

BILLET_MPI_TEST(tangent_of_scene) {

  // Slipping billet, some nodes of the mantle in contact.
  parameters::Scene billet = testing::read_shipped_scene("billet_upsetting.prm");
  testing::set_fixed_steps(billet, 20);
  SceneRun upset(billet);
  check("upset billet, slipping: exact tangent", tangent_error(upset, 0.9, 3), 1e-6);

  // Sticking block on a plane that turns and moves.
  parameters::Scene block = parameters::Scene::read(std::string(SOURCE_DIR) + "/block_on_plane.prm");
  block.time_stepping.initial_step = 0.04; // 14.4°
  SceneRun carried(block);
  check("block on a turning plane, sticking: exact tangent", tangent_error(carried, 1.2, 3), 1e-6);

  // The same, dragged over its cone.
  block.pairs[0].friction = make_coulomb(0.05);
  SceneRun dragged(block);
  check("block on a turning plane, slipping: exact tangent", tangent_error(dragged, 0.8, 3), 1e-6);

  check_curved();
  check_edge();
  check_friction_laws();
}

} // namespace tangent_of_scene_test
