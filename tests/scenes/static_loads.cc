// SPDX-License-Identifier: LGPL-2.1-or-later
// Loads in static scenes against closed forms: the weight of a column, a ring under gas (Lamé), a strip that
// an end moment rolls to a full circle, a rigid face, a block on springs under forces on faces and points,
// dashpots, and loads that are switched on and off.
#include "tangent_check.h"

#include "billet/solve/unbalanced_bodies.h"

#include <deal.II/base/mpi.h>

#include <fstream>

namespace static_loads_test {

using namespace billet;
using billet::testing::SceneRun;

namespace {

using dealii::Tensor;

template <class... Values> void check(const std::string &name, const Values... values) {
  if (testing::is_first_rank())
    testing::check(name, values...);
}

struct Text {
  std::string mesh, planes, material, supports, loads, stepping;
};

parameters::Scene read(const Text &text) {
  const std::string file = "static_loads.prm";
  if (testing::is_first_rank()) {
    std::ofstream(file) << "subsection Bodies\n  subsection body\n    set Symmetry planes = " << text.planes
                        << "\n    subsection Mesh\n      set Primitive = subdivided_hyper_rectangle\n"
                        << text.mesh << "    end\n    subsection Material\n      set Law = elastic\n"
                        << text.material << "    end\n    subsection Supports\n"
                        << text.supports << "    end\n    subsection Loads\n"
                        << text.loads << "    end\n  end\nend\nsubsection Time stepping\n"
                        << text.stepping << "end\nsubsection Output\n  set Format = none\nend\n";
  }
  MPI_Barrier(MPI_COMM_WORLD);
  parameters::Scene scene = parameters::Scene::read(file);
  MPI_Barrier(MPI_COMM_WORLD);
  return scene;
}

std::string load(const std::string &name, const std::string &lines) {
  return "      subsection " + name + "\n" + lines + "      end\n";
}

std::string in_steps(const unsigned int n) {
  return "  set End time = 1\n  set Step control = fixed\n  set Initial step = " + std::to_string(1. / n) +
         "\n";
}

/// Mean displacement of the nodes within a small distance of a point. Collective.
Tensor<1, 3> displacement_at(const SceneRun &run, const Tensor<1, 3> &point) {
  std::array<double, 4> sums{};
  const Vector &u = run.problem.state().displacements;
  for (const auto &element : run.discretization.elements(0))
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      if ((Tensor<1, 3>(element.cell->vertex(a)) - point).norm() < 1e-6) {
        for (unsigned int i = 0; i < 3; ++i)
          sums[i] += u(element.dofs[3 * a + i]);
        sums[3] += 1.;
      }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 4, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  return Tensor<1, 3>({sums[0], sums[1], sums[2]}) / sums[3];
}

/// Force and moment about the origin of springs of stiffness 1 on the plane z = 0. Collective.
std::array<Tensor<1, 3>, 2> spring_reaction(const SceneRun &run) {
  std::array<double, 6> sums{};
  const Vector &u = run.problem.state().displacements;
  for (const auto &element : run.discretization.elements(0))
    for (const unsigned int f : element.cell->face_indices()) {
      const auto face = element.cell->face(f);
      if (!face->at_boundary() || face->boundary_id() != 4)
        continue;
      for (const unsigned int v : face->vertex_indices()) {
        Tensor<1, 3> force;
        for (unsigned int i = 0; i < 3; ++i)
          force[i] = 0.25 * face->measure() * u(face->vertex_dof_index(v, i));
        const Tensor<1, 3> moment = dealii::cross_product_3d(Tensor<1, 3>(face->vertex(v)), force);
        for (unsigned int i = 0; i < 3; ++i) {
          sums[i] += force[i];
          sums[3 + i] += moment[i];
        }
      }
    }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 6, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  return {Tensor<1, 3>({sums[0], sums[1], sums[2]}), Tensor<1, 3>({sums[3], sums[4], sums[5]})};
}

const std::string cube = "      set Arguments = 2, 2, 2 : 0, 0, 0 : 1, 1, 1 : true\n";
const std::string stiff = "      set Young modulus = 1e3\n      set Poisson ratio = 0.3\n";
const std::string springs =
    load("ground", "        set Type = spring\n        set Boundary ids = 4\n        set Stiffness = 1\n");

/// A column under its own weight: the shortening is w H²/(2 E).
void check_weight(const std::string &name, const std::string &density, const std::string &lines) {
  const double young = 1e4, weight = 0.01, height = 2.;
  SceneRun run(read({"      set Arguments = 1, 1, 8 : 0, 0, 0 : 1, 1, 2 : true\n", "x = 0 ; y = 0 ; z = 0",
                     "      set Young modulus = 1e4\n      set Poisson ratio = 0\n" + density, "",
                     load("weight", lines), in_steps(2)}));
  run.finish();
  const double expected = 0.5 * weight * height * height / young;
  check(name + ": shortening", std::abs(-displacement_at(run, Tensor<1, 3>({1., 1., 2.}))[2] / expected - 1.),
        1e-4);
  const auto &energies = run.problem.state().energies;
  const double elastic = weight * weight * height * height * height / (6. * young);
  // Eight linear elements miss 1/(4 · 8²) of it.
  check(name + ": elastic energy", std::abs(energies.elastic / elastic - 1.), 5e-3);
  check(name + ": work of the load", std::abs(energies.external / energies.elastic - 1.), 1e-4);
}

/// `planes` and `supports` keep the sections and the ends in their planes.
void check_ring(const std::string &name, const std::string &planes, const std::string &supports) {
  const double a = 1., b = 2., young = 1e4, nu = 0.3, p = 1.;
  SceneRun run(read({"      set Arguments = 10, 16, 1 : 0, 0, 0 : 1, 16, 0.2 : true\n"
                     "      set Positions = (1+x)*cos(pi/32*y) ; (1+x)*sin(pi/32*y) ; z\n",
                     planes, "      set Young modulus = 1e4\n      set Poisson ratio = 0.3\n", supports,
                     load("gas", "        set Type = pressure\n        set Boundary ids = 0\n"
                                 "        set Pressure = t\n"),
                     in_steps(2)}));
  run.finish();
  const auto closed_form = [&](const double r) {
    return (1. + nu) * p * a * a / (young * (b * b - a * a)) * ((1. - 2. * nu) * r + b * b / r);
  };
  for (const double r : {a, b}) {
    const double u = displacement_at(run, Tensor<1, 3>({r, 0., 0.}))[0];
    check(name + ": displacement of the " + (r == a ? "inner" : "outer") + " face",
          std::abs(u / closed_form(r) - 1.), 0.01);
  }
}

/// An end moment 2 π E I/L rolls a strip of length L to a full circle. The end is two faces high, which turn
/// unequally.
void check_roll() {
  const double length = 10., height = 0.2, young = 1e6;
  const double moment = young * std::pow(height, 3) / 12. * 2. * M_PI / length;
  SceneRun run(read({"      set Arguments = 40, 1, 2 : 0, 0, -0.1 : 10, 1, 0.1 : true\n", "",
                     "      set Young modulus = 1e6\n      set Poisson ratio = 0\n",
                     "      subsection clamp\n        set Boundary ids = 0\n      end\n",
                     load("end", "        set Type = moment\n        set Boundary ids = 1\n"
                                 "        set Moment = 0 ; -t*" +
                                     std::to_string(moment) + " ; 0\n"),
                     in_steps(40)}));
  run.finish();
  const Tensor<1, 3> tip =
      Tensor<1, 3>({length, 0., 0.}) + displacement_at(run, Tensor<1, 3>({length, 0., 0.}));
  check("roll: the end of the strip is at its beginning", tip.norm() / length, 0.01);
  const auto &energies = run.problem.state().energies;
  check("roll: elastic energy", std::abs(energies.elastic / (moment * M_PI) - 1.), 0.01);
  check("roll: work of the moment", std::abs(energies.external / energies.elastic - 1.), 0.01);
}

/// Largest distance between the displacements of the nodes of a face x = 1 and the rigid motion that fits
/// best to small displacements. The force acts on one corner. Collective.
double warping(const SceneRun &run) {
  // Displacements along x of a plane that stays plane are linear in y and z: u(y, z) at the nine nodes.
  std::array<std::array<double, 3>, 3> u{};
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j)
      u[i][j] = displacement_at(run, Tensor<1, 3>({1., 0.5 * i, 0.5 * j}))[0];
  double largest = 0.;
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j) {
      // The plane through the means of the rows and of the columns.
      double mean = 0., slope_y = 0., slope_z = 0.;
      for (unsigned int k = 0; k < 3; ++k)
        for (unsigned int l = 0; l < 3; ++l) {
          mean += u[k][l] / 9.;
          slope_y += u[k][l] * (k - 1.) / 6.;
          slope_z += u[k][l] * (l - 1.) / 6.;
        }
      largest = std::max(largest, std::abs(u[i][j] - mean - slope_y * (i - 1.) - slope_z * (j - 1.)));
    }
  return largest;
}

