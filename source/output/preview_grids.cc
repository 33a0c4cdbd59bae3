// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/output/preview_grids.h"

#include "billet/discretization/supports.h"
#include "billet/errors.h"
#include "billet/fail_together.h"
#include "billet/forces/external_loads.h"
#include "billet/forces/inertia.h"
#include "billet/geometry/frame.h"
#include "billet/output/snapshot_grids.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace billet {

using dealii::Tensor;
namespace mpi = dealii::Utilities::MPI;

namespace {

/// Dimensions of arrows, relative to their length, and lengths relative to half the diagonal of the
/// scene.
struct Sizes {
  static constexpr double shaft = 0.03, head = 0.09, head_length = 0.3;
  static constexpr double support = 0.06;        ///< of a support that does not move
  static constexpr double longest_slender = 0.1; ///< whose shaft and head are as wide as given here
  static constexpr double longest_load = 0.25;
};

/// Adds a square shaft and a pyramid.
/// `radius`: half the diagonal of the scene.
void add_arrow(Grid &grid, const Arrow &arrow, const double radius) {
  const double length = (arrow.to - arrow.from).norm();
  if (!(length > 0.))
    return;
  const double size = std::min(length, Sizes::longest_slender * radius); // of shaft and head
  const Tensor<1, 3> direction = (arrow.to - arrow.from) / length;
  const Frame frame = Frame::from_normal(direction);
  const Tensor<1, 3> neck = arrow.to - Sizes::head_length * size * direction;
  const std::uint64_t first = grid.n_points();
  const auto add_square = [&](const Tensor<1, 3> &centre, const double width) {
    for (const auto &sign : {std::array<double, 2>{-1., -1.}, {1., -1.}, {1., 1.}, {-1., 1.}}) {
      const Tensor<1, 3> corner = centre + width * size * (sign[0] * frame.q + sign[1] * frame.r);
      for (unsigned int i = 0; i < 3; ++i)
        grid.points.push_back(corner[i]);
    }
  };
  add_square(arrow.from, Sizes::shaft); // points 0 to 3
  add_square(neck, Sizes::shaft);       // 4 to 7
  add_square(neck, Sizes::head);        // 8 to 11
  for (unsigned int i = 0; i < 3; ++i)  // 12
    grid.points.push_back(arrow.to[i]);
  const auto add_cell = [&](const std::vector<std::uint64_t> &points) {
    for (const std::uint64_t point : points)
      grid.connectivity.push_back(first + point);
    grid.sizes.push_back(static_cast<unsigned int>(points.size()));
    for (unsigned int i = 0; i < 3; ++i)
      grid.cell_fields.front().values.push_back(arrow.value[i]);
  };
  for (std::uint64_t side = 0; side < 4; ++side) {
    const std::uint64_t next = (side + 1) % 4;
    add_cell({side, next, 4 + next, 4 + side});
    add_cell({8 + side, 8 + next, 12});
  }
  add_cell({8, 11, 10, 9});
}

/// Placements of the tools at the end of their prescribed motions.
Placement placement_at_end(const Tool &tool, const double end) {
  constexpr unsigned int n_samples = 100;
  const double last = std::min(end, tool.removal_time());
  for (unsigned int i = 0; i < n_samples; ++i)
    try {
      return tool.placement(last * (n_samples - i) / n_samples);
    } catch (const SolutionFailure &) { // the motion is not defined there; the run will report it
    }
  return tool.placement(0.);
}

/// Returns whether arrows of this body come from outside at a node, by the centre of the bodies.
double outward_sign(const Tensor<1, 3> &direction, const Tensor<1, 3> &position, const Tensor<1, 3> &centre) {
  return direction * (position - centre) < 0. ? -1. : 1.;
}

/// Returns the sum of the absolute forces at the nodes of all ranks. Collective.
double sum_of_norms(const LocalNodes &nodes, const NodalVectors &forces) {
  double sum = 0.;
  for (unsigned int node = 0; node < nodes.size(); ++node)
    if (nodes.is_owned(node))
      sum += get_vector(forces.data(), node).norm();
  return mpi::sum(sum, nodes.discretization().communicator());
}

/// Returns the forces of a load at the time at which they are largest, of fifty times; sets that
/// time. Collective.
NodalVectors find_max_forces(const Scene &scene, const ExternalLoads &loads, const AppliedLoad &load,
                             const LocalNodes &nodes, double &time) {
  const NodalVectors at_rest = nodes.make_vectors();
  NodalVectors largest = nodes.make_vectors();
  double max_sum = 0.;
  constexpr unsigned int n_samples = 50;
  for (unsigned int i = 1; i <= n_samples; ++i) {
    const double t = scene.parameters().time_stepping.end_time * i / n_samples;
    NodalVectors forces = nodes.make_vectors();
    try {
      fail_together(nodes.discretization().communicator(),
                    [&] { loads.add_forces_of(load, t, at_rest, at_rest, forces); });
    } catch (const SolutionFailure &) { // a load is not defined there; the run will report it
      continue;
    }
    nodes.sum_shared(forces);
    const double sum = sum_of_norms(nodes, forces);
    constexpr double rounding = 1e-9;
    if (sum > max_sum * (1. + rounding)) {
      max_sum = sum;
      largest = forces;
      time = t;
    }
  }
  return largest;
}

/// Returns arrows that end at the nodes of this rank. Collective.
std::vector<Arrow> make_load_arrows(const LocalNodes &nodes, const NodalVectors &forces) {
  const Discretization &discretization = nodes.discretization();
  double most = 0.;
  for (unsigned int node = 0; node < nodes.size(); ++node)
    most = std::max(most, get_vector(forces.data(), node).norm());
  most = mpi::max(most, discretization.communicator());
  std::vector<Arrow> arrows;
  for (unsigned int node = 0; node < nodes.size() && most > 0.; ++node) {
    const Tensor<1, 3> force = get_vector(forces.data(), node);
    constexpr double negligible = 1e-6; // of the largest: round-off, such as that of balanced parts
    if (!nodes.is_owned(node) || !(force.norm() > negligible * most))
      continue;
    const Tensor<1, 3> position = get_vector(nodes.positions().data(), node);
    arrows.push_back(
        {position - Sizes::longest_load * discretization.radius() / most * force, position, force});
  }
  return arrows;
}

} // namespace

