// SPDX-License-Identifier: LGPL-2.1-or-later
// A scene is turned as a whole by R, any rotation, and moved by s, a thousand times its size, x' = s + R x:
// bodies, axes of supports, the tool and its motion. It takes the same steps and iterations with the same
// nodes in stick and slip, and has forces R f, moments R m about the tool's centre or s × R f + R m about the
// origin, and the same area and energies: a plastic block under an oblique punch with friction and under a
// roll without, and a plastic block that slides on an elastic one, with facets of each method.
//
// Only round-off differs. Positions at a distance D are rounded by ε D, ε = 2^-53. By penalties of 10 E/h and
// strains e that is 10 ε D/(e h) of the forces. Overlaps are clipped to 1e-10 of a facet, which adds as much.
// With friction no traction is augmented: that leaves slipping nodes at the very limit of friction, where
// round-off would choose whether they slip in the first iteration after it.
#include "scene_run.h"

#include "../geometry/make_surface.h"

#include <deal.II/base/mpi.h>

#include <iomanip>
#include <sstream>

namespace rotated_contact_test {

using namespace billet;
using billet::testing::check;
using billet::testing::SceneRun;
using dealii::Tensor;

namespace {

/// The scenes are 2 long, h = 0.33 and e = 0.03: 2e-10 of the forces, and what adds up a few times of it.
constexpr double distance = 2e3, tolerance = 1e-9;

struct Motion {
  Tensor<1, 3> axis{{1., 0., 0.}}, shift;
  double angle = 0.;

  Tensor<2, 3> rotation() const {
    return dealii::Physics::Transformations::Rotations::rotation_matrix_3d(axis, angle);
  }
  Tensor<1, 3> place(const Tensor<1, 3> &x) const { return shift + rotation() * x; }
};

std::string print(const double value) {
  std::ostringstream text;
  text << std::setprecision(17) << value;
  return text.str();
}
std::string print(const Tensor<1, 3> &v) { return print(v[0]) + ", " + print(v[1]) + ", " + print(v[2]); }

/// The components of the turned vector as expressions.
std::array<std::string, 3> turn(const Tensor<2, 3> &R, const std::array<std::string, 3> &vector) {
  std::array<std::string, 3> turned;
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j)
      turned[i] += (j > 0 ? " + (" : "(") + print(R[i][j]) + ")*(" + vector[j] + ")";
  return turned;
}

/// Turns and moves a scene; its tool, if it has one, gets this surface.
parameters::Scene move(parameters::Scene scene, const Motion &motion, const testing::SharedSurface &surface) {
  const Tensor<2, 3> R = motion.rotation();
  for (parameters::Body &body : scene.bodies) {
    body.mesh.rotation_axis = motion.axis;
    body.mesh.rotation_angle = motion.angle;
    body.mesh.translation = motion.shift;
    const Tensor<2, 3> columns = dealii::transpose(R);
    for (auto &support : body.supports)
      support.axes = Axes(std::array<Tensor<1, 3>, 3>{{columns[0], columns[1], columns[2]}});
  }
  for (parameters::Tool &tool : scene.tools) {
    tool.surface = surface;
    tool.motion.translation.value = turn(R, tool.motion.translation.value);
    tool.motion.centre = motion.place(tool.motion.centre);
    tool.motion.rotation_axis = R * tool.motion.rotation_axis;
  }
  return scene;
}

/// What a step leaves.
struct Step {
  double time;
  std::size_t n_iterations;
  Tensor<1, 3> force, moment;
  double area;
  std::vector<double> energies; ///< the last is the work of supports and tools
  unsigned int n_stick = 0, n_slip = 0;
};

std::vector<Step> run(const parameters::Scene &parameters) {
  SceneRun scene(parameters);
  std::vector<Step> steps;
  scene.finish([&](const NewtonReport &report) {
    const SolutionState &state = scene.problem.state();
    const ContactLoad &load = state.tool_loads.empty() ? state.body_pair_loads[0] : state.tool_loads[0];
    const EnergyLedger &e = state.energies;
    Step step;
    step.time = state.time;
    step.n_iterations = report.iterations.size();
    step.force = load.force;
    step.moment = load.moment;
    step.area = load.area;
    step.energies = {e.elastic, e.plastic, e.contact, e.friction, e.external};
    const auto reports = scene.problem.report_contacts();
    for (const auto &node : reports[0]) {
      step.n_stick += node.status == ContactStatus::stick;
      step.n_slip += node.status == ContactStatus::slip;
    }
    steps.push_back(step);
  });
  return steps;
}

void compare(const std::string &name, const parameters::Scene &scene, const Motion &motion,
             const testing::SharedSurface &surface = {}) {
  const std::vector<Step> here = run(scene), there = run(move(scene, motion, surface));
  const auto work = [](const Step &step) { return step.energies.back(); };
  bool are_same = here.size() == there.size();
  unsigned int n_stick = 0, n_slip = 0;
  double force = 0., moment = 0., whole = 0.;
  for (std::size_t i = 0; are_same && i < here.size(); ++i) {
    are_same = testing::near(there[i].time, here[i].time, 1e-6) &&
               here[i].n_iterations == there[i].n_iterations && here[i].n_stick == there[i].n_stick &&
               here[i].n_slip == there[i].n_slip;
    n_stick += here[i].n_stick;
    n_slip += here[i].n_slip;
    force = std::max(force, here[i].force.norm());
    moment = std::max(moment, here[i].moment.norm());
    whole = std::max(whole, work(here[i]));
  }
  check(name + ": nodes touch, and stick and slip where there is friction",
        n_slip > 3 && (n_stick > 3 || scene.pairs[0].friction == nullptr));
  check(name + ": same steps, iterations and contact", are_same);
  if (!are_same)
    return;
  const Tensor<2, 3> R = motion.rotation();
  // The moment of a tool is about its centre, which moves along.
  const Tensor<1, 3> arm = scene.tools.empty() ? motion.shift : Tensor<1, 3>();
  testing::WorstError forces, moments, areas, energies;
  for (std::size_t i = 0; i < here.size(); ++i) {
    const Tensor<1, 3> turned = R * here[i].force;
    forces.add((there[i].force - turned).norm() / force);
    moments.add((there[i].moment - R * here[i].moment - dealii::cross_product_3d(arm, turned)).norm() /
                (moment + arm.norm() * force));
    if (here[i].area > 0.)
      areas.add(std::abs(there[i].area / here[i].area - 1.));
    for (std::size_t e = 0; e < here[i].energies.size(); ++e)
      energies.add(std::abs(there[i].energies[e] - here[i].energies[e]) / whole);
  }
  check(name + ": forces turn along", forces.value(), tolerance);
  check(name + ": moments turn along", moments.value(), tolerance);
  check(name + ": same area", areas.value(), tolerance);
  check(name + ": same energies", energies.value(), tolerance);
}

/// A surface of this shape, whose point and direction are given in the scene that is not turned.
testing::SharedSurface make_surface(const std::string &shape, const Motion &motion, const Tensor<1, 3> &point,
                                    const std::string &direction_key, const Tensor<1, 3> &direction,
                                    const std::string &others = "") {
  return testing::make_surface(shape, "set Point = " + print(motion.place(point)) + "\nset " + direction_key +
                                          " = " + print(motion.rotation() * direction) + "\n" + others);
}

} // namespace

