// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/snapshot_grids.h"

#include "billet/discretization/node_keys.h"
#include "billet/material/law_type.h"
#include "billet/output/element_fields.h"
#include "billet/output/field_quantity.h"

#include <algorithm>
#include <set>

namespace billet {

namespace {

constexpr std::array<unsigned int, 8> hexahedron_order{0, 1, 3, 2, 4, 5, 7, 6};
constexpr std::array<unsigned int, 4> quadrilateral_order{0, 1, 3, 2};

/// Cells of a block on this rank: elements of a body, or faces of them.
struct BlockCells {
  std::vector<std::vector<DofIndex>> nodes; ///< first dofs of the nodes, in the order of VTK
  std::vector<std::size_t> elements;        ///< places in Discretization::elements()
  std::vector<double> boundary_ids;         ///< of faces
};

BlockCells all_elements(const Discretization &discretization, const std::size_t body) {
  BlockCells cells;
  for (const Element &element : discretization.elements(body)) {
    cells.elements.push_back(cells.nodes.size());
    cells.nodes.emplace_back();
    for (const unsigned int v : hexahedron_order)
      cells.nodes.back().push_back(element.dofs[std::size_t{3} * v]);
  }
  return cells;
}

/// Returns the boundary faces of a body whose id is among `ids`; all of them without ids. Their
/// normals point out of the body.
BlockCells boundary_faces(const Discretization &discretization, const std::size_t body,
                          const std::set<unsigned int> &ids) {
  BlockCells cells;
  const auto &elements = discretization.elements(body);
  for (std::size_t e = 0; e < elements.size(); ++e)
    for (const unsigned int f : elements[e].cell->face_indices()) {
      const auto face = elements[e].cell->face(f);
      if (!face->at_boundary() || (!ids.empty() && ids.count(face->boundary_id()) == 0))
        continue;
      const auto normal =
          dealii::cross_product_3d(face->vertex(3) - face->vertex(0), face->vertex(2) - face->vertex(1));
      std::vector<DofIndex> nodes;
      for (const unsigned int v : quadrilateral_order)
        nodes.push_back(face->vertex_dof_index(v, 0));
      if (normal * (face->center() - elements[e].cell->center()) < 0.)
        std::swap(nodes[1], nodes[3]);
      cells.nodes.push_back(nodes);
      cells.elements.push_back(e);
      cells.boundary_ids.push_back(face->boundary_id());
    }
  return cells;
}

/// Numbers the nodes of a block over all ranks. The owner of a node writes it, even if its cells
/// are on other ranks.
class BlockNodes {
public:
  /// Collective.
  BlockNodes(const Discretization &discretization, const BlockCells &cells)
      : numbers_(discretization.make_ghosted_vector()) {
    Vector marks = discretization.make_additive_vector();
    for (const auto &nodes : cells.nodes)
      for (const DofIndex node : nodes)
        marks(node) += 1.;
    marks.compress(dealii::VectorOperation::add);
    Vector owned = discretization.make_owned_vector();
    owned = marks;
    for (const auto i : discretization.owned_dofs())
      if (owned(i) > 0.)
        owned_.push_back(i);
    const MPI_Comm communicator = discretization.communicator();
    std::uint64_t n = owned_.size(), first = 0;
    MPI_Exscan(&n, &first, 1, MPI_UINT64_T, MPI_SUM, communicator);
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      first = 0; // MPI leaves it undefined
    for (const DofIndex node : owned_)
      owned(node) = static_cast<double>(first++);
    owned.compress(dealii::VectorOperation::insert);
    numbers_ = owned;
  }