/// A rigid face stays plane under a force on its corner; it bears nothing itself.
void check_rigid_face() {
  const auto run_with = [](const std::string &more) {
    auto run = std::make_unique<SceneRun>(
        read({cube, "", stiff, "      subsection ground\n        set Boundary ids = 0\n      end\n",
              load("pull", "        set Type = force\n        set Point = 1, 1, 1\n"
                           "        set Place = nearest node\n        set Force = 1 ; 0 ; 0\n") +
                  more,
              in_steps(1)}));
    run->finish();
    return run;
  };
  const auto free = run_with("");
  const auto rigid = run_with(load("lid", "        set Type = rigid face\n        set Boundary ids = 1\n"));
  check("rigid face: it stays plane", warping(*rigid) / warping(*free), 0.02);
  const double pulled = displacement_at(*rigid, Tensor<1, 3>({1., 1., 1.}))[0];
  const double of_bar = 1. / 1e3;                    // F L/(E A)
  const double of_turn = 2. * 0.5 * 0.5 * 12. / 1e3; // two moments F/2 turn the end by F L/(2 E I) each
  check("rigid face: the corner follows the bar", std::abs(pulled / (of_bar + of_turn) - 1.), 0.25);
}

/// The tangents of loads on surfaces couple all nodes of their faces, also those of other ranks, and those
/// that a symmetry plane or a prescribed motion holds.
void check_tangents() {
  const std::string faces = "        set Boundary ids = 1, 5\n";
  const std::string twist = "        set Type = moment\n        set Moment = 5*t ; 8*t ; -3*t\n" + faces;
  const std::string twist_of_nodes =
      "        set Type = moment\n        set Moment = 0.5*t ; 0.8*t ; -0.3*t\n"
      "        set Nodes = at 1, 0, 0.5 ; at 1, 1, 1 ; on line 0, 0.5, 1 : 0.5, 0.5, 1\n";
  for (const auto &[name, lines] :
       {std::pair<std::string, std::string>("moment", load("twist", twist)),
        {"moment of fixed direction", load("twist", twist + "        set Follow = false\n")},
        {"moment on nodes", load("twist", twist_of_nodes)},
        {"moment of fixed direction on nodes",
         load("twist", twist_of_nodes + "        set Follow = false\n")},
        {"rigid face",
         load("lid", "        set Type = rigid face\n        set Stiffness factor = 0.01\n" + faces)},
        {"pressure by place",
         load("gas", "        set Type = pressure\n        set Pressure = 0.1*t*(1 + x*y)\n" + faces)}}) {
    SceneRun run(read({cube, "x = 0", stiff,
                       "      subsection side\n        set Boundary ids = 3\n        set Displacement = 0 ; "
                       "0.1*t ; 0\n        set Components = y\n      end\n",
                       springs + lines, in_steps(8)}));
    check(name + ": tangent", testing::tangent_error(run, 0.5, 3), 1e-6);
  }
}

