// SPDX-License-Identifier: LGPL-2.1-or-later
// A block that sticks to a plane keeps its tractions, in the frame of the plane, while both turn by 360° and
// move: about the plane's normal (which the print of Bittencourt & Creus' frame misses) and about an axis in
// the plane. A full cycle of sticking shear leaves no traction.
#include "scene_run.h"

#include <deal.II/base/mpi.h>
#include <deal.II/physics/transformations.h>

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
    for (const auto &node : scene.problem.contacts()[0].report()) {
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

} // namespace

int main(int argc, char *argv[]) {
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const parameters::Scene about_normal =
      parameters::Scene::read(std::string(SOURCE_DIR) + "/block_on_plane.prm");
  Tensor<1, 3> x, z;
  x[0] = z[2] = 1.;
  carry(about_normal, "spin about the normal", z);

  parameters::Scene about_x = about_normal;
  about_x.bodies[0].supports[0].displacement.value = {
      "0.001*press + 3*move",
      "0.2 + cos(turn)*(y + 0.0005*press - 0.2) - sin(turn)*(z - 0.01*press) - y + move",
      "sin(turn)*(y + 0.0005*press - 0.2) + cos(turn)*(z - 0.01*press) - z + 2*move"};
  carry(about_x, "turn about an axis in the plane", x);

  // Shear out and back while sticking: in an elastic block nothing is left.
  parameters::Scene cycle = about_normal;
  cycle.bodies[0].material.law = parameters::Material::Law::elastic;
  cycle.amplitudes[1].values = {0., 0.001};
  cycle.amplitudes[1].times = {0.25, 0.5};
  cycle.amplitudes.push_back(cycle.amplitudes[1]);
  cycle.amplitudes.back().name = "back";
  cycle.amplitudes.back().times = {0.5, 1.};
  cycle.time_stepping.end_time = 1.;
  cycle.amplitudes[0].times = {0., 0.25};
  cycle.bodies[0].supports[0].displacement.value = {"turn - back", "0", "-0.01*press"};
  cycle.tools[0].motion.rotation_angle.value = "0";
  cycle.tools[0].motion.translation.value = {"0", "0", "0"};
  SceneRun scene(cycle);
  double pressed = 0., sheared = 0.;
  scene.finish([&](const NewtonReport &) {
    if (scene.control.time() == 0.25)
      pressed = scene.load().force.norm();
    if (scene.control.time() == 0.5)
      sheared = std::abs(scene.load().force[0]);
  });
  check("sticking cycle: shear is felt", sheared > 0.01 * pressed);
  check("sticking cycle: no force is left", std::abs(scene.load().force[0]) / sheared, 1e-9);
  return billet::testing::exit_code();
}