BILLET_MPI_TEST(rotated_contact) {
  testing::Random random;
  Motion motion;
  motion.axis = random.vector(1.);
  motion.axis /= motion.axis.norm();
  motion.angle = random(1., 5.);
  motion.shift = random.vector(1.);
  motion.shift *= distance / motion.shift.norm();

  parameters::Scene punch = testing::read_test_scene("rotated_tool.prm");
  const Tensor<1, 3> point({-1., 0., 0.02}), normal({0.06, 0.02, -1.});
  compare("punch with friction", punch, motion, make_surface("plane", motion, point, "Normal", normal));

  parameters::Scene roll = punch;
  roll.pairs[0].friction = nullptr;
  roll.pairs[0].penetration_tolerance = std::nullopt;
  roll.tools[0].motion.translation.value = {"0.25*t", "0", "-0.1*t"};
  const Tensor<1, 3> middle({-0.4, 0., 1.02}), axis({0.1, 1., 0.});
  roll.tools[0].surface = make_surface("cylinder", Motion(), middle, "Axis", axis, "set Radius = 1");
  compare("roll without friction", roll, motion,
          make_surface("cylinder", motion, middle, "Axis", axis, "set Radius = 1"));

  parameters::Scene blocks = testing::read_test_scene("rotated_bodies.prm");
  for (const auto &[facets, name] : {std::pair<FacetMethod, std::string>{FacetMethod::overlap, "overlap"},
                                     {FacetMethod::planed, "planed"},
                                     {FacetMethod::bilinear, "bilinear"}}) {
    blocks.pairs[0].facets.method.value = facets;
    compare("blocks, " + name, blocks, motion);
  }
}

} // namespace rotated_contact_test
