// SPDX-License-Identifier: LGPL-2.1-or-later
// Points of contact inside facets, where the tool could enter between their nodes.
#include "billet/contact/facet_division.h"
#include "billet/contact/rigid_contact.h"
#include "billet/geometry/facet_projection.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace billet {

using dealii::Tensor;

namespace {

// Points inside the facets of a pair, of all ranks: half a kilobyte each. Beyond it facets have fewer parts.
constexpr double max_interior_points = 400'000.;

// Facets whose lengths differ by less than this factor have the same number of parts.
const double same_length = std::pow(2., 0.125);

constexpr std::uint64_t points_per_key = 1024; // > (FacetDivision::max_parts + 1)²

} // namespace

void RigidContact::divide_facets(const Discretization &discretization,
                                 const std::vector<std::array<unsigned int, 4>> &corners) {
  n_whole_facets_ = facets_.size();
  // Longest sides along ξ and η.
  const auto lengths_of = [&](const std::array<unsigned int, 4> &nodes) {
    const auto side = [&](const unsigned int a, const unsigned int b) {
      return (nodes_[nodes[b]].reference - nodes_[nodes[a]].reference).norm();
    };
    return std::array<double, 2>{std::max(side(0, 1), side(2, 3)), std::max(side(0, 2), side(1, 3))};
  };
  double longest = 0.;
  for (const auto &nodes : corners) {
    const auto lengths = lengths_of(nodes);
    longest = std::max({longest, lengths[0], lengths[1]});
  }
  longest = dealii::Utilities::MPI::max(longest, communicator_);
  if (longest == 0.)
    return;

  const Placement placement = tool_.placement(0.);
  const FacetDivision division(tool_.surface(),
                               {placement.to_tool(discretization.centre()), 1.5 * discretization.radius()});
  std::map<int, FacetDivision::Parts> parts_of_class;
  std::vector<std::array<unsigned int, 2>> n_parts;
  double unresolved = 0.;
  for (const auto &nodes : corners) {
    const auto lengths = lengths_of(nodes);
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
    for (unsigned int i = 0; i < 2; ++i) // of the shorter sides as many as make parts as long as others
      n_of_facet[i] =
          n == 1. ? 1 : std::max(1U, static_cast<unsigned int>(std::ceil(n * lengths[i] / length - 1e-6)));
    n_parts.push_back(n_of_facet);
    if (!found->second.is_enough)
      unresolved = std::max(unresolved, length);
  }

  const auto n_points = [&] {
    double sum = 0.;
    for (const auto &n : n_parts)
      sum += n[0] * n[1] > 1 ? (n[0] + 1.) * (n[1] + 1.) - 4. : 0.;
    return dealii::Utilities::MPI::sum(sum, communicator_);
  };
  double n_all = n_points();
  has_divided_facets_ = n_all > 0.;
  while (n_all > max_interior_points) {
    unresolved = longest;
    for (auto &n : n_parts)
      n = {(n[0] + 1) / 2, (n[1] + 1) / 2};
    n_all = n_points();
  }
  unresolved_length_ = dealii::Utilities::MPI::max(unresolved, communicator_);
  if (!has_divided_facets_)
    return;

  // The root of the mean area of the parts around each node.
  Vector sums = discretization.make_additive_vector();
  for (std::size_t f = 0; f < corners.size(); ++f) {
    const auto x = [&](const unsigned int a) { return nodes_[corners[f][a]].reference; };
    const double area = 0.5 * dealii::cross_product_3d(x(3) - x(0), x(2) - x(1)).norm();
    const unsigned int n = n_parts[f][0] * n_parts[f][1];
    const std::array<double, 3> values{area / n, 1., n > 1 ? 1. : 0.};
    for (const unsigned int i : corners[f])
      sums.add(3, nodes_[i].dofs.data(), values.data());
  }
  sums.compress(dealii::VectorOperation::add);
  Vector ghosted = discretization.make_ghosted_vector();
  ghosted = sums;
  for (auto &node : nodes_) {
    node.spacing = std::sqrt(ghosted(node.dofs[0]) / ghosted(node.dofs[1]));
    node.is_divided = ghosted(node.dofs[2]) > 0.;
  }

  std::vector<Facet> whole;
  for (std::size_t f = 0; f < corners.size(); ++f)
    if (n_parts[f][0] * n_parts[f][1] == 1)
      whole.push_back(facets_[f]);
  std::vector<std::uint64_t> keys;
  for (const auto &facet : facets_)
    keys.push_back(facet.key);
  facets_ = std::move(whole);
  n_whole_facets_ = facets_.size();
  for (std::size_t f = 0; f < corners.size(); ++f)
    if (n_parts[f][0] * n_parts[f][1] > 1)
      divide(corners[f], n_parts[f], keys[f]);
}

