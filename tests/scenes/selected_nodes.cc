// SPDX-License-Identifier: LGPL-2.1-or-later
// Supports and forces on selected nodes: a block on three points, 3-2-1, under uniform tension, and a shaft
// whose end turns about its axis; springs that take turns hold a block.
#include "restart_run.h"

#include <deal.II/base/mpi.h>

#include <cmath>
#include <fstream>

namespace selected_nodes_test {

using namespace billet;
using billet::testing::SceneRun;

namespace {

template <class... Values> void check(const std::string &name, const Values... values) {
  if (testing::is_first_rank())
    testing::check(name, values...);
}

/// A mesh file of two bricks along x, with node sets of an edge and of a corner.
void write_mesh() {
  std::ofstream file("selected_nodes.inp");
  file << "*NODE\n";
  for (unsigned int n = 0; n < 12; ++n)
    file << n + 1 << ", " << n % 3 << ", " << n / 3 % 2 << ", " << n / 6 << "\n";
  file << "*ELEMENT, TYPE=C3D8\n1, 1, 2, 5, 4, 7, 8, 11, 10\n2, 2, 3, 6, 5, 8, 9, 12, 11\n"
          "*NSET, NSET=Edge\n1, 4\n*NSET, NSET=Far\n3, 6, 9, 12\n";
}

parameters::Scene read(const std::string &mesh, const std::string &supports, const std::string &loads) {
  const std::string file = "selected_nodes.prm";
  if (testing::is_first_rank()) {
    write_mesh();
    std::ofstream(file) << "subsection Bodies\n  subsection body\n    subsection Mesh\n"
                        << mesh
                        << "    end\n    subsection Material\n      set Young modulus = 1e4\n"
                           "      set Poisson ratio = 0.25\n    end\n    subsection Supports\n"
                        << supports << "    end\n    subsection Loads\n"
                        << loads
                        << "    end\n  end\nend\nsubsection Time stepping\n  set End time = 1\n"
                           "  set Step control = fixed\n  set Initial step = 0.1\nend\n"
                           "subsection Output\n  set Format = none\nend\n";
  }
  MPI_Barrier(MPI_COMM_WORLD);
  parameters::Scene scene = parameters::Scene::read(file);
  MPI_Barrier(MPI_COMM_WORLD);
  scene.solver.force_tolerance = 1e-10;
  return scene;
}

std::string entry(const std::string &name, const std::string &settings) {
  return "      subsection " + name + "\n" + settings + "      end\n";
}

const std::string from_file = "      set Source = file\n      set File = selected_nodes.inp\n"
                              "      set Refinements = 1\n";

dealii::Tensor<1, 3> reaction(const SceneRun &run, const std::string &name) {
  const std::vector<NamedSupport> supports = named_supports(run.scene);
  for (std::size_t i = 0; i < supports.size(); ++i)
    if (supports[i].name == "support " + name)
      return run.problem.reactions().of_supports[i].force;
  throw std::logic_error("no support " + name);
}

/// Greatest displacement in a direction of the nodes that a condition selects. Collective.
template <class Condition>
double greatest(const SceneRun &run, const unsigned int component, const Condition &selects) {
  double largest = 0.;
  const Vector &u = run.problem.state().displacements;
  for (const auto &element : run.discretization.elements(0))
    for (unsigned int a = 0; a < n_element_nodes; ++a)
      if (selects(element.cell->vertex(a)))
        largest = std::max(largest, std::abs(u(element.dofs[3 * a + component])));
  return dealii::Utilities::MPI::max(largest, MPI_COMM_WORLD);
}

/// Three points hold a block without a force: it strains uniformly.
void check_three_points() {
  SceneRun run(
      read(from_file,
           entry("three", "        set Nodes = at 0, 0, 0\n") +
               entry("two", "        set Nodes = at 0, 0, 1\n        set Components = x, y\n") +
               entry("one", "        set Nodes = at 0, 1, 0\n        set Components = x\n"),
           entry("pull", "        set Type = dead traction\n        set Boundary ids = 0\n"
                         "        set Traction = 0 ; 0 ; if(z > 0.999, 10*t, if(z < 0.001, -10*t, 0))\n")));
  run.finish([](const NewtonReport &) {});
  const double stretch = greatest(run, 2, [](const auto &x) { return x[2] > 0.999; });
  check("three points: no reactions", reaction(run, "three").norm() + reaction(run, "two").norm(), 1e-7);
  check("three points: uniform strain", std::abs(stretch / 1e-3 - 1.), 2e-3);
  check("three points: nodes between those that are held are free",
        greatest(run, 0, [](const auto &x) { return x[0] < 0.001; }), 1e-7);
}

/// A set and a line of the mesh file, refined once.
void check_sets() {
  SceneRun run(read(from_file,
                    entry("edge", "        set Nodes = set edge\n") +
                        entry("line", "        set Nodes = on line 0, 0, 1 : 0, 1, 1\n"),
                    entry("pull", "        set Type = force\n        set Nodes = set Far\n"
                                  "        set Force = 3*t ; 0 ; 0\n")));
  run.finish([](const NewtonReport &) {});
  const auto is_of_edge = [](const auto &x) { return x[0] < 1e-3 && x[2] < 1e-3; };
  check("set: the middle of its edge is held, too", greatest(run, 0, is_of_edge), 1e-12);
  check("set: the edge and the line bear half of the force each",
        std::abs(reaction(run, "edge")[0] / -1.5 - 1.) + std::abs(reaction(run, "line")[0] / -1.5 - 1.),
        1e-6);
}

/// The axis of a solid shaft is left out by supports about it.
void check_shaft() {
  SceneRun run(
      read("      set Source = extruded primitive\n      set Primitive = hyper_ball\n"
           "      set Arguments = 0, 0 : 1\n      set Refinements = 1\n      set Height = 4\n"
           "      set Layers = 2\n",
           entry("foot", "        set Boundary ids = 1\n") +
               entry("head", "        set Boundary ids = 2\n        set Axes = cylindrical\n"
                             "        set Axis point = 0, 0, 0\n        set Axis direction = 0, 0, 1\n"
                             "        set Components = y\n"
                             "        set Displacement = 0.001*sqrt(x^2 + y^2)*t\n"),
           ""));
  run.finish([](const NewtonReport &) {});
  const auto is_on_axis = [](const auto &x) { return x[0] * x[0] + x[1] * x[1] < 1e-6; };
  check("shaft: the axis stays", greatest(run, 0, is_on_axis), 1e-9);
  check("shaft: no force across", reaction(run, "head").norm(), 1e-6);
}

/// Springs that begin and end hold a body as long as one of them acts.
void check_springs() {
  const auto spring = [](const std::string &name, const std::string &times) {
    return entry(
        name, "        set Type = spring\n        set Boundary ids = 0\n        set Stiffness = 5\n" + times);
  };
  const std::string mesh =
      "      set Primitive = subdivided_hyper_rectangle\n      set Arguments = 3, 1, 1 : 0, 0, 0 : 1, 1, 1\n";
  const std::string push = entry("push", "        set Type = force\n        set Boundary ids = 0\n"
                                         "        set Force = 0 ; 0 ; 0.1*t\n");
  const auto run_with = [&](const std::string &loads) {
    SceneRun run(read(mesh, "", loads + push));
    run.finish([](const NewtonReport &) {});
    return greatest(run, 2, [](const auto &) { return true; });
  };
  check("springs: the second one holds in the end",
        std::abs(run_with(spring("first", "        set Until = 0.5\n") +
                          spring("second", "        set From = 0.4\n")) /
                     (0.1 / 5.) -
                 1.),
        1e-2);
  std::string message;
  try {
    run_with(spring("first", "        set Until = 0.5\n"));
  } catch (const InputError &error) {
    message = error.what();
  }
  check("springs: the time from which none holds",
        message.find("no support from time 0.5") != std::string::npos);
}

} // namespace

BILLET_MPI_TEST(selected_nodes) {
  check_three_points();
  check_sets();
  check_shaft();
  check_springs();
}

} // namespace selected_nodes_test
