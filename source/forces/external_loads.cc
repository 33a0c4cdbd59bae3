// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/forces/external_loads.h"

#include "billet/discretization/boundary_facets.h"
#include "billet/errors.h"
#include "billet/usage.h"

#include <deal.II/lac/full_matrix.h>

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

} // namespace

ExternalLoads::ExternalLoads(const Scene &scene, const LocalNodes &nodes, std::vector<double> masses)
    : nodes_(nodes), masses_(std::move(masses)) {
  for (std::size_t b = 0; b < scene.bodies().size(); ++b)
    for (const auto &load : scene.bodies()[b].loads)
      switch (load.kind) {
      case Load::Kind::acceleration: {
        Acceleration acceleration{&load, {}};
        for (const auto &element : nodes.elements(b))
          acceleration.nodes.insert(acceleration.nodes.end(), element.begin(), element.end());
        auto &all = acceleration.nodes;
        std::sort(all.begin(), all.end());
        all.erase(std::unique(all.begin(), all.end()), all.end());
        accelerations_.push_back(acceleration);
        break;
      }
      case Load::Kind::pressure: {
        Pressure pressure{&load, {}};
        for (const auto &facet : collect_boundary_facets(nodes.discretization(), b, load.boundary_ids)) {
          dealii::Point<3> centre;
          for (const auto &corner : facet.corners)
            centre += 0.25 * corner;
          pressure.facets.push_back({local_corners(facet, nodes), centre});
        }
        pressures_.push_back(pressure);
        break;
      }
      case Load::Kind::spring:
      case Load::Kind::dashpot:
        add_resistances(load, b);
        break;
      }
  std::size_t bytes = resistances_.size() * sizeof(Resistance);
  for (const auto &acceleration : accelerations_)
    bytes += sizeof(acceleration) + acceleration.nodes.size() * sizeof(unsigned int);
  for (const auto &pressure : pressures_)
    bytes += sizeof(pressure) + pressure.facets.size() * sizeof(PressedFacet);
  memory_.set(bytes);
  // An expression without a value shows before anything is written.
  fail_together(nodes.discretization().communicator(), [&] {
    check_before_start([&] {
      const NodalVectors at_rest = nodes.make_vectors();
      NodalVectors forces = at_rest;
      add_forces(0., at_rest, at_rest, forces);
    });
  });
}

void ExternalLoads::add_resistances(const Load &load, const std::size_t body) {
  for (const auto &facet : collect_boundary_facets(nodes_.discretization(), body, load.boundary_ids)) {
    std::array<double, 4> areas{};
    for (const auto &point : facet_points()) {
      const Tensor<1, 3> area =
          point.area_vector([&](const unsigned int a) { return Tensor<1, 3>(facet.corners[a]); });
      for (unsigned int a = 0; a < 4; ++a)
        areas[a] += point.N[a] * area.norm();
    }
    const auto corners = local_corners(facet, nodes_);
    for (unsigned int a = 0; a < 4; ++a) {
      Resistance resistance{corners[a], load.direction != Load::Direction::all, load.vector, 0., 0.};
      if (load.direction == Load::Direction::normal)
        resistance.direction = facet.area_vector() / facet.area_vector().norm();
      (load.kind == Load::Kind::spring ? resistance.stiffness : resistance.damping) =
          load.coefficient * areas[a];
      resistances_.push_back(resistance);
    }
  }
}