/// Loads that depend on the place are integrated: linear ones are exact, with their moments.
void check_places() {
  const auto reaction = [](const std::string &lines) {
    SceneRun run(read({cube, "", stiff, "", springs + load("push", lines), in_steps(1)}));
    run.finish();
    return spring_reaction(run);
  };
  const std::string traction = "        set Type = dead traction\n        set Boundary ids = 5\n";
  const auto twist = reaction(traction + "        set Traction = 1e-3*(0.5 - y) ; 1e-3*(x - 0.5) ; 0\n");
  check("traction by place: torque", std::abs(twist[1][2] / (1e-3 / 6.) - 1.), 1e-4);
  const auto pressed = reaction("        set Type = pressure\n        set Boundary ids = 5\n"
                                "        set Pressure = 1e-3*x\n");
  check("pressure by place: force", std::abs(pressed[0][2] / -(1e-3 / 2.) - 1.), 1e-4);
  check("pressure by place: moment", std::abs(pressed[1][1] / (1e-3 / 3.) - 1.), 2e-3);
  // The integral of the distance from the middle of a unit square. At centres of 2 x 2 faces it is 7.6 %
  // less.
  const double exact = 1e-3 * (std::sqrt(2.) + std::log(1. + std::sqrt(2.))) / 6.;
  const auto around = reaction(traction + "        set Traction = 0 ; 1e-3 ; 0\n"
                                          "        set Axes = cylindrical\n"
                                          "        set Axis point = 0.5, 0.5, 0\n"
                                          "        set Axis direction = 0, 0, 1\n");
  check("traction around an axis: torque", std::abs(around[1][2] / exact - 1.), 5e-3);
}

