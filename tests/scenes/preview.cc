// SPDX-License-Identifier: LGPL-2.1-or-later
// What a preview shows beside bodies and tools: the arrows of supports and of loads have the values of the
// scene, and stand where it says; tools are where their motion ends. The same on several ranks.
#include "scene_run.h"

#include "billet/output/field_writer.h"
#include "billet/output/preview_grids.h"
#include "billet/output/snapshot_grids.h"

#include <deal.II/base/mpi.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace preview_test {

using namespace billet;
using billet::testing::SceneRun;
using dealii::Tensor;

namespace {

template <class... Values> void check(const std::string &name, const Values... values) {
  if (testing::is_first_rank())
    testing::check(name, values...);
}

/// A cube of size 2 whose bottom moves down by 0.1 while a pressure of 5 acts on its top; a die comes down
/// from z = 3 to z = 2.5.
const std::string text = R"(
subsection Bodies
  subsection cube
    subsection Mesh
      set Primitive = subdivided_hyper_rectangle
      set Arguments = 2, 2, 2 : 0, 0, 0 : 2, 2, 2 : true
    end
    subsection Material
      set Law           = elastic
      set Young modulus = 1000
    end
    subsection Supports
      subsection floor
        set Boundary ids = 4
        set Displacement = 0 ; 0 ; -0.1*t
      end
    end
    subsection Loads
      subsection gas
        set Type         = pressure
        set Boundary ids = 5
        set Pressure     = 5*t
      end
      subsection pull
        set Type         = force
        set Boundary ids = 0
        set Force        = -0.001*sin(pi*t) ; 0 ; 0
      end
    end
  end
end
subsection Tools
  subsection die
    subsection Surfaces
      subsection face
        set Shape  = plane
        set Point  = 0, 0, 3
        set Normal = 0, 0, -1
      end
    end
    subsection Motion
      set Translation = 0 ; 0 ; -0.5*t
    end
  end
end
subsection Contact pairs
  subsection top
    set Body         = cube
    set Boundary ids = 5
    set Tool         = die
  end
end
subsection Time stepping
  set End time = 1
end
)";

/// Returns the arrows of all ranks.
std::vector<Arrow> gather(const std::vector<Arrow> &own) {
  std::vector<std::array<double, 9>> numbers;
  for (const Arrow &arrow : own) {
    std::array<double, 9> row{};
    for (unsigned int i = 0; i < 3; ++i) {
      row[i] = arrow.from[i];
      row[3 + i] = arrow.to[i];
      row[6 + i] = arrow.value[i];
    }
    numbers.push_back(row);
  }
  std::vector<Arrow> all;
  for (const auto &of_rank : dealii::Utilities::MPI::all_gather(MPI_COMM_WORLD, numbers))
    for (const auto &row : of_rank)
      all.push_back({Tensor<1, 3>({row[0], row[1], row[2]}), Tensor<1, 3>({row[3], row[4], row[5]}),
                     Tensor<1, 3>({row[6], row[7], row[8]})});
  return all;
}

