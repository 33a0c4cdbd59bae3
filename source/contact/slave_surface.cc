// SPDX-License-Identifier: LGPL-2.1-or-later
// Collects nodes that may touch a tool, and points inside facets between which it could enter.
#include "billet/contact/slave_surface.h"

#include "billet/contact/facet_division.h"
#include "billet/contact/sheet_penalty.h"
#include "billet/contact/spring_energy.h"
#include "billet/discretization/boundary_facets.h"
#include "billet/geometry/facet_projection.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace billet {

using dealii::Tensor;

namespace {

// Maximum number of points inside the facets of a pair on all ranks, half a kilobyte each. Above
// it, facets have fewer parts.
constexpr double max_interior_points = 400'000.;

// Facets with lengths that differ by less than this factor have the same number of parts.
const double same_length = std::pow(2., 0.125);

// Acceptable penetration of a node: these parts of the size of its facets and of the wall below
// them.
constexpr double reach_of_facet = 0.2, reach_of_wall = 0.4;

constexpr std::uint64_t points_per_key = 1024; // > (FacetDivision::max_parts + 1)²

/// Sets the spacing of each node: the root of the mean area of the parts of facets around it.
/// Collective.
void measure_spacings(const Discretization &discretization,
                      const std::vector<std::array<unsigned int, 4>> &corners,
                      const std::vector<std::array<unsigned int, 2>> &n_parts,
                      std::vector<ContactPoint> &nodes) {
  Vector sums = discretization.make_additive_vector();
  for (std::size_t f = 0; f < corners.size(); ++f) {
    const auto x = [&](const unsigned int a) { return nodes[corners[f][a]].reference; };
    const double area = 0.5 * dealii::cross_product_3d(x(3) - x(0), x(2) - x(1)).norm();
    const unsigned int n = n_parts[f][0] * n_parts[f][1];
    const std::array<double, 3> values{area / n, 1., n > 1 ? 1. : 0.};
    for (const unsigned int i : corners[f])
      sums.add(3, nodes[i].dofs.data(), values.data());
  }
  sums.compress(dealii::VectorOperation::add);
  Vector ghosted = discretization.make_ghosted_vector();
  ghosted = sums;
  for (auto &node : nodes) {
    node.spacing = std::sqrt(ghosted(node.dofs[0]) / ghosted(node.dofs[1]));
    node.is_divided = ghosted(node.dofs[2]) > 0.;
  }
}

} // namespace

SlaveSurface::SlaveSurface(const ContactPair &pair, const Tool &tool, const Discretization &discretization,
                           const double young_modulus, const double touching_gap) {
  collect_facets(pair, discretization, young_modulus, touching_gap);
  divide_facets(tool, discretization);
}

void SlaveSurface::collect_facets(const ContactPair &pair, const Discretization &discretization,
                                  const double young_modulus, const double touching_gap) {
  std::map<DofIndex, unsigned int> index;
  const auto boundary_facets = collect_boundary_facets(discretization, pair.body, pair.boundary_ids);
  const auto sizes = compute_facet_sizes(discretization, boundary_facets);
  // Penalties of a refined body remain, so that its pressures continue.
  const double coarse = std::exp2(discretization.levels()[pair.body]);
  is_sheet = may_have_sheet_penalty(pair, discretization, boundary_facets);
  for (const auto &boundary : boundary_facets) {
    ContactFacet facet{};
    facet.key = boundary.key;
    facet.shallow_areas.fill(SpringEnergy::no_area);
    for (unsigned int a = 0; a < 4; ++a) {
      const auto found = index.emplace(boundary.dofs[a][0], static_cast<unsigned int>(nodes.size()));
      if (found.second) {
        ContactPoint node;
        node.dofs = boundary.dofs[a];
        node.reference = boundary.corners[a];
        const FacetSize size = sizes.at(node.dofs[0]);
        node.size = node.spacing = size.size;
        node.reach = reach_of_facet * node.size;
        const double length = penalty_length(pair.penalty_counts_thickness, size.size, size.thickness);
        node.stiffness = {pair.scaled_penalty(pair.normal_penalty, young_modulus, coarse * length),
                          pair.scaled_penalty(pair.tangential_penalty, young_modulus, coarse * length)};
        const double room = enough_penalty * young_modulus / (length * node.stiffness.normal);
        max_stiffening = std::min(max_stiffening, room);
        max_tangential_stiffening = std::min(
            max_tangential_stiffening, enough_penalty * young_modulus / (length * node.stiffness.tangential));
        node.touching_gap = touching_gap * node.size * std::min(1., room);
        nodes.push_back(node);
      }
      facet.nodes[a] = found.first->second;
      ContactPoint &corner = nodes[facet.nodes[a]];
      corner.reach = std::min(corner.reach, reach_of_wall * boundary.thickness);
    }
    facets.push_back(facet);
  }
  if (!pair.has_friction())
    max_tangential_stiffening = std::numeric_limits<double>::infinity();
  n_mesh_nodes = nodes.size();
}