/// A rigid face alone leaves round-off of its springs, which is no force to warn of.
void check_unloaded_rigid_face() {
  parameters::Scene scene =
      read({cube, "", stiff, "      subsection foot\n        set Boundary ids = 4\n      end\n",
            load("lid", "        set Type = rigid face\n        set Boundary ids = 5\n"), in_steps(8)});
  scene.solver.force_tolerance = 0.0051; // about the default, which for_comparison() replaces
  SceneRun run(scene);
  UnbalancedBodies bodies(run.scene, run.discretization);
  run.finish([&](const NewtonReport &) { bodies.add(run.problem); });
  check("rigid face without loads: no warning", bodies.judge().empty());
}

/// Springs of the ground carry the force, and its moment about the origin, whose arm is `at`.
void check_block(const std::string &name, const std::string &lines, const Tensor<1, 3> &force,
                 const Tensor<1, 3> &at) {
  SceneRun run(read({cube, "", stiff, "", springs + load("push", lines), in_steps(1)}));
  run.finish();
  const auto [sum, moment] = spring_reaction(run);
  check(name + ": force", (sum - force).norm() / force.norm(), 1e-5);
  check(name + ": moment", (moment - dealii::cross_product_3d(at, force)).norm() / force.norm(), 1e-3);
}

const std::string top_corners = "        set Nodes = at 0, 0, 1 ; at 1, 0, 1 ; at 0, 1, 1 ; at 1, 1, 1\n";

/// A moment on nodes is a moment without a force, whatever their places; it needs nodes off one line.
void check_moment_on_nodes() {
  for (const std::string &nodes :
       {top_corners, std::string("        set Nodes = at 0, 0, 0.5 ; at 0.5, 0, 1 ; at 1, 1, "
                                 "0.5 ; on line 0, 1, 0.5 : 1, 1, 1\n")}) {
    const Tensor<1, 3> exact({1e-6, 2e-6, -1e-6});
    SceneRun run(
        read({cube, "", stiff, "",
              springs + load("twist", "        set Type = moment\n        set Moment = 1e-6 ; 2e-6 ; "
                                      "-1e-6\n" +
                                          nodes),
              in_steps(1)}));
    run.finish();
    const auto [force, moment] = spring_reaction(run);
    check("moment on nodes: no force", force.norm() / exact.norm(), 1e-5);
    check("moment on nodes: moment", (moment - exact).norm() / exact.norm(), 1e-4);
    check("moment on nodes: work", std::abs(run.problem.state().energies.external), 1e-10);
  }
}

