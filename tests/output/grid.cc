// SPDX-License-Identifier: LGPL-2.1-or-later
// Grids in VTU files, on any number of ranks: nodes are shared across ranks, numbers come back bit by bit,
// components of tensors have VTK's order, and blocks have their names.
#include "../testing.h"

#include "billet/output/element_fields.h"
#include "billet/output/vtu_file.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>

namespace grid_test {

using namespace billet;
using billet::testing::check;

namespace {

/// Chain of unit bricks along x, one on each rank, which share their nodes.
Grid make_chain(const std::size_t rank) {
  Grid grid{"Bodies", "chain"};
  GridField stress{"stress", 6}, number{"element_id", 1, FileNumber::int64};
  for (std::size_t layer = rank == 0 ? 0 : 1; layer < 2; ++layer)
    for (unsigned int j = 0; j < 4; ++j)
      for (const double x :
           {static_cast<double>(rank + layer), static_cast<double>(j % 2), static_cast<double>(j / 2)})
        grid.points.push_back(x);
  const std::uint64_t a = 4 * rank, b = a + 4;
  grid.connectivity = {a, b, b + 1, a + 1, a + 2, b + 2, b + 3, a + 3};
  grid.sizes = {8};
  stress.values = {11., 22., 33., 12., 23., 13.};
  number.values = {std::ldexp(1., 50) + static_cast<double>(rank)};
  grid.cell_fields = {stress, number};
  return grid;
}

/// Arrays of a VTU file, each as base64 in its element.
class VtuFile {
public:
  explicit VtuFile(const std::string &name) {
    std::ifstream in(name, std::ios::binary);
    text_.assign(std::istreambuf_iterator<char>(in), {});
  }
  bool has(const std::string &what) const { return text_.find(what) != std::string::npos; }