std::string read_text(const std::string &file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void check_supports(const SceneRun &run) {
  const auto arrows = gather(find_support_arrows(run.scene, run.discretization, 0));
  check("supports: three for each of nine nodes", arrows.size() == 27);
  const double radius = std::sqrt(3.);
  unsigned int n_moving = 0;
  testing::WorstError moving, fixed;
  bool are_outside = true;
  for (const Arrow &arrow : arrows)
    if (arrow.value.norm() > 0.) {
      ++n_moving;
      moving.add((arrow.value - Tensor<1, 3>({0., 0., -0.1})).norm());
      moving.add((arrow.to - arrow.from - arrow.value).norm());
      moving.add(std::abs(arrow.from[2]));
    } else {
      const Tensor<1, 3> centre({1., 1., 1.});
      fixed.add(std::abs(arrow.to[2]));
      fixed.add(std::abs((arrow.to - arrow.from).norm() / radius - 0.06));
      are_outside = are_outside && (arrow.from - centre).norm() > (arrow.to - centre).norm();
    }
  check("supports: nine move", n_moving == 9);
  check("supports: by what the scene says", moving.value(), 1e-12);
  check("supports: others point at their nodes", fixed.value(), 1e-12);
  check("supports: from outside", are_outside);
}

void check_loads(const SceneRun &run) {
  const std::vector<LoadArrows> loads = find_load_arrows(run.scene, run.discretization);
  check("loads: each has its own arrows",
        loads.size() == 2 && loads[0].name == "gas of cube" && loads[1].name == "pull of cube");
  const auto arrows = gather(loads[0].arrows);
  check("loads: at the time of the largest", std::abs(loads[0].time - 1.), 1e-12);
  check("loads: at the nodes of the face", arrows.size() == 9);
  Tensor<1, 3> sum;
  testing::WorstError error;
  double longest = 0.;
  for (const Arrow &arrow : arrows) {
    sum += arrow.value;
    longest = std::max(longest, (arrow.to - arrow.from).norm());
    error.add(std::abs(arrow.to[2] - 2.));
    error.add(((arrow.to - arrow.from) / 5. * 4. / std::sqrt(3.) - arrow.value / 25.).norm());
  }
  check("loads: the pressure times the area", (sum - Tensor<1, 3>({0., 0., -20.})).norm(), 1e-10);
  check("loads: the middle has the longest arrow", std::abs(longest / std::sqrt(3.) - 0.25), 1e-12);
  check("loads: arrows end at their nodes, as long as the forces", error.value(), 1e-10);
  check("loads: another one at its own time", std::abs(loads[1].time - 0.5), 1e-12);
  longest = 0.;
  sum = Tensor<1, 3>();
  for (const Arrow &arrow : gather(loads[1].arrows)) {
    sum += arrow.value;
    longest = std::max(longest, (arrow.to - arrow.from).norm());
  }
  check("loads: with its own force", (sum - Tensor<1, 3>({-0.001, 0., 0.})).norm(), 1e-12);
  check("loads: and its own scale", std::abs(longest / std::sqrt(3.) - 0.25), 1e-12);
}

void check_arrow() {
  const Arrow arrow{Tensor<1, 3>({1., 2., 3.}), Tensor<1, 3>({1., 2., 13.}), Tensor<1, 3>({7., 8., 9.})};
  const bool is_last = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) + 1 ==
                       dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  const std::vector<Arrow> arrows = is_last ? std::vector<Arrow>{arrow} : std::vector<Arrow>{};
  const Grid grid = make_arrow_grid("group", "name", "value", arrows, 1., MPI_COMM_WORLD);
  if (!testing::is_first_rank()) {
    testing::check("arrow: the first rank has it", grid.n_points() == 0 && grid.n_cells() == 0);
    return;
  }
  check("arrow: nine cells of thirteen points", grid.n_points() == 13 && grid.n_cells() == 9);
  double low = 1e9, high = -1e9;
  for (std::size_t i = 2; i < grid.points.size(); i += 3) {
    low = std::min(low, grid.points[i]);
    high = std::max(high, grid.points[i]);
  }
  check("arrow: from one point to the other", std::abs(low - 3.) + std::abs(high - 13.), 1e-12);
  double widest = 0.;
  for (std::size_t i = 0; i < grid.points.size(); i += 3)
    widest = std::max(widest, std::hypot(grid.points[i] - 1., grid.points[i + 1] - 2.));
  check("arrow: no wider than one of a tenth of the scene", widest > 0. && widest < 0.02);
  const GridField &field = grid.cell_fields.front();
  check("arrow: each cell has its value", field.name == "value" && field.values.size() == 27 &&
                                              field.values[24] == 7. && field.values[26] == 9.);
  std::size_t n_corners = 0;
  for (const unsigned int size : grid.sizes)
    n_corners += size;
  check("arrow: cells name points that are there",
        n_corners == grid.connectivity.size() &&
            *std::max_element(grid.connectivity.begin(), grid.connectivity.end()) == 12);
}

void check_files(const SceneRun &run) {
  std::vector<Grid> grids = make_snapshot_grids(run.scene, run.problem);
  std::vector<Grid> more = make_preview_grids(run.scene, run.discretization);
  check("preview: four blocks", more.size() == 4 && more[0].group == "Tools at end" &&
                                    more[1].group == "Supports" && more[2].group == "Loads" &&
                                    more[3].name == "pull of cube");
  testing::WorstError error;
  for (std::size_t i = 2; i < more[0].points.size(); i += 3)
    error.add(std::abs(more[0].points[i] - 2.5));
  check("preview: the tool is where its motion ends", more[0].n_points() > 0);
  check("preview: at that height", error.value(), 1e-12);
  grids.insert(grids.end(), more.begin(), more.end());
  const std::string folder = "preview";
  if (testing::is_first_rank())
    std::filesystem::create_directory(folder);
  MPI_Barrier(MPI_COMM_WORLD);
  FieldWriter(run.scene, MPI_COMM_WORLD, folder).write_preview(run.problem, grids);
  MPI_Barrier(MPI_COMM_WORLD);
  const std::string index = read_text(folder + "/fields_00000.vtm");
  const auto has = [&index](const std::string &name) {
    return index.find("\"" + name + "\"") != std::string::npos;
  };
  check("preview: the index names its groups",
        has("Bodies") && has("Tools at end") && has("Supports") && has("Loads") && has("die") && has("cube"));
  check("preview: the script shows them",
        read_text(folder + "/show_in_paraview.py").find("\nPREVIEW = True\n") != std::string::npos);
}

} // namespace

BILLET_MPI_TEST(preview) {
  const std::string file = "previewed.prm";
  if (testing::is_first_rank())
    std::ofstream(file) << text;
  MPI_Barrier(MPI_COMM_WORLD);
  if (!testing::is_first_rank())
    std::cout.setstate(std::ios::failbit); // one rank speaks
  const SceneRun run(parameters::Scene::read(file));
  check_supports(run);
  check_loads(run);
  check_arrow();
  check_files(run);
}

} // namespace preview_test