/// A stiff block on a spring and a dashpot: backward differences of c v + k u = F, k = c = 1. Springs and
/// dashpots on nodes have these values together. `at`: where they are.
void check_dashpot(const std::string &name, const std::string &at, const double tolerance) {
  constexpr unsigned int n = 10;
  SceneRun run(read({cube, "x = 0 ; y = 0", stiff, "",
                     load("ground", "        set Type = spring\n        set Stiffness = 1\n" + at) +
                         load("oil", "        set Type = dashpot\n        set Damping = 1\n"
                                     "        set Direction = 0, 0, 1\n" +
                                         at) +
                         load("push", "        set Type = force\n        set Boundary ids = 5\n"
                                      "        set Force = 0 ; 0 ; 1e-3\n"),
                     in_steps(n)}));
  run.finish();
  double u = 0.;
  for (unsigned int i = 0; i < n; ++i)
    u = (1e-3 / n + u) / (1. + 1. / n);
  check(name + ": displacement", std::abs(spring_reaction(run)[0][2] / u - 1.), tolerance);
}

/// A force from 0.25 until 0.5, whose value at that time fades until 0.75.
void check_times() {
  SceneRun run(read({cube, "x = 0 ; y = 0", stiff, "",
                     springs + load("push", "        set Type = force\n        set Boundary ids = 5\n"
                                            "        set Force = 0 ; 0 ; 2e-3*t\n        set From = 0.25\n"
                                            "        set Until = 0.5\n        set Fade time = 0.25\n"),
                     in_steps(8)}));
  const std::vector<double> stops = run.scene.stops();
  for (const double time : {0.25, 0.5, 0.75})
    check("times: a step ends at " + std::to_string(time).substr(0, 4),
          std::find(stops.begin(), stops.end(), time) != stops.end());
  testing::WorstError error;
  run.finish([&](const NewtonReport &) {
    const double t = run.control.time();
    const double expected = t < 0.26 ? 0. : t < 0.51 ? 2e-3 * t : std::max(0., 1e-3 * (0.75 - t) / 0.25);
    error.add(std::abs(spring_reaction(run)[0][2] - expected) / 1e-3);
  });
  check("times: force", error.value(), 1e-4);
}

/// Only springs in all directions that act all the time support a body; forces act on its points.
void check_refused() {
  const auto is_refused = [](const std::string &loads) {
    try {
      const SceneRun run(read({cube, "", stiff, "", loads, in_steps(1)}));
    } catch (const InputError &) {
      return true;
    }
    return false;
  };
  const std::string ground =
      "        set Type = spring\n        set Boundary ids = 4\n        set Stiffness = 1\n";
  check("refused: nothing to refuse", !is_refused(load("ground", ground)));
  check("refused: springs along normals only",
        is_refused(load("ground", ground + "        set Direction = normal\n")));
  check("refused: springs for a while", is_refused(load("ground", ground + "        set Until = 0.5\n")));
  check("refused: dashpots only",
        is_refused(load(
            "oil", "        set Type = dashpot\n        set Boundary ids = 4\n        set Damping = 1\n")));
  const std::string twist = "        set Type = moment\n        set Moment = 0 ; 0 ; 1\n";
  check("refused: a moment on one node",
        is_refused(springs + load("twist", twist + "        set Nodes = at 1, 1, 1\n")));
  check("refused: a moment on one line",
        is_refused(springs + load("twist", twist + "        set Nodes = on line 0, 0, 1 : 1, 1, 1\n")));
  check("not refused: a moment on nodes", !is_refused(springs + load("twist", twist + top_corners)));
  check("not refused: springs on nodes alone",
        !is_refused(load("ground", "        set Type = spring\n        set Stiffness = 1\n" + top_corners)));
  check("refused: springs on one node alone",
        is_refused(load("ground", "        set Type = spring\n        set Stiffness = 1\n        set Nodes = "
                                  "at 1, 1, 1\n")));
  check("refused: springs along the normals of nodes",
        is_refused(
            load("ground", "        set Type = spring\n        set Stiffness = 1\n        set Direction = "
                           "normal\n" +
                               top_corners)));
  check("refused: a point outside",
        is_refused(springs + load("push", "        set Type = force\n        set Point = 0.5, 0.5, 1.1\n"
                                          "        set Force = 0 ; 0 ; 1\n")));
  check("refused: a point far from all nodes",
        is_refused(springs + load("push",
                                  "        set Type = force\n        set Point = 0.5, 0.5, 2\n"
                                  "        set Force = 0 ; 0 ; 1\n        set Place = nearest node\n")));
}

} // namespace

