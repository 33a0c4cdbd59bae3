// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/rigid_contact.h"

#include <deal.II/base/array_view.h>
#include <deal.II/lac/full_matrix.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace billet {

using dealii::Tensor;

ContactLoad &ContactLoad::operator+=(const ContactLoad &other) {
  force += other.force;
  moment += other.moment;
  area += other.area;
  stored_energy += other.stored_energy;
  dissipation += other.dissipation;
  deepest = std::max(deepest, other.deepest);
  return *this;
}

RigidContact::RigidContact(const Scene &scene, const std::size_t pair, const Discretization &discretization,
                           const ContactTangent tangent)
    : pair_(scene.pairs()[pair]), tool_(scene.tools()[pair_.tool]),
      communicator_(discretization.communicator()), tangent_(tangent) {
  collect_facets(discretization);
  set_penalties(scene, discretization);
  start_step(0., 0.);
  if (pair_.friction_coefficient > 0.)
    friction_n_.resize(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const auto X = placement_.to_tool(nodes_[i].reference);
    nodes_[i].gap = nodes_[i].gap_n = tool_.surface().project(X).gap;
    if (!friction_n_.empty())
      friction_n_[i].tool_position = X;
  }
  friction_ = friction_n_;
}

void RigidContact::collect_facets(const Discretization &discretization) {
  std::map<DofIndex, unsigned int> index;
  for (const auto &element : discretization.elements(pair_.body))
    for (const unsigned int f : element.cell->face_indices()) {
      const auto face = element.cell->face(f);
      if (!face->at_boundary() || std::find(pair_.boundary_ids.begin(), pair_.boundary_ids.end(),
                                            face->boundary_id()) == pair_.boundary_ids.end())
        continue;
      Facet facet{};
      for (unsigned int v = 0; v < 4; ++v) {
        const DofIndex first = face->vertex_dof_index(v, 0);
        const auto found = index.emplace(first, static_cast<unsigned int>(nodes_.size()));
        if (found.second) {
          Node node;
          for (unsigned int i = 0; i < 3; ++i)
            node.dofs[i] = face->vertex_dof_index(v, i);
          node.reference = face->vertex(v);
          node.position = node.reference;
          nodes_.push_back(node);
        }
        facet.nodes[v] = found.first->second;
      }
      const Tensor<1, 3> area_vector =
          dealii::cross_product_3d(face->vertex(3) - face->vertex(0), face->vertex(2) - face->vertex(1));
      if (area_vector * (face->center() - element.cell->center()) < 0.)
        std::swap(facet.nodes[1], facet.nodes[2]);
      facets_.push_back(facet);
    }
}

void RigidContact::set_penalties(const Scene &scene, const Discretization &discretization) {
  // Facet size at a node: root of the mean area of the facets around it, on all ranks.
  Vector sums = discretization.make_additive_vector();
  for (const auto &facet : facets_) {
    std::array<Tensor<1, 3>, 4> x;
    for (unsigned int a = 0; a < 4; ++a)
      x[a] = nodes_[facet.nodes[a]].reference;
    const double area = 0.5 * dealii::cross_product_3d(x[3] - x[0], x[2] - x[1]).norm();
    for (const unsigned int node : facet.nodes) {
      const std::array<double, 2> values{area, 1.};
      sums.add(2, nodes_[node].dofs.data(), values.data());
    }
  }
  sums.compress(dealii::VectorOperation::add);
  Vector ghosted = discretization.make_ghosted_vector();
  ghosted = sums;
  const double young_modulus = scene.bodies()[pair_.body].young_modulus;
  for (auto &node : nodes_) {
    const double h = std::sqrt(ghosted(node.dofs[0]) / ghosted(node.dofs[1]));
    node.stiffness = {pair_.scaled_penalty(pair_.normal_penalty, young_modulus, h),
                      pair_.scaled_penalty(pair_.tangential_penalty, young_modulus, h),
                      pair_.friction_coefficient};
  }
}

void RigidContact::start_step(const double t_n, const double t) {
  placement_n_ = tool_.placement(t_n);
  placement_ = tool_.placement(t);
}

void RigidContact::update(const Vector &displacements) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    Node &node = nodes_[i];
    for (unsigned int c = 0; c < 3; ++c)
      node.position[c] = node.reference[c] + displacements(node.dofs[c]);
    const auto projection = tool_.surface().project(placement_.to_tool(node.position));
    node.normal = placement_.rotation * projection.normal;
    node.gap = projection.gap;
    node.slip_increment = node.dissipation = node.tangential_energy = 0.;
    // A node that starts exactly on the tool counts as touching: its stiffness may be all that holds the
    // body.
    const bool touches = node.gap < 0. || (node.gap == 0. && node.gap_n <= 0.);
    if (!touches) {
      node.status = ContactStatus::open;
      node.pressure = 0.;
      node.traction = 0.;
      node.tangent = 0.;
      if (!friction_.empty()) {
        friction_[i].is_active = false;
        friction_[i].tangential = {};
        friction_[i].slip = friction_n_[i].slip;
      }
    } else if (!friction_.empty())
      apply_friction(node, friction_n_[i], friction_[i]);
    else {
      const FrameTraction t = compute_frictionless_traction(node.stiffness.normal, node.gap);
      node.status = t.status;
      node.pressure = t.pressure;
      node.traction = t.pressure * node.normal;
      node.tangent = node.stiffness.normal * dealii::outer_product(node.normal, node.normal);
    }
    if (!friction_.empty())
      friction_[i].tool_position = placement_.to_tool(node.position);
  }
}

