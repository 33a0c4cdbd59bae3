// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/run/body_report.h"

#include "billet/algebra/gather.h"
#include "billet/discretization/boundary_facets.h"
#include "billet/disjoint_sets.h"
#include "billet/fail_together.h"
#include "billet/scene/smooth_volume.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <unordered_map>

namespace billet {

using dealii::Tensor;
namespace mpi = dealii::Utilities::MPI;

namespace {

/// Returns this rank's separate sets of elements as a message. It has their number, then pairs of a
/// node that other ranks may have, by its first dof, and the set it is in.
std::vector<std::uint64_t> find_own_parts(const Discretization &discretization, const std::size_t body) {
  std::unordered_map<DofIndex, std::size_t> nodes;
  DisjointSets sets;
  for (const Element &element : discretization.elements(body)) {
    std::size_t first = 0;
    for (unsigned int a = 0; a < n_element_nodes; ++a) {
      const auto [node, is_new] = nodes.emplace(element.dofs[std::size_t{3} * a], sets.size());
      if (is_new)
        sets.add();
      if (a == 0)
        first = node->second;
      else
        sets.join(node->second, first);
    }
  }
  std::unordered_map<std::size_t, std::uint64_t> number; // of the set with this root
  std::set<DofIndex> shared;
  for (const auto &entry : nodes)
    number.emplace(sets.find(entry.second), number.size());
  for (const auto &cell : discretization.dof_handler().active_cell_iterators())
    if (cell->is_ghost())
      for (const unsigned int v : cell->vertex_indices())
        if (nodes.count(cell->vertex_dof_index(v, 0)) > 0)
          shared.insert(cell->vertex_dof_index(v, 0));
  std::vector<std::uint64_t> message{number.size()};
  for (const DofIndex node : shared) {
    message.push_back(node);
    message.push_back(number.at(sets.find(nodes.at(node))));
  }
  return message;
}

std::size_t count_parts(const Discretization &discretization, const std::size_t body) {
  DisjointSets sets;
  std::unordered_map<std::uint64_t, std::size_t> set_of_node;
  for (const auto &of_rank :
       all_gather(discretization.communicator(), find_own_parts(discretization, body))) {
    const std::size_t first = sets.size();
    for (std::uint64_t i = 0; i < of_rank[0]; ++i)
      sets.add();
    for (std::size_t i = 1; i + 1 < of_rank.size(); i += 2) {
      const std::size_t set = first + of_rank[i + 1];
      sets.join(set, set_of_node.emplace(of_rank[i], set).first->second);
    }
  }
  return sets.count();
}

/// Calls visit(a, b) with the corners of the four edges of an element along direction i.
template <class Visit> void for_each_edge(const unsigned int i, const Visit &visit) {
  for (unsigned int v = 0; v < n_element_nodes; ++v) // the two corners of an edge differ in one bit
    if ((v & (1U << i)) == 0)
      visit(v, v | (1U << i));
}

/// Returns a · (b × c) of the unit vectors; 0 if one has no length.
double unit_volume(const std::array<Tensor<1, 3>, 3> &edges) {
  const double lengths = edges[0].norm() * edges[1].norm() * edges[2].norm();
  return lengths > 0. ? dealii::cross_product_3d(edges[0], edges[1]) * edges[2] / lengths : 0.;
}

/// Measures the elements of a body, over all ranks.
void measure_elements(const Discretization &discretization, const std::size_t body, BodyReport &report) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> sums(5, 0.); // elements, volume, edges, nodes, number of edges
  // Low corner, minus the high one, least edge, minus the largest one.
  std::vector<double> minima(8, infinity);
  std::array<double, 4> worst{infinity, 0., 0., 0.};
  std::set<DofIndex> nodes;
  for (const Element &element : discretization.elements(body)) {
    const CellIterator &cell = element.cell;
    sums[0] += 1.;
    sums[1] += cell->measure();
    for (unsigned int i = 0; i < 3; ++i)
      for_each_edge(i, [&](const unsigned int a, const unsigned int b) {
        const double length = cell->vertex(a).distance(cell->vertex(b));
        if (!(length > 0.)) // of a prism on the axis
          return;
        sums[2] += length;
        sums[4] += 1.;
        minima[6] = std::min(minima[6], length);
        minima[7] = std::min(minima[7], -length);
      });
    for (unsigned int a = 0; a < n_element_nodes; ++a) {
      for (unsigned int i = 0; i < 3; ++i) {
        minima[i] = std::min(minima[i], cell->vertex(a)[i]);
        minima[3 + i] = std::min(minima[3 + i], -cell->vertex(a)[i]);
      }
      const DofIndex dof = element.dofs[std::size_t{3} * a];
      if (discretization.owned_dofs().is_element(dof))
        nodes.insert(dof);
    }
    const dealii::Point<3> centre =
        cell->center(); // among equal elements it chooses one, on any number of ranks
    worst = std::min(worst, {scaled_jacobian(cell), centre[0], centre[1], centre[2]});
  }
  sums[3] = static_cast<double>(nodes.size());
  const MPI_Comm communicator = discretization.communicator();
  mpi::sum(sums, communicator, sums);
  mpi::min(minima, communicator, minima);
  for (const auto &of_rank : all_gather(communicator, worst))
    worst = std::min(worst, of_rank);
  report.n_elements = static_cast<std::size_t>(sums[0]);
  report.volume = sums[1];
  report.mean_edge = sums[2] / sums[4];
  report.n_nodes = static_cast<std::size_t>(sums[3]);
  for (unsigned int i = 0; i < 3; ++i) {
    report.low[i] = minima[i];
    report.high[i] = -minima[3 + i];
    report.worst_element[i] = worst[1 + i];
  }
  report.min_edge = minima[6];
  report.max_edge = -minima[7];
  report.min_quality = worst[0];
}

/// Returns the ids of the exterior faces of a body, over all ranks.
std::vector<unsigned int> find_boundary_ids(const Discretization &discretization, const std::size_t body) {
  std::set<unsigned int> ids;
  for (const Element &element : discretization.elements(body))
    for (const unsigned int f : element.cell->face_indices())
      if (element.cell->face(f)->at_boundary())
        ids.insert(element.cell->face(f)->boundary_id());
  const std::vector<unsigned int> all =
      gather_all(discretization.communicator(), std::vector<unsigned int>(ids.begin(), ids.end()));
  ids.insert(all.begin(), all.end());
  return {ids.begin(), ids.end()};
}

BoundaryReport measure_boundary(const Discretization &discretization, const std::size_t body,
                                const unsigned int id) {
  std::vector<double> sums(8, 0.); // faces, area, moment, vector
  for (const BoundaryFacet &facet : collect_boundary_facets(discretization, body, {id})) {
    const std::array<double, 4> areas = facet.corner_areas();
    const Tensor<1, 3> vector = facet.area_vector();
    sums[0] += 1.;
    for (unsigned int a = 0; a < 4; ++a) {
      sums[1] += areas[a];
      for (unsigned int i = 0; i < 3; ++i)
        sums[2 + i] += areas[a] * facet.corners[a][i];
    }
    for (unsigned int i = 0; i < 3; ++i)
      sums[5 + i] += vector[i];
  }
  mpi::sum(sums, discretization.communicator(), sums);
  BoundaryReport report;
  report.id = id;
  report.n_faces = static_cast<std::size_t>(sums[0]);
  report.area = sums[1];
  if (!(report.area > 0.))
    return report;
  const Tensor<1, 3> vector({sums[5], sums[6], sums[7]});
  report.centre = Tensor<1, 3>({sums[2], sums[3], sums[4]}) / report.area;
  report.flatness = vector.norm() / report.area;
  constexpr double rounding = 1e-9;
  if (report.flatness > rounding)
    report.normal = vector / vector.norm();
  else
    report.flatness = 0.;
  return report;
}

} // namespace

