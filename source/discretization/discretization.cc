// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/discretization/discretization.h"

#include "billet/discretization/contact_neighbours.h"
#include "billet/errors.h"
#include "billet/fail_together.h"

#include <deal.II/base/bounding_box.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria_description.h>
#include <deal.II/lac/sparsity_pattern.h>

#include <map>
#include <set>

namespace billet {

namespace {

/// Builds the whole mesh, partitioned by METIS into one part for each rank. First rank only.
void build_partitioned(const Scene &scene, const MeshLevels &levels, const unsigned int n_parts,
                       dealii::Triangulation<3> &mesh) {
  scene.build_mesh(MeshDetail::full, mesh);
  refine_bodies(scene.parameters(), levels, mesh);
  if (mesh.n_active_cells() < n_parts)
    throw InputError(scene.parameters().file_name + ": the mesh has " +
                     std::to_string(mesh.n_active_cells()) + " elements for " + std::to_string(n_parts) +
                     " ranks; allowed is at least one element for each rank");
  dealii::DynamicSparsityPattern neighbours;
  dealii::GridTools::get_face_connectivity_of_cells(mesh, neighbours);
  add_contact_neighbours(scene, mesh, neighbours);
  dealii::SparsityPattern pattern;
  pattern.copy_from(neighbours);
  dealii::GridTools::partition_triangulation(n_parts, pattern, mesh,
                                             dealii::SparsityTools::Partitioner::metis);
}

/// Gives the faces at the edge of the rank's part of the mesh an id that no scene can name.
/// Otherwise deal.II would treat them as boundary faces with id 0.
void close_rim(const dealii::TriangulationDescription::Description<3, 3> &description,
               dealii::Triangulation<3> &mesh) {
  constexpr dealii::types::boundary_id rim = dealii::numbers::internal_face_boundary_id - 1;
  std::map<dealii::CellId::binary_type, std::set<unsigned int>> boundaries;
  for (const auto &level : description.cell_infos)
    for (const auto &cell : level)
      for (const auto &[face, id] : cell.boundary_ids)
        boundaries[cell.id].insert(face);
  for (const auto &cell : mesh.active_cell_iterators()) {
    const auto known = boundaries.find(cell->id().to_binary<3>());
    for (const unsigned int f : cell->face_indices())
      if (cell->face(f)->at_boundary() && (known == boundaries.end() || known->second.count(f) == 0))
        cell->face(f)->set_boundary_id(rim);
  }
}

} // namespace

Discretization::Discretization(const Scene &scene, MPI_Comm communicator, MeshLevels levels)
    : communicator_(communicator), tria_(communicator), fe_(dealii::FE_Q<3>(1), 3),
      levels_(std::move(levels)) {
  levels_.resize(scene.bodies().size(), 0);
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(communicator);
  const bool is_first = dealii::Utilities::MPI::this_mpi_process(communicator) == 0;

  dealii::Triangulation<3> whole; // on the first rank, until it is distributed
  fail_together(communicator, [&] {
    if (is_first)
      build_partitioned(scene, levels_, n_ranks, whole);
  });
  std::array<double, 6> box{};
  if (is_first) {
    const auto corners = dealii::GridTools::compute_bounding_box(whole).get_boundary_points();
    for (unsigned int i = 0; i < 3; ++i) {
      box[i] = corners.first[i];
      box[3 + i] = corners.second[i];
    }
  }
  box = dealii::Utilities::MPI::broadcast(communicator, box, 0);
  dealii::Tensor<1, 3> diagonal;
  for (unsigned int i = 0; i < 3; ++i) {
    centre_[i] = 0.5 * (box[i] + box[3 + i]);
    diagonal[i] = 0.5 * (box[3 + i] - box[i]);
  }
  radius_ = diagonal.norm();

  const auto description =
      dealii::TriangulationDescription::Utilities::create_description_from_triangulation_in_groups<3, 3>(
          [&whole](dealii::Triangulation<3> &mesh) { mesh.copy_triangulation(whole); },
          [&whole](dealii::Triangulation<3> &mesh, const MPI_Comm &, const unsigned int) {
            auto from = whole.begin_active();
            for (const auto &cell : mesh.active_cell_iterators()) {
              cell->set_subdomain_id(from->subdomain_id());
              ++from;
            }
          },
          communicator, static_cast<int>(n_ranks));
  whole.clear();
  tria_.create_triangulation(description);
  close_rim(description, tria_);

  dof_handler_.reinit(tria_);
  dof_handler_.distribute_dofs(fe_);
  owned_ = dof_handler_.locally_owned_dofs();
  relevant_ = dealii::DoFTools::extract_locally_relevant_dofs(dof_handler_);

  elements_.resize(scene.bodies().size());
  for (const auto &cell : dof_handler_.active_cell_iterators())
    if (cell->is_locally_owned()) {
      Element element;
      element.cell = cell;
      for (unsigned int v = 0; v < n_element_nodes; ++v)
        for (unsigned int i = 0; i < 3; ++i)
          element.dofs[3 * v + i] = cell->vertex_dof_index(v, i);
      elements_[cell->material_id()].push_back(element);
    }
}

Discretization::~Discretization() = default;

std::vector<std::size_t> Discretization::count_elements() const {
  std::vector<std::size_t> counts;
  for (const auto &of_body : elements_)
    counts.push_back(dealii::Utilities::MPI::sum(of_body.size(), communicator_));
  return counts;
}

ElementVectors nodal_positions(const CellIterator &cell) {
  ElementVectors positions{};
  for (unsigned int v = 0; v < n_element_nodes; ++v)
    for (unsigned int i = 0; i < 3; ++i)
      positions[3 * v + i] = cell->vertex(v)[i];
  return positions;
}

} // namespace billet
