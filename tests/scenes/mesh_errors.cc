// SPDX-License-Identifier: LGPL-2.1-or-later
// Errors of the mesh. A bar of n bricks under its own weight, u = f (L x − x²/2)/E: finer bricks add 1/(4n²)
// to the work of the load. The estimate has n − 1 faces between the n bricks, and the last brick, whose
// stress is half of the jump, gives way half as much: it is (n − 5/4)/n of that, over the work of the bricks,
// 1 − 1/(4n²) of the exact one. So it is in one step or many, in intervals of one or more, on one rank or
// several. Each brick has its share. A bar that is pulled has no error. A wave within an interval leaves
// none. A round bar of 16 or 32 facets that is pulled lacks the segments of its section, to second order in
// their angle: the error of its geometry. A layer of one brick whose nodes are all held hides its error.
#include "scene_run.h"

#include "billet/solve/mesh_errors.h"

#include <deal.II/base/mpi.h>

#include <fstream>

namespace mesh_errors_test {

using namespace billet;
using billet::testing::SceneRun;

namespace {

parameters::Scene read(const unsigned int n, const unsigned int n_steps, const std::string &load,
                       const unsigned int n_across = 1) {
  const std::string file = "mesh_errors.prm";
  if (testing::is_first_rank())
    std::ofstream(file) << "subsection Bodies\n  subsection bar\n    subsection Mesh\n"
                           "      set Primitive = subdivided_hyper_rectangle\n      set Arguments = "
                        << n << ", " << n_across
                        << ", 1 : 0, 0, 0 : 10, 1, 1\n    end\n    subsection Material\n"
                           "      set Young modulus = 1000\n      set Poisson ratio = 0\n    end\n"
                           "    set Symmetry planes = x = 0 ; y = 0 ; z = 0\n"
                        << load << "  end\nend\nsubsection Time stepping\n  set End time = 1\nend\n";
  MPI_Barrier(MPI_COMM_WORLD);
  parameters::Scene scene = parameters::Scene::read(file);
  testing::set_fixed_steps(scene, n_steps);
  return scene;
}

MeshErrors watch(SceneRun &run, const unsigned int steps_in_interval = 1) {
  MeshErrors errors(run.scene, run.discretization);
  errors.add(run.problem);
  unsigned int step = 0;
  run.finish([&](const NewtonReport &) { errors.add(run.problem, ++step % steps_in_interval == 0); });
  return errors;
}

double error_of(const unsigned int n, const unsigned int n_steps, const std::string &load,
                const unsigned int steps_in_interval = 1) {
  SceneRun run(read(n, n_steps, load));
  return watch(run, steps_in_interval).error();
}

/// Returns the error of the geometry of a round bar that is pulled, of 4·2^n facets around.
double geometry_error_of(const unsigned int n_refinements) {
  const std::string file = "mesh_errors_round.prm";
  if (testing::is_first_rank())
    std::ofstream(file) << "subsection Bodies\n  subsection bar\n    subsection Mesh\n"
                           "      set Source = extruded primitive\n      set Primitive = hyper_ball\n"
                           "      set Arguments = 0, 0 : 1\n      set Height = 4\n      set Layers = 2\n"
                           "      set Refinements = "
                        << n_refinements
                        << "\n    end\n    subsection Material\n      set Young modulus = 1000\n"
                           "      set Poisson ratio = 0\n    end\n    subsection Supports\n"
                           "      subsection foot\n        set Boundary ids = 1\n      end\n"
                           "      subsection end\n        set Boundary ids = 2\n"
                           "        set Displacement = 0 ; 0 ; 0.01*t\n      end\n    end\n  end\nend\n"
                           "subsection Time stepping\n  set End time = 1\nend\n";
  MPI_Barrier(MPI_COMM_WORLD);
  parameters::Scene scene = parameters::Scene::read(file);
  testing::set_fixed_steps(scene, 2);
  SceneRun run(scene);
  return watch(run).geometry_error();
}

/// Prints on one rank: all have the same numbers.
void check(const std::string &name, const double error, const double tolerance) {
  if (testing::is_first_rank())
    testing::check(name, error, tolerance);
}

} // namespace

BILLET_MPI_TEST(mesh_errors) {
  const std::string weight = "    subsection Loads\n      subsection weight\n        set Type = body force\n"
                             "        set Body force = 1e-6*t ; 0 ; 0\n      end\n    end\n",
                    pull = "    subsection Supports\n      subsection end\n        set Boundary ids = 1\n"
                           "        set Displacement = t ; 0 ; 0\n      end\n    end\n";
  for (const unsigned int n : {4U, 8U}) {
    const double exact = (n - 1.25) / n / (4. * n * n - 1.);
    check(std::to_string(n) + " bricks, one step", std::abs(error_of(n, 1, weight) / exact - 1.), 1e-3);
    check(std::to_string(n) + " bricks, ten steps", std::abs(error_of(n, 10, weight) / exact - 1.), 1e-3);
    check(std::to_string(n) + " bricks, intervals of five steps",
          std::abs(error_of(n, 10, weight, 5) / exact - 1.), 1e-3);
  }
  const std::string shaken = "    subsection Supports\n      subsection end\n        set Boundary ids = 1\n"
                             "        set Displacement = 1e-4*t ; 0 ; 0\n      end\n    end\n"
                             "    subsection Loads\n      subsection wave\n        set Type = body force\n"
                             "        set Body force = 1e-4*sin(2*pi*t) ; 0 ; 0\n      end\n    end\n";
  check("a wave within an interval", error_of(4, 10, shaken, 10), 1e-8);
  check("a wave over intervals", error_of(4, 10, shaken) > 1e-5 ? 0. : 1., 0.5);
  SceneRun run(read(4, 1, weight));
  const MeshErrors errors = watch(run);
  double mean = 0.;
  for (std::size_t e = 0; e < run.discretization.elements(0).size(); ++e)
    mean += errors.of_element(0, e) / 4.; // bricks of one size
  mean = dealii::Utilities::MPI::sum(mean, MPI_COMM_WORLD);
  check("the mean over elements", std::abs(mean / errors.error() - 1.), 1e-12);
  check("pulled", error_of(6, 3, pull), 1e-12);
  check("flat facets", errors.geometry_error(), 1e-12);
  const std::string bonded = "    subsection Supports\n      subsection root\n        set Boundary ids = 0\n"
                             "      end\n      subsection end\n        set Boundary ids = 1\n"
                             "        set Displacement = t ; 0 ; 0\n      end\n    end\n";
  for (const unsigned int n : {1U, 2U}) {
    SceneRun layer(read(n, 1, bonded, 4));
    check(std::to_string(n) + " bricks between bonded faces",
          watch(layer).sees_variation() == (n > 1) ? 0. : 1., 0.5);
  }
  for (const unsigned int n_refinements : {2U, 3U}) {
    const double angle = 2. * dealii::numbers::PI / std::pow(2., n_refinements + 2),
                 lacking = angle / std::sin(angle) - 1.; // circle over polygon
    check("a polygon of angle " + std::to_string(angle),
          std::abs(geometry_error_of(n_refinements) / lacking - 1.), 0.1 * angle * angle);
  }
}

} // namespace mesh_errors_test