  /// Returns the first dofs of the nodes that this rank writes.
  const std::vector<DofIndex> &owned() const { return owned_; }
  std::uint64_t number(const DofIndex node) const { return static_cast<std::uint64_t>(numbers_(node)); }

private:
  Vector numbers_;
  std::vector<DofIndex> owned_;
};

/// Returns the undeformed positions of the owned nodes.
Vector collect_positions(const Discretization &discretization) {
  Vector positions = discretization.make_owned_vector();
  for (std::size_t body = 0; body < discretization.n_bodies(); ++body)
    for (const Element &element : discretization.elements(body))
      for (unsigned int v = 0; v < n_element_nodes; ++v)
        for (unsigned int i = 0; i < 3; ++i) {
          const DofIndex dof = element.dofs[std::size_t{3} * v + i];
          if (discretization.owned_dofs().is_element(dof))
            positions(dof) = element.cell->vertex(v)[i];
        }
  positions.compress(dealii::VectorOperation::insert);
  return positions;
}

/// Cells that make the blocks of bodies and surfaces.
class MeshBlocks {
public:
  MeshBlocks(const Scene &scene, const Solution &solution)
      : discretization_(solution.discretization()), displacements_(solution.state().displacements),
        positions_(collect_positions(discretization_)), node_keys_(discretization_),
        element_fields_(collect_element_fields(scene, solution)) {
    for (const NodalQuantity &quantity : field_quantities().nodal())
      for (NodalField &field : quantity.evaluate(scene, discretization_, solution))
        nodal_fields_.push_back(std::move(field));
    if (scene.parameters().output.averages)
      averages_ = average_to_nodes(discretization_, element_fields_);
  }

  const Discretization &discretization() const { return discretization_; }

  /// Returns the block of a body. Collective.
  Grid body(const std::size_t body, const std::string &name) const {
    const BlockCells cells = all_elements(discretization_, body);
    Grid grid = block(body, cells, block_group::bodies, name);
    for (const GridField &field : element_fields_[body])
      grid.cell_fields.push_back(field);
    if (!averages_.empty())
      add_averages(grid, BlockNodes(discretization_, cells));
    return grid;
  }

  /// Returns a block of faces of a body, with these boundary ids or with all. Collective.
  Grid surface(const std::size_t body, const std::set<unsigned int> &ids, const std::string &group,
               const std::string &name) const {
    const BlockCells cells = boundary_faces(discretization_, body, ids);
    Grid grid = block(body, cells, group, name);
    grid.cell_fields.push_back({"boundary_id", 1, FileNumber::int32, cells.boundary_ids});
    grid.cell_fields.push_back(
        {"body", 1, FileNumber::int32, std::vector<double>(cells.nodes.size(), static_cast<double>(body))});
    return grid;
  }

private:
  /// Returns a block with the fields that all blocks have.
  Grid block(const std::size_t body, const BlockCells &cells, const std::string &group,
             const std::string &name) const {
    const BlockNodes nodes(discretization_, cells);
    Grid grid{group, name};
    GridField undeformed{"undeformed_coordinates", 3}, node_ids{"node_id", 1, FileNumber::int64},
        element_ids{"element_id", 1, FileNumber::int64};
    for (const DofIndex node : nodes.owned()) {
      for (unsigned int i = 0; i < 3; ++i) {
        undeformed.values.push_back(positions_(node + i));
        grid.points.push_back(positions_(node + i) + displacements_(node + i));
      }
      node_ids.values.push_back(static_cast<double>(node_keys_(node)));
    }
    for (std::size_t c = 0; c < cells.nodes.size(); ++c) {
      for (const DofIndex node : cells.nodes[c])
        grid.connectivity.push_back(nodes.number(node));
      grid.sizes.push_back(static_cast<unsigned int>(cells.nodes[c].size()));
      element_ids.values.push_back(
          static_cast<double>(element_key(discretization_.elements(body)[cells.elements[c]].cell)));
    }
    for (const NodalField &field : nodal_fields_)
      add_nodal_field(grid, field, nodes);
    grid.point_fields.push_back(undeformed);
    grid.point_fields.push_back(node_ids);
    grid.cell_fields.push_back(element_ids);
    return grid;
  }

  static void add_nodal_field(Grid &grid, const NodalField &field, const BlockNodes &nodes) {
    const unsigned int n_fields = field.is_vector ? 1 : 3;
    for (unsigned int f = 0; f < n_fields; ++f) {
      GridField added{field.components[f], field.is_vector ? 3U : 1U};
      for (const DofIndex node : nodes.owned())
        for (unsigned int c = 0; c < added.n_components; ++c)
          added.values.push_back(field.values(node + f + c));
      grid.point_fields.push_back(std::move(added));
    }
  }

