// SPDX-License-Identifier: LGPL-2.1-or-later
// With the faces that lie opposite each other as neighbours, METIS cuts between few of them.
#include "billet/discretization/contact_neighbours.h"

#include "scene_run.h"

#include <deal.II/base/mpi.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/lac/sparsity_pattern.h>

namespace partition_test {

using namespace billet;
using billet::testing::check;

namespace {

/// Part of the opposite faces that are on two ranks.
double crossing_part(const Scene &scene, const unsigned int n_ranks, const bool with_contact) {
  dealii::Triangulation<3> mesh;
  scene.build_mesh(MeshDetail::full, mesh);
  dealii::DynamicSparsityPattern neighbours, contact(mesh.n_active_cells(), mesh.n_active_cells());
  dealii::GridTools::get_face_connectivity_of_cells(mesh, neighbours);
  add_contact_neighbours(scene, mesh, contact);
  if (with_contact)
    add_contact_neighbours(scene, mesh, neighbours);
  dealii::SparsityPattern pattern;
  pattern.copy_from(neighbours);
  dealii::GridTools::partition_triangulation(n_ranks, pattern, mesh,
                                             dealii::SparsityTools::Partitioner::metis);
  std::vector<dealii::types::subdomain_id> ranks;
  for (const auto &cell : mesh.active_cell_iterators())
    ranks.push_back(cell->subdomain_id());
  double n = 0., n_crossing = 0.;
  for (const auto &entry : contact) {
    n += 1.;
    n_crossing += ranks[entry.row()] != ranks[entry.column()] ? 1. : 0.;
  }
  return n_crossing / n;
}

} // namespace

BILLET_MPI_TEST(partition) {
  for (const std::string name :
       {"ironing", "press_fit", "billet_deformable_dies", "hertz_cylinders", "twisted_hemisphere"}) {
    const Scene scene(testing::read_shipped_scene(name + ".prm"));
    for (const unsigned int n_ranks : {2u, 4u}) {
      const double with_contact = crossing_part(scene, n_ranks, true),
                   without = crossing_part(scene, n_ranks, false);
      const std::string here = name + " on " + std::to_string(n_ranks) + " ranks";
      check(here + ": few pairs across", with_contact, 0.2);
      check(here + ": many, if METIS did not know", with_contact <= 0.4 * without);
    }
  }
}

} // namespace partition_test
