// SPDX-License-Identifier: LGPL-2.1-or-later
// Errors of the mesh. A bar of n bricks under its own weight, u = f (L x − x²/2)/E: finer bricks add 1/(4n²)
// to the work of the load. The estimate has n − 1 faces between the n bricks, and the last brick, whose
// stress is half of the jump, gives way half as much: it is (n − 5/4)/n of that, over the work of the bricks,
// 1 − 1/(4n²) of the exact one. So it is in one step or many, on one rank or several. Each brick has its
// share. A bar that is pulled has no error.
#include "scene_run.h"

#include "billet/solve/mesh_errors.h"

#include <deal.II/base/mpi.h>

#include <fstream>

using namespace billet;
using billet::testing::SceneRun;

namespace {

parameters::Scene read(const unsigned int n, const unsigned int n_steps, const std::string &load) {
  const std::string file = "mesh_errors.prm";
  if (testing::is_first_rank())
    std::ofstream(file) << "subsection Bodies\n  subsection bar\n    subsection Mesh\n"
                           "      set Primitive = subdivided_hyper_rectangle\n      set Arguments = "
                        << n
                        << ", 1, 1 : 0, 0, 0 : 10, 1, 1\n    end\n    subsection Material\n"
                           "      set Young modulus = 1000\n      set Poisson ratio = 0\n    end\n"
                           "    set Symmetry planes = x = 0 ; y = 0 ; z = 0\n"
                        << load << "  end\nend\nsubsection Time stepping\n  set End time = 1\nend\n";
  MPI_Barrier(MPI_COMM_WORLD);
  parameters::Scene scene = parameters::Scene::read(file);
  testing::set_fixed_steps(scene, n_steps);
  return scene;
}

MeshErrors watch(SceneRun &run) {
  MeshErrors errors(run.discretization);
  errors.add(run.problem);
  run.finish([&](const NewtonReport &) { errors.add(run.problem); });
  return errors;
}

double error_of(const unsigned int n, const unsigned int n_steps, const std::string &load) {
  SceneRun run(read(n, n_steps, load));
  return watch(run).error();
}

/// Prints on one rank: all have the same numbers.
void check(const std::string &name, const double error, const double tolerance) {
  if (testing::is_first_rank())
    testing::check(name, error, tolerance);
}

} // namespace

int main(int argc, char *argv[]) {
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const std::string weight = "    subsection Loads\n      subsection weight\n        set Type = body force\n"
                             "        set Body force = 1e-6*t ; 0 ; 0\n      end\n    end\n",
                    pull = "    subsection Supports\n      subsection end\n        set Boundary ids = 1\n"
                           "        set Displacement = t ; 0 ; 0\n      end\n    end\n";
  for (const unsigned int n : {4U, 8U}) {
    const double exact = (n - 1.25) / n / (4. * n * n - 1.);
    check(std::to_string(n) + " bricks, one step", std::abs(error_of(n, 1, weight) / exact - 1.), 1e-3);
    check(std::to_string(n) + " bricks, ten steps", std::abs(error_of(n, 10, weight) / exact - 1.), 1e-3);
  }
  SceneRun run(read(4, 1, weight));
  const MeshErrors errors = watch(run);
  double mean = 0.;
  for (std::size_t e = 0; e < run.discretization.elements(0).size(); ++e)
    mean += errors.of_element(0, e) / 4.; // bricks of one size
  mean = dealii::Utilities::MPI::sum(mean, MPI_COMM_WORLD);
  check("the mean over elements", std::abs(mean / errors.error() - 1.), 1e-12);
  check("pulled", error_of(6, 3, pull), 1e-12);
  return dealii::Utilities::MPI::max(testing::exit_code(), MPI_COMM_WORLD);
}
