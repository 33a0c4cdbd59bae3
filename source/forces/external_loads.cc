// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/forces/external_loads.h"

#include "billet/discretization/boundary_facets.h"
#include "billet/errors.h"
#include "billet/usage.h"

#include <algorithm>

namespace billet {

using dealii::Tensor;

namespace {

std::array<unsigned int, 4> local_corners(const BoundaryFacet &facet, const LocalNodes &nodes) {
  std::array<unsigned int, 4> corners{};
  for (unsigned int a = 0; a < 4; ++a)
    corners[a] = nodes.find(facet.dofs[a][0]);
  return corners;
}

dealii::Point<3> centre_of(const BoundaryFacet &facet) {
  dealii::Point<3> centre;
  for (const auto &corner : facet.corners)
    centre += 0.25 * corner;
  return centre;
}

/// Returns the values of the expressions; only one value for a uniform expression.
template <class Site>
LoadValues evaluate(const AppliedLoad &load, const double t, const std::vector<Site> &sites) {
  const auto &expressions = load.expressions;
  const bool is_uniform = std::all_of(expressions.begin(), expressions.end(),
                                      [](const Expression &value) { return value.is_uniform(); });
  const std::size_t n_sets = is_uniform ? 1 : sites.size();
  LoadValues values(expressions.size(), n_sets, is_uniform);
  for (std::size_t k = 0; k < n_sets; ++k)
    for (std::size_t i = 0; i < expressions.size(); ++i)
      values.at(k)[i] = is_uniform ? expressions[i].value(t) : expressions[i].value(t, sites[k].centre);
  return values;
}

template <class Placed> std::size_t memory_of(const std::vector<Placed> &loads) {
  std::size_t bytes = 0;
  for (const Placed &placed : loads)
    bytes += sizeof(placed) + placed.sites.size() * sizeof(placed.sites.front());
  return bytes;
}

} // namespace

ExternalLoads::ExternalLoads(const Scene &scene, const LocalNodes &nodes, std::vector<double> masses)
    : nodes_(nodes), masses_(std::move(masses)) {
  for (std::size_t b = 0; b < scene.bodies().size(); ++b)
    for (const AppliedLoad &load : scene.bodies()[b].loads)
      std::visit([&](const auto &action) { place(load, *action, b); }, load.load.action);
  memory_.set(memory_of(on_bodies_) + memory_of(on_faces_) + memory_of(on_nodes_));
  // Detects expressions without a value before any output is written.
  fail_together(nodes.discretization().communicator(), [&] {
    check_before_start([&] {
      const NodalVectors at_rest = nodes.make_vectors();
      NodalVectors forces = at_rest;
      add_forces(0., at_rest, at_rest, forces);
    });
  });
}

void ExternalLoads::place(const AppliedLoad &load, const BodyLoad &action, const std::size_t body) {
  std::vector<unsigned int> nodes;
  for (const auto &element : nodes_.elements(body))
    nodes.insert(nodes.end(), element.begin(), element.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  on_bodies_.push_back({&load, &action, std::move(nodes)});
}

void ExternalLoads::place(const AppliedLoad &load, const FaceLoad &action, const std::size_t body) {
  std::vector<LoadedFace> faces;
  for (const auto &facet : collect_boundary_facets(nodes_.discretization(), body, load.boundary_ids))
    faces.push_back({local_corners(facet, nodes_), centre_of(facet)});
  on_faces_.push_back({&load, &action, std::move(faces)});
}

void ExternalLoads::place(const AppliedLoad &load, const NodalLoad &action, const std::size_t body) {
  std::vector<LoadedNode> nodes;
  for (const auto &facet : collect_boundary_facets(nodes_.discretization(), body, load.boundary_ids)) {
    std::array<double, 4> areas{};
    for (const auto &point : facet_points()) {
      const Tensor<1, 3> area =
          point.area_vector([&](const unsigned int a) { return Tensor<1, 3>(facet.corners[a]); });
      for (unsigned int a = 0; a < 4; ++a)
        areas[a] += point.N[a] * area.norm();
    }
    const auto corners = local_corners(facet, nodes_);
    const Tensor<1, 3> normal = facet.area_vector() / facet.area_vector().norm();
    for (unsigned int a = 0; a < 4; ++a)
      nodes.push_back({corners[a], areas[a], normal, centre_of(facet)});
  }
  on_nodes_.push_back({&load, &action, std::move(nodes)});
}

void ExternalLoads::add_forces(const double t, const NodalVectors &displacements,
                               const NodalVectors &velocities, NodalVectors &forces) const {
  std::size_t n_loads = on_bodies_.size() + on_faces_.size();
  for (const auto &placed : on_nodes_)
    n_loads += placed.sites.size();
  Usage::count_if(n_loads > 0, Capability::loads, n_loads);
  const NodalMotion at = motion(displacements, velocities);
  for (const auto &[load, action, nodes] : on_bodies_) {
    std::vector<double> values;
    for (const Expression &expression : load->expressions)
      values.push_back(expression.value(t));
    const Tensor<1, 3> a = action->acceleration(values.data());
    for (const unsigned int node : nodes)
      add_vector(forces.data(), node, masses_[node] * a);
  }
  for (const auto &[load, action, faces] : on_faces_)
    action->add_forces(faces, evaluate(*load, t, faces), at, forces.data());
  for (const auto &[load, action, nodes] : on_nodes_)
    action->add_forces(nodes, evaluate(*load, t, nodes), at, forces.data());
}

void ExternalLoads::add_tangent(const double t, const NodalVectors &displacements,
                                const NodalVectors &velocities, const double damping_factor,
                                const TangentSystem &system) const {
  const NodalMotion at = motion(displacements, velocities);
  dealii::FullMatrix<double> of_face(12, 12), of_node(3, 3);
  std::vector<DofIndex> face_dofs(12), node_dofs(3);
  for (const auto &[load, action, faces] : on_faces_) {
    if (action->tangent() == LoadTangent::none)
      continue;
    const LoadValues values = evaluate(*load, t, faces);
    for (std::size_t f = 0; f < faces.size(); ++f) {
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int i = 0; i < 3; ++i)
          face_dofs[3 * a + i] = nodes_.dofs(faces[f].nodes[a])[i];
      of_face = 0.;
      action->add_tangent(faces[f], values.at(f), at, damping_factor, of_face);
      system.add(of_face, face_dofs);
    }
  }
  for (const auto &[load, action, nodes] : on_nodes_) {
    if (action->tangent() == LoadTangent::none)
      continue;
    const LoadValues values = evaluate(*load, t, nodes);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      std::copy_n(nodes_.dofs(nodes[k].node).begin(), 3, node_dofs.begin());
      of_node = 0.;
      action->add_tangent(nodes[k], values.at(k), at, damping_factor, of_node);
      system.add(of_node, node_dofs);
    }
  }
}

void ExternalLoads::add_bounds(NodalVectors &bounds) const {
  for (const auto &placed : on_nodes_) {
    if (!placed.load->load.limits_steps())
      continue;
    const auto [stiffness, damping] = placed.action->bound();
    for (const LoadedNode &at : placed.sites)
      add_vector(bounds.data(), at.node, Tensor<1, 3>({stiffness * at.area, damping * at.area, 0.}));
  }
}

} // namespace billet
