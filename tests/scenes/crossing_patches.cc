// SPDX-License-Identifier: LGPL-2.1-or-later
// Nodes that slide from patch to patch of a curved tool keep frame and history of their friction: a cylinder
// as a whole, as its sectors and as Coons patches, over which a block is pulled, which turns under it, or
// both, gives the same forces and nodal tractions.
#include "materials.h"
#include "scene_run.h"

#include "../geometry/make_surface.h"

#include <deal.II/base/mpi.h>

#include <iomanip>
#include <map>
#include <sstream>

namespace crossing_patches_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;
using billet::testing::SurfacePart;
using dealii::Tensor;

namespace {

constexpr double radius = 3., sector = 4.;                   // [degrees]
constexpr int n_sectors = 20, middle_sector = n_sectors / 2; // half of them on each side of the crest
const std::string middle = "0.41, 0, -3";                    // of the axis, along y

double angle_of(const int i) { return (i - middle_sector) * sector * M_PI / 180.; }

std::vector<SurfacePart> sectors() {
  std::vector<SurfacePart> parts;
  for (int i = 0; i < n_sectors; ++i) {
    std::ostringstream lines;
    lines << std::setprecision(17) << "set Point = " << middle
          << "\nset Axis = 0, 1, 0\nset Radius = " << radius << "\nset Start = " << std::sin(angle_of(i))
          << ", 0, " << std::cos(angle_of(i)) << "\nset Sector = " << sector;
    parts.push_back({"cylinder", lines.str()});
  }
  return parts;
}

std::vector<SurfacePart> coons_patches() {
  const auto point = [](const double angle, const double y) {
    std::ostringstream text;
    text << std::setprecision(17) << 0.41 + radius * std::sin(angle) << ", " << y << ", "
         << radius * std::cos(angle) - 3.;
    return text.str();
  };
  const auto arc = [&](const double from, const double to, const double y) {
    return "arc: " + point(from, y) + " via " + point(0.5 * (from + to), y) + " to " + point(to, y);
  };
  std::vector<SurfacePart> parts;
  for (int i = 0; i < n_sectors; ++i) {
    const double from = angle_of(i), to = angle_of(i + 1);
    parts.push_back({"coons patch", "set Curves = " + arc(from, to, -2.) + " ; line: " + point(to, -2.) +
                                        " to " + point(to, 3.) + " ; " + arc(to, from, 3.) +
                                        " ; line: " + point(from, 3.) + " to " + point(from, -2.)});
  }
  return parts;
}

/// All steps of a run.
struct Course {
  std::vector<Tensor<1, 3>> forces;                 ///< by step
  std::vector<std::vector<Tensor<1, 3>>> tractions; ///< by step and node
  unsigned int n_slip = 0, n_stick = 0, n_crossings = 0;
};

Course run(parameters::Scene parameters, const std::vector<SurfacePart> &parts) {
  parameters.tools[0].surface = testing::make_surface(parts);
  SceneRun scene(parameters);
  std::map<DofIndex, Tensor<1, 3>> positions; // undeformed, by the node's first dof
  for (const auto &element : scene.discretization.elements(0))
    for (const unsigned int v : element.cell->vertex_indices())
      positions[element.dofs[std::size_t{3} * v]] = element.cell->vertex(v);
  Course course;
  std::map<DofIndex, unsigned int> patches;
  const RigidSurface &surface = scene.scene.tools()[0].surface();
  scene.finish([&](const NewtonReport &) {
    course.forces.push_back(scene.load().force);
    course.tractions.emplace_back();
    for (const auto &node : scene.problem.equation().parts().contacts().of_tools()[0].measures().report()) {
      course.tractions.back().push_back(node.traction);
      course.n_slip += node.status == ContactStatus::slip;
      course.n_stick += node.status == ContactStatus::stick;
      Tensor<1, 3> x = positions.at(node.dofs[0]);
      for (unsigned int i = 0; i < 3; ++i)
        x[i] += scene.problem.state().displacements(node.dofs[i]);
      const unsigned int patch = surface.project(scene.problem.state().placements[0].to_tool(x)).patch;
      if (node.status != ContactStatus::open) {
        course.n_crossings += patches.count(node.dofs[0]) > 0 && patches[node.dofs[0]] != patch;
        patches[node.dofs[0]] = patch;
      }
    }
  });
  return course;
}

void compare(const std::string &name, const Course &whole, const Course &pieces) {
  testing::WorstError force, traction;
  double max_force = 0., max_traction = 0.;
  for (std::size_t step = 0; step < whole.forces.size(); ++step) {
    max_force = std::max(max_force, whole.forces[step].norm());
    force.add((pieces.forces.at(step) - whole.forces[step]).norm());
    for (std::size_t i = 0; i < whole.tractions[step].size(); ++i) {
      max_traction = std::max(max_traction, whole.tractions[step][i].norm());
      traction.add((pieces.tractions.at(step).at(i) - whole.tractions[step][i]).norm());
    }
  }
  check(name + ": nodes cross seams", pieces.n_crossings > 8 && whole.n_crossings == 0);
  check(name + ": the force is the same", force.value() / max_force, 1e-9);
  check(name + ": nodal tractions are the same", traction.value() / max_traction, 1e-9);
}

} // namespace

BILLET_MPI_TEST(crossing_patches) {
  struct Motion {
    std::string name, pull, turn;
    double friction_coefficient;
  };
  for (const auto &motion : {Motion{"sliding", "0.5*max(0, t - 0.25)", "0", 0.15},
                             Motion{"turning", "0", "0.2*max(0, t - 0.25)", 0.15},
                             Motion{"sliding and turning, with more friction", "0.4*max(0, t - 0.25)",
                                    "-0.15*max(0, t - 0.25)", 0.4}}) {
    parameters::Scene scene = parameters::Scene::read(std::string(SOURCE_DIR) + "/block_on_plane.prm");
    testing::make_elastic(scene.bodies[0].material);
    scene.bodies[0].supports[0].displacement.value = {motion.pull, "0.3*(" + motion.pull + ")",
                                                      "-0.09*min(1, 4*t)"};
    scene.tools[0].motion.rotation_axis = Tensor<1, 3>({0., 1., 0.});
    scene.tools[0].motion.centre = Tensor<1, 3>({0.41, 0., -3.});
    scene.tools[0].motion.rotation_angle.value = motion.turn;
    scene.tools[0].motion.translation.value = {"0", "0", "0"};
    scene.pairs[0].friction = make_coulomb(motion.friction_coefficient);
    scene.time_stepping.end_time = 1.;
    const Course whole =
        run(scene, {{"cylinder", "set Point = " + middle + "\nset Axis = 0, 1, 0\nset Radius = 3"}});
    check(motion.name + ": nodes slide, and some stick before", whole.n_slip > 50 && whole.n_stick > 3);
    compare(motion.name + ", sectors", whole, run(scene, sectors()));
    compare(motion.name + ", Coons patches", whole, run(scene, coons_patches()));
  }
}

} // namespace crossing_patches_test