void RigidContact::apply_friction(Node &node, const FrictionHistory &history_n,
                                  FrictionHistory &history) const {
  history.frame = history_n.is_active
                      ? history_n.frame.transported(
                            placement_.rotation * dealii::transpose(placement_n_.rotation), node.normal)
                      : Frame::from_normal(node.normal);
  const Frame &Z = history.frame;

  // Relative displacement over the step, against the tool's material point that was at the node (eq. (33),
  // with the tool's motion).
  const Tensor<1, 3> displacement = node.position - placement_.to_space(history_n.tool_position);
  const std::array<double, 2> increment{displacement * Z.q, displacement * Z.r};

  // A node that enters within the step has slid along the tool for the part φ = g/(g − g_n) of it only.
  ContactStiffness stiffness = node.stiffness;
  std::array<double, 2> slope{};
  double fraction = 1.;
  if (!history_n.is_active && node.gap_n > 0.) {
    fraction = node.gap / (node.gap - node.gap_n);
    stiffness.tangential *= fraction;
    const double relative_slope = node.gap_n / (node.gap * (node.gap_n - node.gap)); // (∂φ/∂g)/φ
    slope = {increment[0] * relative_slope, increment[1] * relative_slope};
  }
  const FrameTraction t =
      compute_traction(stiffness, tangent_, node.gap, history_n.tangential, increment, slope);

  node.status = t.status;
  node.pressure = t.pressure;
  node.traction = t.tangential[0] * Z.q + t.tangential[1] * Z.r + t.pressure * Z.n;
  const std::array<Tensor<1, 3>, 3> axes{Z.q, Z.r, Z.n};
  node.tangent = 0.;
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j)
      node.tangent += t.tangent[i][j] * dealii::outer_product(axes[i], axes[j]);

  history.is_active = true;
  history.tangential = t.tangential;
  node.slip_increment = fraction * std::hypot(t.slip[0], t.slip[1]);
  node.dissipation = -fraction * (t.tangential[0] * t.slip[0] + t.tangential[1] * t.slip[1]);
  node.tangential_energy = 0.5 * (t.tangential[0] * t.tangential[0] + t.tangential[1] * t.tangential[1]) /
                           node.stiffness.tangential;
  history.slip = history_n.slip + node.slip_increment;
}

RigidContact::FacetAreas RigidContact::compute_areas(const Facet &facet, const bool with_derivatives) const {
  static const double g = 1. / std::sqrt(3.);
  static const std::array<std::array<double, 2>, 4> corners{{{-1., -1.}, {1., -1.}, {-1., 1.}, {1., 1.}}};
  FacetAreas result{};
  for (const auto &corner : corners) { // 2 × 2 Gauss points at ±1/√3, weights 1
    const double xi = g * corner[0], eta = g * corner[1];
    std::array<double, 4> N{}, N_xi{}, N_eta{};
    Tensor<1, 3> g_1, g_2;
    for (unsigned int a = 0; a < 4; ++a) {
      N[a] = 0.25 * (1. + corners[a][0] * xi) * (1. + corners[a][1] * eta);
      N_xi[a] = 0.25 * corners[a][0] * (1. + corners[a][1] * eta);
      N_eta[a] = 0.25 * corners[a][1] * (1. + corners[a][0] * xi);
      g_1 += N_xi[a] * nodes_[facet.nodes[a]].position;
      g_2 += N_eta[a] * nodes_[facet.nodes[a]].position;
    }
    const Tensor<1, 3> area_vector = dealii::cross_product_3d(g_1, g_2);
    for (unsigned int a = 0; a < 4; ++a) {
      const Node &node = nodes_[facet.nodes[a]];
      if (node.status == ContactStatus::open)
        continue;
      const double facing = -(area_vector * node.normal);
      if (facing <= 0.)
        continue;
      result.areas[a] += N[a] * facing;
      if (with_derivatives)
        for (unsigned int b = 0; b < 4; ++b)
          result.derivatives[a][b] -= N[a] * (N_xi[b] * dealii::cross_product_3d(g_2, node.normal) +
                                              N_eta[b] * dealii::cross_product_3d(node.normal, g_1));
    }
  }
  return result;
}