void SlaveSurface::divide_facets(const Tool &tool, const Discretization &discretization) {
  const MPI_Comm communicator = discretization.communicator();
  std::vector<std::array<unsigned int, 4>> corners;
  for (const auto &facet : facets)
    corners.push_back(facet.nodes);
  n_whole_facets = facets.size();
  // Longest sides along ξ and η.
  const auto lengths_of = [&](const std::array<unsigned int, 4> &of_facet) {
    const auto side = [&](const unsigned int a, const unsigned int b) {
      return (nodes[of_facet[b]].reference - nodes[of_facet[a]].reference).norm();
    };
    return std::array<double, 2>{std::max(side(0, 1), side(2, 3)), std::max(side(0, 2), side(1, 3))};
  };
  double longest = 0.;
  for (const auto &of_facet : corners) {
    const auto lengths = lengths_of(of_facet);
    longest = std::max({longest, lengths[0], lengths[1]});
  }
  longest = dealii::Utilities::MPI::max(longest, communicator);
  if (longest == 0.)
    return;

  const Placement placement = tool.placement(0.);
  const FacetDivision division(tool.surface(),
                               {placement.to_tool(discretization.centre()), 1.5 * discretization.radius()});
  constexpr double round_off = 1e-6; // of lengths that are whole numbers of parts
  std::map<int, FacetDivision::Parts> parts_of_class;
  std::vector<std::array<unsigned int, 2>> n_parts;
  double unresolved = 0.;
  for (const auto &of_facet : corners) {
    const auto lengths = lengths_of(of_facet);
    const double length = std::max(lengths[0], lengths[1]);
    if (!(length > 0.)) {
      n_parts.push_back({1, 1});
      continue;
    }
    const int length_class = static_cast<int>(std::log(longest / length) / std::log(same_length));
    auto found = parts_of_class.find(length_class);
    if (found == parts_of_class.end())
      found = parts_of_class
                  .emplace(length_class, division.find_parts(longest / std::pow(same_length, length_class)))
                  .first;
    const double n = found->second.n;
    std::array<unsigned int, 2> n_of_facet{};
    for (unsigned int i = 0; i < 2; ++i) // shorter sides have fewer parts, of about the same length
      n_of_facet[i] =
          n == 1. ? 1
                  : std::max(1U, static_cast<unsigned int>(std::ceil(n * lengths[i] / length - round_off)));
    n_parts.push_back(n_of_facet);
    if (!found->second.is_enough)
      unresolved = std::max(unresolved, length);
  }

  const auto n_points = [&] {
    double sum = 0.;
    for (const auto &n : n_parts)
      sum += n[0] * n[1] > 1 ? (n[0] + 1.) * (n[1] + 1.) - 4. : 0.;
    return dealii::Utilities::MPI::sum(sum, communicator);
  };
  double n_all = n_points();
  has_divided_facets = n_all > 0.;
  while (n_all > max_interior_points) {
    unresolved = longest;
    for (auto &n : n_parts)
      n = {(n[0] + 1) / 2, (n[1] + 1) / 2};
    n_all = n_points();
  }
  unresolved_length = dealii::Utilities::MPI::max(unresolved, communicator);
  if (!has_divided_facets)
    return;

  measure_spacings(discretization, corners, n_parts, nodes);
  std::vector<ContactFacet> whole;
  for (std::size_t f = 0; f < corners.size(); ++f)
    if (n_parts[f][0] * n_parts[f][1] == 1)
      whole.push_back(facets[f]);
  std::vector<std::uint64_t> keys;
  for (const auto &facet : facets)
    keys.push_back(facet.key);
  facets = std::move(whole);
  n_whole_facets = facets.size();
  for (std::size_t f = 0; f < corners.size(); ++f)
    if (n_parts[f][0] * n_parts[f][1] > 1)
      divide(corners[f], n_parts[f], keys[f]);
}