  void add_averages(Grid &grid, const BlockNodes &nodes) const {
    for (const NodalAverage &average : averages_) {
      GridField added{"averaged_" + average.name, average.n_components};
      for (const DofIndex node : nodes.owned())
        for (unsigned int c = 0; c < average.n_components; ++c)
          added.values.push_back(average(node, c));
      grid.point_fields.push_back(std::move(added));
    }
  }

  const Discretization &discretization_;
  const Vector &displacements_;
  Vector positions_;
  NodeKeys node_keys_;
  std::vector<std::vector<GridField>> element_fields_;
  std::vector<NodalField> nodal_fields_;
  std::vector<NodalAverage> averages_;
};

std::set<unsigned int> to_set(const std::vector<unsigned int> &ids) { return {ids.begin(), ids.end()}; }

} // namespace

Grid make_tool_grid(const Discretization &discretization, const Tool &tool, const std::size_t t,
                    const Placement &now, const std::string &group) {
  Grid grid{group, tool.name()};
  GridField displacement{"displacement", 3}, undeformed{"undeformed_coordinates", 3},
      number{"tool", 1, FileNumber::int32};
  if (dealii::Utilities::MPI::this_mpi_process(discretization.communicator()) == 0) {
    const Placement start = tool.placement(0.);
    const SurfaceMesh mesh =
        tool.surface().surface_mesh({now.to_tool(discretization.centre()), 1.5 * discretization.radius()});
    for (const auto &point : mesh.points) {
      const dealii::Tensor<1, 3> place = now.to_space(point), before = start.to_space(point);
      for (unsigned int i = 0; i < 3; ++i) {
        grid.points.push_back(place[i]);
        undeformed.values.push_back(before[i]);
        displacement.values.push_back(place[i] - before[i]);
      }
    }
    for (const auto &facet : mesh.facets) {
      grid.connectivity.insert(grid.connectivity.end(), facet.begin(), facet.end());
      grid.sizes.push_back(static_cast<unsigned int>(facet.size()));
      number.values.push_back(static_cast<double>(t));
    }
  }
  grid.point_fields = {displacement, undeformed};
  grid.cell_fields = {number};
  return grid;
}

std::vector<Grid> make_snapshot_grids(const Scene &scene, const Solution &solution) {
  const MeshBlocks blocks(scene, solution);
  const auto &bodies = scene.bodies();
  std::vector<Grid> grids;
  for (std::size_t body = 0; body < bodies.size(); ++body) {
    grids.push_back(blocks.body(body, bodies[body].name));
    grids.back().material = describe_law(*bodies[body].law);
  }
  for (std::size_t body = 0; body < bodies.size(); ++body)
    grids.push_back(blocks.surface(body, {}, block_group::boundaries, bodies[body].name));
  const auto add_surface = [&](const PairSettings &pair, const std::string &side, const std::size_t body,
                               const std::vector<unsigned int> &ids, const std::size_t number) {
    grids.push_back(blocks.surface(body, to_set(ids), block_group::contact_surfaces, pair.name + side));
    grids.back().cell_fields.push_back(
        {"pair", 1, FileNumber::int32,
         std::vector<double>(grids.back().n_cells(), static_cast<double>(number))});
  };
  std::size_t number = 0;
  for (const ContactPair &pair : scene.pairs())
    add_surface(pair, "", pair.body, pair.boundary_ids, number++);
  for (const BodyPair &pair : scene.body_pairs()) {
    for (std::size_t side = 0; side < (pair.is_self_contact ? 1 : 2); ++side)
      add_surface(pair, pair.is_self_contact ? "" : " (" + bodies[pair.bodies[side]].name + ")",
                  pair.bodies[side], pair.boundary_ids[side], number);
    ++number;
  }
  for (std::size_t t = 0; t < scene.tools().size(); ++t)
    grids.push_back(make_tool_grid(solution.discretization(), scene.tools()[t], t,
                                   solution.state().placements[t], block_group::tools));
  return grids;
}

} // namespace billet