double scaled_jacobian(const CellIterator &cell) {
  std::array<Tensor<1, 3>, 3> axes;
  for (unsigned int i = 0; i < 3; ++i)
    for_each_edge(
        i, [&](const unsigned int a, const unsigned int b) { axes[i] += cell->vertex(b) - cell->vertex(a); });
  double least = unit_volume(axes);
  for (unsigned int v = 0; v < n_element_nodes; ++v) {
    std::array<Tensor<1, 3>, 3> edges;
    for (unsigned int i = 0; i < 3; ++i) {
      const unsigned int bit = 1U << i;
      edges[i] = cell->vertex(v | bit) - cell->vertex(v & ~bit);
      if (!(edges[i].norm() > 0.)) // of a prism on the axis
        edges[i] = axes[i];
    }
    least = std::min(least, unit_volume(edges));
  }
  return least;
}

double min_edge(const CellIterator &cell) {
  double least = std::numeric_limits<double>::infinity();
  for (unsigned int i = 0; i < 3; ++i)
    for_each_edge(i, [&](const unsigned int a, const unsigned int b) {
      const double length = cell->vertex(a).distance(cell->vertex(b));
      least = length > 0. ? std::min(least, length) : least;
    });
  return least;
}

std::vector<BodyReport> report_bodies(const Scene &scene, const Discretization &discretization) {
  std::vector<BodyReport> reports;
  for (std::size_t b = 0; b < scene.bodies().size(); ++b) {
    const Body &body = scene.bodies()[b];
    BodyReport report;
    report.name = body.name;
    measure_elements(discretization, b, report);
    report.mass = body.density * report.volume;
    fail_together(discretization.communicator(),
                  [&] { report.smooth_volume = find_smooth_volume(scene.parameters().bodies[b]); });
    if (scene.whole_section().kind == WholeSection::Kind::full_circle)
      report.circle_factor = scene.whole_section().factor;
    report.n_parts = count_parts(discretization, b);
    for (const unsigned int id : find_boundary_ids(discretization, b)) {
      report.boundaries.push_back(measure_boundary(discretization, b, id));
      for (const auto &[name, ids] : body.boundary_names.ids_of_name)
        if (std::find(ids.begin(), ids.end(), id) != ids.end())
          report.boundaries.back().names.push_back(name);
    }
    reports.push_back(std::move(report));
  }
  return reports;
}

} // namespace billet