Grid make_arrow_grid(const std::string &group, const std::string &name, const std::string &value_name,
                     const std::vector<Arrow> &arrows, const double radius, const MPI_Comm communicator) {
  std::vector<double> own;
  for (const Arrow &arrow : arrows)
    for (const Tensor<1, 3> &part : {arrow.from, arrow.to, arrow.value})
      for (unsigned int i = 0; i < 3; ++i)
        own.push_back(part[i]);
  Grid grid{group, name};
  grid.cell_fields.push_back({value_name, 3});
  for (const auto &of_rank : mpi::gather(communicator, own)) // empty but on the first rank
    for (std::size_t i = 0; i + 9 <= of_rank.size(); i += 9) {
      const double *x = &of_rank[i];
      add_arrow(grid,
                {Tensor<1, 3>({x[0], x[1], x[2]}), Tensor<1, 3>({x[3], x[4], x[5]}),
                 Tensor<1, 3>({x[6], x[7], x[8]})},
                radius);
    }
  return grid;
}

std::vector<Arrow> find_support_arrows(const Scene &scene, const Discretization &discretization,
                                       const std::size_t body) {
  const auto &constraints = scene.bodies()[body].constraints;
  std::vector<Arrow> arrows;
  const auto all = [](const Constraint &) { return true; }; // also those that begin later
  for (const auto &[dof, node] : collect_constrained_nodes(scene, discretization, all)) {
    if (!discretization.owned_dofs().is_element(dof))
      continue;
    for (const Constraint &constraint : constraints) {
      // A section has its sides everywhere: their arrows would hide all others.
      if (constraint.is_of_section ||
          std::find(node.constraints.begin(), node.constraints.end(), &constraint) == node.constraints.end())
        continue;
      const Tensor<1, 3> direction = constraint.direction(node.position);
      const double value = constraint.value != nullptr
                               ? constraint.value->value(scene.parameters().time_stepping.end_time,
                                                         dealii::Point<3>(node.position))
                               : 0.;
      const Tensor<1, 3> motion = value * direction;
      if (value != 0.)
        arrows.push_back({node.position, node.position + motion, motion});
      else
        arrows.push_back({node.position + outward_sign(direction, node.position, discretization.centre()) *
                                              Sizes::support * discretization.radius() * direction,
                          node.position, motion});
    }
  }
  return arrows;
}

std::vector<LoadArrows> find_load_arrows(const Scene &scene, const Discretization &discretization) {
  std::vector<LoadArrows> result;
  if (std::all_of(scene.bodies().begin(), scene.bodies().end(),
                  [](const Body &body) { return body.loads.empty(); }))
    return result;
  const LocalNodes nodes(discretization);
  const ExternalLoads loads(scene, nodes, Inertia(scene, discretization, false).nodal_masses(nodes));
  for (std::size_t body = 0; body < scene.bodies().size(); ++body)
    for (std::size_t i = 0; i < scene.bodies()[body].loads.size(); ++i) {
      result.emplace_back();
      result.back().name = scene.parameters().bodies[body].loads[i].name + " of " + scene.bodies()[body].name;
      const NodalVectors forces =
          find_max_forces(scene, loads, scene.bodies()[body].loads[i], nodes, result.back().time);
      result.back().arrows = make_load_arrows(nodes, forces);
    }
  return result;
}

std::vector<Grid> make_preview_grids(const Scene &scene, const Discretization &discretization) {
  const MPI_Comm communicator = discretization.communicator();
  std::vector<Grid> grids;
  for (std::size_t t = 0; t < scene.tools().size(); ++t)
    grids.push_back(
        make_tool_grid(discretization, scene.tools()[t], t,
                       placement_at_end(scene.tools()[t], scene.parameters().time_stepping.end_time),
                       preview_group::tools_at_end));
  for (std::size_t body = 0; body < scene.bodies().size(); ++body)
    if (!scene.bodies()[body].constraints.empty()) {
      std::vector<Arrow> arrows;
      fail_together(communicator, [&] { arrows = find_support_arrows(scene, discretization, body); });
      grids.push_back(make_arrow_grid(preview_group::supports, scene.bodies()[body].name,
                                      "displacement_at_end", arrows, discretization.radius(), communicator));
    }
  for (const LoadArrows &load : find_load_arrows(scene, discretization))
    grids.push_back(make_arrow_grid(preview_group::loads, load.name, "force", load.arrows,
                                    discretization.radius(), communicator));
  return grids;
}

} // namespace billet
