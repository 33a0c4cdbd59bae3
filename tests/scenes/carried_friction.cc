// SPDX-License-Identifier: LGPL-2.1-or-later
// A block that sticks to a plane keeps its tractions, in the frame of the plane, while both turn by 360° and
// move: about the plane's normal (which the print of Bittencourt & Creus' frame misses) and about an axis in
// the plane. A full cycle of sticking shear leaves no traction at any node.
#include "materials.h"
#include "scene_run.h"

#include <deal.II/base/mpi.h>
#include <deal.II/physics/transformations.h>

namespace carried_friction_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;
using dealii::Tensor;

namespace {

void carry(parameters::Scene parameters, const std::string &name, const Tensor<1, 3> &axis) {
  parameters.tools[0].motion.rotation_axis = axis;
  SceneRun scene(parameters);
  std::vector<Tensor<1, 3>> tractions;
  Tensor<1, 3> force, moment;
  testing::WorstError traction_error, force_error, plastic_error;
  double plastic = 0.;
  bool all_stick = true;
  scene.finish([&](const NewtonReport &) {
    if (scene.control.time() < 1.)
      return;
    const Placement placement = scene.problem.state().placements[0];
    const auto back = dealii::transpose(placement.rotation);
    std::vector<Tensor<1, 3>> now;
    for (const auto &node : scene.problem.equation().parts().contacts().of_tools()[0].measures().report()) {
      now.push_back(back * node.traction);
      all_stick = all_stick && node.status == ContactStatus::stick;
    }
    if (tractions.empty()) {
      tractions = now;
      force = back * scene.load().force;
      moment = back * scene.load().moment;
      plastic = scene.problem.state().energies.plastic;
    }
    for (std::size_t i = 0; i < now.size(); ++i)
      traction_error.add((now[i] - tractions[i]).norm() / tractions[i].norm());
    force_error.add((back * scene.load().force - force).norm() / force.norm());
    force_error.add((back * scene.load().moment - moment).norm() / moment.norm());
    plastic_error.add(std::abs(scene.problem.state().energies.plastic / plastic - 1.));
  });
  check(name + ": all nodes stick", all_stick);
  check(name + ": there is friction to carry", std::hypot(force[0], force[1]) > 0.01 * force[2]);
  check(name + ": nodal tractions turn with the plane", traction_error.value(), 1e-9);
  check(name + ": force and moment turn with the plane", force_error.value(), 1e-9);
  check(name + ": no plastic work is done", plastic_error.value(), 1e-10);
}

/// Sheared to one side, to the other and back while it sticks, an elastic block keeps the tractions that it
/// was pressed with, at every node; across the normal those are none if it does not widen.
void cycle(parameters::Scene parameters, const double poisson_ratio) {
  testing::make_elastic(parameters.bodies[0].material);
  testing::set_poisson_ratio(parameters.bodies[0].material, poisson_ratio);
  parameters.amplitudes[0].times = {0., 0.25};
  parameters.time_stepping.end_time = 1.;
  parameters.time_stepping.initial_step = 0.05;
  parameters.bodies[0].supports[0].displacement.value = {"0.001*sin(2*pi*max(0, t - 0.25)/0.75)", "0",
                                                         "-0.01*press"};
  parameters.tools[0].motion.rotation_angle.value = "0";
  parameters.tools[0].motion.translation.value = {"0", "0", "0"};
  SceneRun scene(parameters);
  std::vector<Tensor<1, 3>> pressed;
  double sheared = 0.;
  bool all_stick = true;
  testing::WorstError left;
  scene.finish([&](const NewtonReport &) {
    if (scene.control.time() < 0.25)
      return;
    const auto report = scene.problem.equation().parts().contacts().of_tools()[0].measures().report();
    const bool is_first = pressed.empty();
    for (std::size_t i = 0; i < report.size(); ++i) {
      all_stick = all_stick && report[i].status == ContactStatus::stick;
      if (is_first)
        pressed.push_back(report[i].traction);
      sheared = std::max(sheared, (report[i].traction - pressed[i]).norm());
      if (scene.control.is_finished())
        left.add((report[i].traction - pressed[i]).norm() / sheared);
      if (scene.control.is_finished() && poisson_ratio == 0.)
        left.add(std::hypot(report[i].traction[0], report[i].traction[1]) / sheared);
    }
  });
  const std::string name =
      std::string("sticking cycle of a block that ") + (poisson_ratio > 0. ? "widens" : "does not widen");
  check(name + ": all nodes stick", all_stick && pressed.size() == 9);
  check(name + ": shear is felt", sheared > 0.01 * pressed[0].norm());
  check(name + ": no traction of it is left at any node", left.value(), 1e-9);
}

} // namespace

BILLET_MPI_TEST(carried_friction) {
  parameters::Scene about_normal = parameters::Scene::read(std::string(SOURCE_DIR) + "/block_on_plane.prm");
  about_normal.time_stepping.initial_step = 0.04; // 14.4°
  Tensor<1, 3> x, z;
  x[0] = z[2] = 1.;
  carry(about_normal, "spin about the normal", z);

  parameters::Scene about_x = about_normal;
  about_x.bodies[0].supports[0].displacement.value = {
      "0.001*press + 3*move",
      "0.2 + cos(turn)*(y + 0.0005*press - 0.2) - sin(turn)*(z - 0.01*press) - y + move",
      "sin(turn)*(y + 0.0005*press - 0.2) + cos(turn)*(z - 0.01*press) - z + 2*move"};
  carry(about_x, "turn about an axis in the plane", x);

  for (const double poisson_ratio : {0.3, 0.})
    cycle(about_normal, poisson_ratio);
}

} // namespace carried_friction_test