BILLET_MPI_TEST(static_loads) {
  check_weight("gravity", "      set Density = 1e-3\n",
               "        set Type = acceleration\n        set Acceleration = 0 ; 0 ; -10*t\n");
  check_rigid_face();
  check_block(
      "force on a material point",
      "        set Type = force\n        set Point = 0.3, 0.4, 0.6\n        set Force = 1e-5 ; 0 ; 2e-5\n",
      Tensor<1, 3>({1e-5, 0., 2e-5}), Tensor<1, 3>({0.3, 0.4, 0.6}));
  check_block(
      "force on the nearest node",
      "        set Type = force\n        set Point = 0.97, 0.96, 1\n        set Place = nearest node\n"
      "        set Force = 1e-5 ; 0 ; 2e-5\n",
      Tensor<1, 3>({1e-5, 0., 2e-5}), Tensor<1, 3>({1., 1., 1.}));
  check_places();
  check_moment_on_nodes();
  if (testing::n_ranks() > 1)
    return; // the others are assembled in the same way
  check_weight("body force", "", "        set Type = body force\n        set Body force = 0 ; 0 ; -0.01*t\n");
  check_ring("ring", "x = 0 ; y = 0 ; z = 0 ; z = 0.2", "");
  check_ring(
      "ring in cylindrical axes", "",
      "      subsection sections\n        set Boundary ids = 2, 3\n        set Components = y\n"
      "        set Axes = cylindrical\n        set Axis point = 0, 0, 1\n"
      "        set Axis direction = 0, 0, 2\n      end\n"
      "      subsection ends\n        set Boundary ids = 4, 5\n        set Components = z\n      end\n");
  check_ring("ring in local axes", "x = 0 ; z = 0 ; z = 0.2",
             "      subsection section\n        set Boundary ids = 2\n        set Components = x\n"
             "        set Axes = local\n        set First axis = 0, 1, 0\n"
             "        set Second axis = 1, 1, 0\n      end\n");
  check_roll();
  check_unloaded_rigid_face();
  check_tangents();
  check_block("force on a face",
              "        set Type = force\n        set Boundary ids = 5\n        set Force = 1e-5 ; 0 ; 2e-5\n",
              Tensor<1, 3>({1e-5, 0., 2e-5}), Tensor<1, 3>({0.5, 0.5, 1.}));
  check_block("dead traction",
              "        set Type = dead traction\n        set Boundary ids = 5\n"
              "        set Traction = 0 ; 1e-5 ; 2e-5\n",
              Tensor<1, 3>({0., 1e-5, 2e-5}), Tensor<1, 3>({0.5, 0.5, 1.}));
  check_dashpot("dashpot", "        set Boundary ids = 4\n", 1e-4);
  // The block is dented at its corners.
  check_dashpot("dashpot on nodes", "        set Nodes = at 0, 0, 0 ; at 1, 0, 0 ; at 0, 1, 0 ; at 1, 1, 0\n",
                1e-2);
  check_times();
  check_refused();
}

} // namespace static_loads_test