  template <class Number> std::vector<Number> read(const std::string &name) const {
    const std::size_t tag = text_.find("Name=\"" + name + "\""), start = text_.find(">\n", tag) + 2;
    const auto bytes = dealii::Utilities::decode_base64(text_.substr(start, text_.find('\n', start) - start));
    std::uint64_t size = 0;
    std::memcpy(&size, bytes.data(), sizeof(size));
    check(name + ": as many bytes as it says", bytes.size() == size + sizeof(size));
    std::vector<Number> values(size / sizeof(Number));
    std::memcpy(values.data(), bytes.data() + sizeof(size), size);
    return values;
  }

private:
  std::string text_;
};

void test_file(const std::size_t n_ranks) {
  const VtuFile file("chain.vtu");
  const auto points = file.read<double>("Points");
  const auto corners = file.read<std::int64_t>("connectivity");
  check("points: one for each node of the chain", points.size() == 3 * 4 * (n_ranks + 1));
  check("counts", file.has("NumberOfPoints=\"" + std::to_string(4 * (n_ranks + 1)) + "\" NumberOfCells=\"" +
                           std::to_string(n_ranks) + "\""));
  bool in_place = corners.size() == 8 * n_ranks;
  for (std::size_t i = 0; in_place && i < corners.size(); ++i) {
    const std::size_t k = i % 8;
    const double x = static_cast<double>(i / 8 + (k % 4 == 1 || k % 4 == 2 ? 1 : 0));
    const auto place = static_cast<std::size_t>(3 * corners[i]);
    in_place = points[place] == x && points[place + 1] == (k % 4 > 1 ? 1. : 0.) &&
               points[place + 2] == (k > 3 ? 1. : 0.);
  }
  check("corners are where VTK expects them", in_place);
  const auto ends = file.read<std::int64_t>("offsets");
  const auto types = file.read<std::uint8_t>("types");
  const auto numbers = file.read<std::int64_t>("element_id");
  const auto stress = file.read<float>("stress");
  bool right = ends.size() == n_ranks && types.size() == n_ranks && numbers.size() == n_ranks &&
               stress.size() == 6 * n_ranks;
  for (std::size_t e = 0; right && e < n_ranks; ++e)
    right = ends[e] == static_cast<std::int64_t>(8 * (e + 1)) && types[e] == 12 &&
            numbers[e] == (std::int64_t{1} << 50) + static_cast<std::int64_t>(e) && stress[6 * e] == 11.F &&
            stress[6 * e + 3] == 12.F && stress[6 * e + 4] == 23.F && stress[6 * e + 5] == 13.F;
  check("cells of all ranks, in their order", right);
}

void test_names() {
  const std::string index =
      multiblock_index({"Bodies", "Tools"}, {{"Bodies", "a & b", "f.0.vtu"}, {"Bodies", "c", "f.1.vtu"}});
  check("names of blocks, with an empty group",
        index.find("name=\"Bodies\">\n<DataSet index=\"0\" name=\"a &amp; b\" file=\"f.0.vtu\"/>\n<DataSet "
                   "index=\"1\" name=\"c\" file=\"f.1.vtu\"/>\n</Block>\n<Block index=\"1\" name=\"Tools\">\n"
                   "</Block>") != std::string::npos);
}

void test_tensors() {
  std::vector<GridField> scalars;
  for (const std::string name : {"p", "s_xx", "s_yy", "s_zz", "s_xy", "s_xz", "s_yz", "t_xx", "t_yy"})
    scalars.push_back({name, 1, FileNumber::float32, {static_cast<double>(scalars.size()), 50.}});
  const auto fields = join_components(scalars);
  check("six scalars become a tensor, others stay",
        fields.size() == 4 && fields[0].name == "p" && fields[1].name == "s" && fields[2].name == "t_xx");
  check("xx, yy, zz, xy, yz, xz",
        fields[1].n_components == 6 &&
            fields[1].values == std::vector<double>({1., 2., 3., 4., 6., 5., 50., 50., 50., 50., 50., 50.}));
}

/// A brick stretched along a turned axis, and turned afterwards.
void test_strain() {
  const double c = std::cos(0.7), s = std::sin(0.7);
  dealii::Tensor<2, 3> turn, stretch;
  turn[0][0] = turn[1][1] = c;
  turn[0][1] = -s;
  turn[1][0] = s;
  turn[2][2] = 1.;
  stretch[0][0] = 1.5;
  stretch[1][1] = 0.8;
  stretch[2][2] = 1.1;
  const dealii::Tensor<2, 3> F = turn * stretch;
  ElementVectors positions{}, displacements{};
  for (unsigned int v = 0; v < n_element_nodes; ++v) {
    dealii::Tensor<1, 3> X;
    X[0] = (v % 2) * (1. + 0.3 * (v / 4)); // a distorted brick
    X[1] = (v / 2 % 2) * 0.9;
    X[2] = (v / 4) * (1.2 - 0.1 * (v % 2));
    const dealii::Tensor<1, 3> u = F * X - X;
    for (unsigned int i = 0; i < 3; ++i) {
      positions[3 * v + i] = X[i];
      displacements[3 * v + i] = u[i];
    }
  }
  const auto mean = mean_deformation_gradient(positions, displacements);
  check("deformation gradient of a linear motion", (mean - F).norm(), 1e-14);
  dealii::Tensor<2, 3> logarithms;
  for (unsigned int i = 0; i < 3; ++i)
    logarithms[i][i] = std::log(stretch[i][i]);
  const dealii::Tensor<2, 3> expected = turn * logarithms * dealii::transpose(turn);
  check("ln V turns with the body", (dealii::Tensor<2, 3>(logarithmic_strain(F)) - expected).norm(), 1e-14);
}

} // namespace

BILLET_MPI_TEST(grid) {
  const std::size_t rank = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD),
                    n_ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  if (rank != 0)
    std::cout.setstate(std::ios::failbit); // one rank speaks
  const Grid chain = make_chain(rank);
  check("a file is written", write_vtu(MPI_COMM_WORLD, "chain.vtu", chain));
  test_file(n_ranks);
  check("a folder that is not there is an error", !write_vtu(MPI_COMM_WORLD, "nowhere/chain.vtu", chain));
  test_names();
  test_tensors();
  test_strain();
}

} // namespace grid_test