void RigidContact::divide(const std::array<unsigned int, 4> &corners,
                          const std::array<unsigned int, 2> &n_parts, const std::uint64_t key) {
  DividedFacet divided{corners,
                       static_cast<unsigned int>(nodes_.size()),
                       0,
                       static_cast<unsigned int>(facets_.size()),
                       n_parts[0] * n_parts[1],
                       true};
  const auto reference = [&](const unsigned int a) { return nodes_[corners[a]].reference; };
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
      Node node;
      node.dofs.fill(dealii::numbers::invalid_dof_index);
      node.size = node.touching_gap = node.reach = 0.;
      node.stiffness = {0., 0.};
      Tensor<1, 3> position;
      for (unsigned int a = 0; a < 4; ++a) {
        const double weight = point.weights[a];
        const Node &corner = nodes_[corners[a]];
        position += weight * corner.reference;
        node.size += weight * corner.size;
        node.reach += weight * corner.reach;
        node.touching_gap += weight * corner.touching_gap;
        node.stiffness.normal += weight * corner.stiffness.normal;
        node.stiffness.tangential += weight * corner.stiffness.tangential;
      }
      node.reference = dealii::Point<3>(position);
      node.spacing = std::sqrt(area / divided.n_parts);
      node.is_divided = true;
      grid.push_back(static_cast<unsigned int>(nodes_.size()));
      nodes_.push_back(node);
      points_.push_back(point);
    }
  divided.n_points = static_cast<unsigned int>(nodes_.size()) - divided.first_point;
  const unsigned int row = n_parts[0] + 1;
  for (unsigned int j = 0; j < n_parts[1]; ++j)
    for (unsigned int i = 0; i < n_parts[0]; ++i) {
      const unsigned int first = j * row + i;
      Facet part{};
      part.key = points_per_key * key + first;
      part.shallow_areas.fill(SpringEnergy::no_area);
      part.nodes = {grid[first], grid[first + 1], grid[first + row], grid[first + row + 1]};
      facets_.push_back(part);
    }
  divided_.push_back(divided);
}

void RigidContact::harden_springs() {
  if (!is_explicit_ || pair_.input->has_own_penalty || !thin_tool_)
    return;
  constexpr double hardening = 0.002; // part of what is between points, or of the tool's thickness
  for (auto &node : nodes_)
    if (node.is_divided)
      node.hardening_depth = hardening * std::min(node.spacing, thin_tool_->thickness());
}

double RigidContact::stiffness_ahead(const std::size_t i) const {
  const double gap = states_[i].gap;
  return nodes_[i].spring().slope(std::max(0., -gap) + std::max(0., nodes_[i].gap_n - gap));
}

bool RigidContact::is_far(DividedFacet &divided) {
  if (divided.may_touch)
    return false;
  // Gaps are distances, so that none in the facet is less than that of the nearest corner less the way there.
  std::array<const ToolContactState *, 4> corners{};
  double least = std::numeric_limits<double>::infinity(), approach = 0., size = 0.;
  for (unsigned int a = 0; a < 4; ++a) {
    const Node &node = nodes_[divided.corners[a]];
    corners[a] = &states_[divided.corners[a]];
    if (corners[a]->is_behind)
      return false;
    least = std::min(least, corners[a]->gap);
    approach = std::max(approach, node.gap_n - corners[a]->gap);
    size = std::max(size, node.size);
  }
  const double way = 0.5 * std::max((corners[3]->position - corners[0]->position).norm(),
                                    (corners[2]->position - corners[1]->position).norm());
  const double gap = least - way;
  if (!(gap > near_gap * size + near_steps * approach))
    return false;
  for (std::size_t i = divided.first_point; i < divided.first_point + divided.n_points; ++i) {
    ToolContactState &state = states_[i];
    state.position = at(i, [&](const std::size_t parent) { return states_[parent].position; });
    state.gap = gap;
    if (!friction_.empty()) // it was open before, too
      friction_[i].tool_position = placement_.to_tool(state.position);
  }
  return true;
}

void RigidContact::add_to_dofs(const std::size_t i, const Tensor<1, 3> &value, Vector &vector) const {
  for_each_parent(i, [&](const unsigned int parent, const double weight) {
    const std::array<double, 3> values{weight * value[0], weight * value[1], weight * value[2]};
    vector.add(3, nodes_[parent].dofs.data(), values.data());
  });
}

} // namespace billet