void RigidContact::add_forces(Vector &residual) const {
  for (const auto &facet : facets_) {
    const FacetAreas areas = compute_areas(facet, false);
    for (unsigned int a = 0; a < 4; ++a) {
      const Node &node = nodes_[facet.nodes[a]];
      if (areas.areas[a] == 0.)
        continue;
      std::array<double, 3> values{};
      for (unsigned int i = 0; i < 3; ++i)
        values[i] = -areas.areas[a] * node.traction[i];
      residual.add(3, node.dofs.data(), values.data());
    }
  }
}

void RigidContact::add_tangent(const TangentSystem &system) const {
  const bool exact = tangent_ == ContactTangent::exact;
  dealii::FullMatrix<double> facet_matrix(12, 12);
  std::vector<DofIndex> dofs(12);
  for (const auto &facet : facets_) {
    const FacetAreas areas = compute_areas(facet, exact);
    if (std::all_of(areas.areas.begin(), areas.areas.end(), [](const double area) { return area == 0.; }))
      continue;
    facet_matrix = 0.;
    for (unsigned int a = 0; a < 4; ++a) {
      const Node &node = nodes_[facet.nodes[a]];
      for (unsigned int i = 0; i < 3; ++i) {
        dofs[3 * a + i] = node.dofs[i];
        for (unsigned int j = 0; j < 3; ++j)
          facet_matrix(3 * a + i, 3 * a + j) += areas.areas[a] * node.tangent[i][j];
        if (exact)
          for (unsigned int b = 0; b < 4; ++b)
            for (unsigned int j = 0; j < 3; ++j)
              facet_matrix(3 * a + i, 3 * b + j) -= node.traction[i] * areas.derivatives[a][b][j];
      }
    }
    system.add(facet_matrix, dofs);
  }
}

void RigidContact::add_tool_push(const double t, Vector &forces) const {
  const Placement after = tool_.placement(t);
  for (const auto &facet : facets_) {
    const FacetAreas areas = compute_areas(facet, false);
    for (unsigned int a = 0; a < 4; ++a) {
      const Node &node = nodes_[facet.nodes[a]];
      if (areas.areas[a] == 0.)
        continue;
      const Tensor<1, 3> motion = after.to_space(placement_.to_tool(node.position)) - node.position;
      const Tensor<1, 3> force = areas.areas[a] * (node.tangent * motion);
      const std::array<double, 3> values{force[0], force[1], force[2]};
      forces.add(3, node.dofs.data(), values.data());
    }
  }
}

void RigidContact::commit() {
  for (auto &node : nodes_)
    node.gap_n = node.gap;
  friction_n_ = friction_;
}

ContactLoad RigidContact::compute_load() const {
  ContactLoad local;
  for (const auto &facet : facets_) {
    const FacetAreas areas = compute_areas(facet, false);
    for (unsigned int a = 0; a < 4; ++a) {
      const Node &node = nodes_[facet.nodes[a]];
      if (node.status == ContactStatus::open)
        continue;
      const Tensor<1, 3> force = areas.areas[a] * node.traction;
      local.force += force;
      local.moment += dealii::cross_product_3d(node.position - placement_.moved_centre(), force);
      local.area += areas.areas[a];
      local.stored_energy +=
          areas.areas[a] * (0.5 * node.stiffness.normal * node.gap * node.gap + node.tangential_energy);
      local.dissipation += areas.areas[a] * node.dissipation;
      local.deepest = std::max(local.deepest, -node.gap);
    }
  }
  const std::array<double, 9> sums{local.force[0],  local.force[1],      local.force[2],
                                   local.moment[0], local.moment[1],     local.moment[2],
                                   local.area,      local.stored_energy, local.dissipation};
  std::array<double, 9> totals{};
  dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(sums.data(), sums.size()), communicator_,
                              dealii::ArrayView<double>(totals.data(), totals.size()));
  ContactLoad load;
  for (unsigned int i = 0; i < 3; ++i) {
    load.force[i] = totals[i];
    load.moment[i] = totals[3 + i];
  }
  load.area = totals[6];
  load.stored_energy = totals[7];
  load.dissipation = totals[8];
  load.deepest = dealii::Utilities::MPI::max(local.deepest, communicator_);
  return load;
}

std::vector<RigidContact::NodeReport> RigidContact::report() const {
  std::vector<NodeReport> reports;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Node &node = nodes_[i];
    reports.push_back({node.dofs, node.status, node.pressure, node.gap,
                       friction_.empty() ? 0. : friction_[i].slip, 0., node.traction});
  }
  for (const auto &facet : facets_) {
    const FacetAreas areas = compute_areas(facet, false);
    for (unsigned int a = 0; a < 4; ++a)
      reports[facet.nodes[a]].area += areas.areas[a];
  }
  return reports;
}

std::size_t RigidContact::history_size() const {
  return (2 * friction_.size() * sizeof(FrictionHistory) + nodes_.size() * sizeof(double)) / sizeof(double);
}

} // namespace billet