void SlaveSurface::divide(const std::array<unsigned int, 4> &corners,
                          const std::array<unsigned int, 2> &n_parts, const std::uint64_t key) {
  DividedFacet whole{corners,
                     static_cast<unsigned int>(nodes.size()),
                     0,
                     static_cast<unsigned int>(facets.size()),
                     n_parts[0] * n_parts[1],
                     true};
  const auto reference = [&](const unsigned int a) { return nodes[corners[a]].reference; };
  const double area =
      0.5 * dealii::cross_product_3d(reference(3) - reference(0), reference(2) - reference(1)).norm();
  std::vector<unsigned int> grid;
  for (unsigned int j = 0; j <= n_parts[1]; ++j)
    for (unsigned int i = 0; i <= n_parts[0]; ++i) {
      const bool is_corner = i % n_parts[0] == 0 && j % n_parts[1] == 0;
      if (is_corner) {
        grid.push_back(corners[(i > 0 ? 1 : 0) + (j > 0 ? 2 : 0)]);
        continue;
      }
      InteriorPoint point;
      point.corners = corners;
      point.weights = facet::weights({2. * i / n_parts[0] - 1., 2. * j / n_parts[1] - 1.});
      point.key = points_per_key * key + grid.size();
      ContactPoint node;
      node.dofs.fill(dealii::numbers::invalid_dof_index);
      node.size = node.touching_gap = node.reach = 0.;
      node.stiffness = {0., 0.};
      Tensor<1, 3> position;
      for (unsigned int a = 0; a < 4; ++a) {
        const double weight = point.weights[a];
        const ContactPoint &corner = nodes[corners[a]];
        position += weight * corner.reference;
        node.size += weight * corner.size;
        node.reach += weight * corner.reach;
        node.touching_gap += weight * corner.touching_gap;
        node.stiffness.normal += weight * corner.stiffness.normal;
        node.stiffness.tangential += weight * corner.stiffness.tangential;
      }
      node.reference = dealii::Point<3>(position);
      node.spacing = std::sqrt(area / whole.n_parts);
      node.is_divided = true;
      grid.push_back(static_cast<unsigned int>(nodes.size()));
      nodes.push_back(node);
      points.push_back(point);
    }
  whole.n_points = static_cast<unsigned int>(nodes.size()) - whole.first_point;
  const unsigned int row = n_parts[0] + 1;
  for (unsigned int j = 0; j < n_parts[1]; ++j)
    for (unsigned int i = 0; i < n_parts[0]; ++i) {
      const unsigned int first = j * row + i;
      ContactFacet part{};
      part.key = points_per_key * key + first;
      part.shallow_areas.fill(SpringEnergy::no_area);
      part.nodes = {grid[first], grid[first + 1], grid[first + row], grid[first + row + 1]};
      facets.push_back(part);
    }
  divided.push_back(whole);
}

std::vector<Tensor<1, 3>> SlaveSurface::sum_normals(const std::vector<Tensor<1, 3>> &positions,
                                                    const Discretization &discretization) const {
  std::vector<Tensor<1, 3>> normals(nodes.size());
  for (const ContactFacet &facet : facets) {
    const auto x = [&](const unsigned int a) { return positions[facet.nodes[a]]; };
    const Tensor<1, 3> area = 0.5 * dealii::cross_product_3d(x(3) - x(0), x(2) - x(1));
    for (const unsigned int node : facet.nodes)
      normals[node] += area;
  }
  Vector sums = discretization.make_additive_vector();
  for (std::size_t i = 0; i < n_mesh_nodes; ++i) {
    const std::array<double, 3> values{normals[i][0], normals[i][1], normals[i][2]};
    sums.add(3, nodes[i].dofs.data(), values.data());
  }
  sums.compress(dealii::VectorOperation::add);
  Vector ghosted = discretization.make_ghosted_vector();
  ghosted = sums;
  for (std::size_t i = 0; i < n_mesh_nodes; ++i)
    normals[i] = nodes[i].displacement_in(ghosted);
  return normals;
}

void SlaveSurface::harden_springs(const double tool_thickness) {
  // Part of the distance between points, or of the tool's thickness.
  constexpr double hardening = 0.002;
  for (auto &node : nodes)
    if (node.is_divided)
      node.hardening_penetration = hardening * std::min(node.spacing, tool_thickness);
}

void SlaveSurface::add_to_dofs(const std::size_t i, const Tensor<1, 3> &value, Vector &vector) const {
  for_each_parent(i, [&](const unsigned int parent, const double weight) {
    const std::array<double, 3> values{weight * value[0], weight * value[1], weight * value[2]};
    vector.add(3, nodes[parent].dofs.data(), values.data());
  });
}

SlaveSurface::Range SlaveSurface::mesh_nodes(const NodeKeys &keys) const {
  Range range{"", 0, n_mesh_nodes, {}};
  for (std::size_t i = 0; i < n_mesh_nodes; ++i)
    range.keys.push_back(keys(nodes[i].dofs[0]));
  return range;
}

SlaveSurface::Range SlaveSurface::interior_points() const {
  Range range{"interior ", n_mesh_nodes, nodes.size(), {}};
  for (const auto &point : points)
    range.keys.push_back(point.key);
  return range;
}

SlaveSurface::Range SlaveSurface::facet_range(const bool are_parts) const {
  Range range{are_parts ? "interior " : "",
              are_parts ? n_whole_facets : 0,
              are_parts ? facets.size() : n_whole_facets,
              {}};
  for (std::size_t f = range.begin; f < range.end; ++f)
    range.keys.push_back(facets[f].key);
  return range;
}

} // namespace billet