void ExternalLoads::add_forces(const double t, const NodalVectors &displacements,
                               const NodalVectors &velocities, NodalVectors &forces) const {
  const std::size_t n_loads = accelerations_.size() + pressures_.size() + resistances_.size();
  Usage::count_if(n_loads > 0, Capability::loads, n_loads);
  for (const auto &acceleration : accelerations_) {
    Tensor<1, 3> a;
    for (unsigned int i = 0; i < 3; ++i)
      a[i] = acceleration.load->values[i].value(t);
    for (const unsigned int node : acceleration.nodes)
      add_vector(forces.data(), node, masses_[node] * a);
  }
  for (const auto &pressure : pressures_) {
    const Expression &pressure_at = pressure.load->values[0];
    double p = pressure_at.is_uniform() ? pressure_at.value(t) : 0.;
    for (const auto &facet : pressure.facets) {
      if (!pressure_at.is_uniform())
        p = pressure_at.value(t, facet.centre);
      std::array<Tensor<1, 3>, 4> positions;
      for (unsigned int a = 0; a < 4; ++a)
        positions[a] = get_vector(nodes_.positions().data(), facet.nodes[a]) +
                       get_vector(displacements.data(), facet.nodes[a]);
      for (const auto &point : facet_points()) {
        const Tensor<1, 3> area = point.area_vector([&](const unsigned int a) { return positions[a]; });
        for (unsigned int a = 0; a < 4; ++a)
          add_vector(forces.data(), facet.nodes[a], -p * point.N[a] * area);
      }
    }
  }
  for (const auto &resistance : resistances_) {
    Tensor<1, 3> force = -resistance.stiffness * get_vector(displacements.data(), resistance.node) -
                         resistance.damping * get_vector(velocities.data(), resistance.node);
    if (resistance.has_direction)
      force = (force * resistance.direction) * resistance.direction;
    add_vector(forces.data(), resistance.node, force);
  }
}

void ExternalLoads::add_tangent(const double t, const NodalVectors &displacements,
                                const double damping_factor, const TangentSystem &system) const {
  for (const auto &pressure : pressures_)
    for (const auto &facet : pressure.facets)
      add_pressure_tangent(facet, pressure.load->values[0].value(t, facet.centre), displacements, system);

  dealii::FullMatrix<double> matrix(3, 3);
  std::vector<DofIndex> dofs(3);
  for (const auto &resistance : resistances_) {
    const double factor = resistance.stiffness + damping_factor * resistance.damping;
    for (unsigned int i = 0; i < 3; ++i) {
      dofs[i] = nodes_.dofs(resistance.node)[i];
      for (unsigned int j = 0; j < 3; ++j)
        matrix(i, j) = factor * (resistance.has_direction ? resistance.direction[i] * resistance.direction[j]
                                                          : (i == j ? 1. : 0.));
    }
    system.add(matrix, dofs);
  }
}

void ExternalLoads::add_pressure_tangent(const PressedFacet &facet, const double pressure,
                                         const NodalVectors &displacements,
                                         const TangentSystem &system) const {
  dealii::FullMatrix<double> matrix(12, 12);
  std::vector<DofIndex> dofs(12);
  std::array<Tensor<1, 3>, 4> positions;
  for (unsigned int a = 0; a < 4; ++a) {
    positions[a] = get_vector(nodes_.positions().data(), facet.nodes[a]) +
                   get_vector(displacements.data(), facet.nodes[a]);
    for (unsigned int i = 0; i < 3; ++i)
      dofs[3 * a + i] = nodes_.dofs(facet.nodes[a])[i];
  }
  for (const auto &point : facet_points()) {
    const auto [g_1, g_2] = point.tangents([&](const unsigned int a) { return positions[a]; });
    for (unsigned int b = 0; b < 4; ++b)
      for (unsigned int j = 0; j < 3; ++j) {
        Tensor<1, 3> e;
        e[j] = 1.;
        const Tensor<1, 3> change = point.N_xi[b] * dealii::cross_product_3d(e, g_2) +
                                    point.N_eta[b] * dealii::cross_product_3d(g_1, e);
        for (unsigned int a = 0; a < 4; ++a)
          for (unsigned int i = 0; i < 3; ++i)
            matrix(3 * a + i, 3 * b + j) += pressure * point.N[a] * change[i];
      }
  }
  system.add(matrix, dofs);
}

void ExternalLoads::add_bounds(NodalVectors &bounds) const {
  for (const auto &resistance : resistances_)
    add_vector(bounds.data(), resistance.node, Tensor<1, 3>({resistance.stiffness, resistance.damping, 0.}));
}

} // namespace billet
