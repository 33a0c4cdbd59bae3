// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/facet_contact.h"

#include "billet/contact/facet_areas.h"
#include "billet/contact/facet_reaction.h"
#include "billet/geometry/bilinear_facet.h"
#include "billet/geometry/planed_facet.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <unordered_map>

namespace billet {

using dealii::Tensor;

FacetContact::FacetContact(MPI_Comm communicator, const FacetContactSettings &settings,
                           std::vector<std::uint64_t> node_keys, std::vector<SurfaceFacet> facets,
                           std::vector<ContactStiffness> stiffness)
    : communicator_(communicator), settings_(settings),
      exchange_(communicator, std::move(node_keys), std::move(facets)),
      search_(settings.partners, settings.search_margin) {
  std::vector<bool> is_listed(exchange_.n_own_nodes());
  for (const auto &facet : exchange_.facets()) {
    largest_reach_ = std::max(largest_reach_, facet.reach);
    for (const unsigned int node : facet.nodes)
      if (!is_listed[node] && (settings.two_pass || facet.surface == 0)) {
        is_listed[node] = true;
        slaves_.push_back({node, facet.surface});
        const double part = settings.two_pass ? 0.5 : 1.;
        stiffness_.push_back({part * stiffness[node].normal, part * stiffness[node].tangential});
      }
  }
  MPI_Allreduce(MPI_IN_PLACE, &largest_reach_, 1, MPI_DOUBLE, MPI_MAX, communicator_);
  touched_n_.resize(slaves_.size());
  states_.resize(slaves_.size());
  if (!std::holds_alternative<Frictionless>(settings.friction))
    history_n_.resize(slaves_.size());
  history_ = history_n_;
  if (settings.edges) {
    edges_.emplace(settings.partners, settings.sharp_edge);
    for (const auto &of_node : stiffness)
      edge_stiffness_.push_back(of_node.normal);
  }
}

void FacetContact::rebuild() {
  // Ghosts change places: what a node touches is found again by its key.
  std::vector<std::uint64_t> keys(slaves_.size());
  for (std::size_t s = 0; s < slaves_.size(); ++s)
    if (touched_n_[s].exists())
      keys[s] = search_.facets()[touched_n_[s].facet].key;
  double distance = largest_reach_ + settings_.search_margin;
  if (edges_) {
    // The middle of an edge is farther from nodes, and depth is not limited to the reach.
    double longest = 0.;
    for (std::size_t f = 0; f < exchange_.n_own_facets(); ++f) {
      const FacetCorners x = corners_of(exchange_.facets()[f], positions_);
      for (unsigned int i = 0; i < 4; ++i)
        longest = std::max(longest, (x[facet::around[(i + 1) % 4]] - x[facet::around[i]]).norm());
    }
    distance += settings_.limits.held_depth * largest_reach_ + longest;
    MPI_Allreduce(MPI_IN_PLACE, &distance, 1, MPI_DOUBLE, MPI_MAX, communicator_);
  }
  exchange_.rebuild(positions_n_, positions_, distance);
  exchange_.update(positions_n_);
  exchange_.update(positions_);
  search_.set_surface(exchange_.facets(), slaves_);
  search_.rebuild(positions_n_, positions_);
  if (edges_)
    edges_->rebuild(search_.facets(), exchange_.n_own_facets(), positions_, settings_.search_margin,
                    settings_.limits.held_depth);
  std::unordered_map<std::uint64_t, unsigned int> index;
  for (unsigned int f = 0; f < search_.facets().size(); ++f)
    index.emplace(search_.facets()[f].key, f);
  for (std::size_t s = 0; s < slaves_.size(); ++s)
    if (touched_n_[s].exists()) {
      const auto found = index.find(keys[s]);
      touched_n_[s].facet = found == index.end() ? TouchedFacet::none : found->second;
    }
}

void FacetContact::update_search(const Positions &positions_n, const Positions &positions) {
  positions_n_ = positions_n;
  positions_ = positions;
  exchange_.update(positions_n_);
  exchange_.update(positions_);
  bool is_outdated = search_.n_rebuilds() == 0;
  if (!is_outdated) {
    // One reduction for both ends of the box: the largest of −low and of high.
    BoundingBox motion = search_.compute_motion(positions_);
    std::array<double, 6> ends{-motion.low[0], -motion.low[1], -motion.low[2],
                               motion.high[0], motion.high[1], motion.high[2]};
    MPI_Allreduce(MPI_IN_PLACE, ends.data(), 6, MPI_DOUBLE, MPI_MAX, communicator_);
    for (unsigned int i = 0; i < 3; ++i) {
      motion.low[i] = -ends[i];
      motion.high[i] = ends[3 + i];
    }
    is_outdated = search_.is_outdated(motion);
  }
  if (is_outdated)
    rebuild();
}

void FacetContact::compute_areas(const SlaveNode &slave, SlaveState &state) const {
  search_.visit_around(slave.node, [&](const unsigned int f) {
    const SurfaceFacet &facet = search_.facets()[f];
    const auto corner = static_cast<unsigned int>(
        std::find(facet.nodes.begin(), facet.nodes.end(), slave.node) - facet.nodes.begin());
    const double share =
        compute_area_share(corners_of(facet, positions_), corner, state.touched.projection.normal);
    state.area += share;
    if (f < exchange_.n_own_facets())
      state.own_area += share;
  });
}

template <class Facet, class Law> void FacetContact::evaluate(const Law &law, const double duration) {
  const Positions normals = settings_.limits.largest_alignment > 1.
                                ? Positions()
                                : compute_node_normals(search_.facets(), positions_);
  for (std::size_t s = 0; s < slaves_.size(); ++s) {
    const unsigned int node = slaves_[s].node;
    SlaveState &state = states_[s];
    state = SlaveState();
    state.touched =
        choose_facet<Facet>(search_, s, positions_n_, positions_, normals, touched_n_[s], settings_.limits);
    const FacetProjection &p = state.touched.projection;
    if (state.touched.exists())
      compute_areas(slaves_[s], state);
    if constexpr (std::is_same_v<Law, Frictionless>) {
      if (state.touched.exists())
        state.traction = compute_slave_traction(law, stiffness_[s].normal, p.normal, p.gap);
    } else if (state.touched.exists()) {
      const SlaveMotion motion = compute_slave_motion(
          corners_of(search_.facets()[state.touched.facet], positions_n_), target_corners(state), p.weights,
          positions_n_[node], positions_[node], duration);
      state.traction =
          compute_slave_traction(law, stiffness_[s], p.normal, p.gap, motion, history_n_[s], history_[s]);
    } else {
      history_[s] = SlaveHistory();
      history_[s].slip = history_n_[s].slip;
    }
  }
}

void FacetContact::add_forces(const Positions &positions_n, const Positions &positions, const double duration,
                              Positions &forces) {
  update_search(positions_n, positions);
  std::visit(
      [&](const auto &law) {
        if (settings_.method == FacetMethod::planed)
          evaluate<PlanedFacet>(law, duration);
        else
          evaluate<BilinearFacet>(law, duration);
      },
      settings_.friction);

  Positions all(exchange_.n_nodes());
  for (std::size_t s = 0; s < slaves_.size(); ++s) {
    const SlaveState &state = states_[s];
    if (!(state.own_area > 0.))
      continue;
    const Tensor<1, 3> force = state.own_area * state.traction.traction;
    const FacetCorners reaction = compute_facet_reaction(
        target_corners(state), state.touched.projection.weights, positions_[slaves_[s].node], force);
    all[slaves_[s].node] += force;
    for (unsigned int a = 0; a < 4; ++a)
      all[search_.facets()[state.touched.facet].nodes[a]] += reaction[a];
  }
  if (edges_)
    crossings_ = edges_->find_crossings(positions_);
  for (const auto &crossing : crossings_) {
    const Tensor<1, 3> force = -edge_spring(crossing) * crossing.gap * crossing.normal;
    for (unsigned int i = 0; i < 4; ++i)
      all[crossing.nodes[i]] += (i < 2 ? crossing.weights[i] : -crossing.weights[i]) * force;
  }
  exchange_.collect(all);
  for (std::size_t i = 0; i < exchange_.n_own_nodes(); ++i)
    forces[i] += all[i];
}

void FacetContact::add_row_sums(std::vector<double> &row_sums) const {
  std::vector<double> all(exchange_.n_nodes());
  for (std::size_t s = 0; s < slaves_.size(); ++s) {
    const SlaveState &state = states_[s];
    if (!(state.own_area > 0.))
      continue;
    const double k = std::max(stiffness_[s].normal, history_.empty() ? 0. : stiffness_[s].tangential);
    double columns = 1.;
    for (const double weight : state.touched.projection.weights)
      columns += std::abs(weight);
    all[slaves_[s].node] += columns * k * state.own_area;
    for (unsigned int a = 0; a < 4; ++a)
      all[search_.facets()[state.touched.facet].nodes[a]] +=
          std::abs(state.touched.projection.weights[a]) * columns * k * state.own_area;
  }
  for (const auto &crossing : crossings_)
    for (unsigned int i = 0; i < 4; ++i)
      all[crossing.nodes[i]] += 2. * crossing.weights[i] * edge_spring(crossing);
  exchange_.collect(all);
  for (std::size_t i = 0; i < exchange_.n_own_nodes(); ++i)
    row_sums[i] += all[i];
}

void FacetContact::add_edges(FacetContactLoad &load) const {
  for (const auto &crossing : crossings_) {
    const double spring = edge_spring(crossing);
    const Tensor<1, 3> force = -spring * crossing.gap * crossing.normal;
    Tensor<1, 3> between;
    for (unsigned int i = 0; i < 4; ++i)
      between += (i < 2 ? crossing.weights[i] : -crossing.weights[i]) * positions_[crossing.nodes[i]];
    load.residual_moment += dealii::cross_product_3d(between, force);
    load.absolute_force += force.norm();
    if (crossing.surfaces[0] == 0)
      load.force += force;
    if (crossing.surfaces[1] == 0)
      load.force -= force;
    load.stored_energy += 0.5 * spring * crossing.gap * crossing.gap;
    load.deepest = std::max(load.deepest, -crossing.gap);
    load.deepest_relative = std::max(load.deepest_relative, -0.5 * crossing.gap / std::sqrt(crossing.area));
  }
}

FacetContactLoad FacetContact::compute_load() const {
  FacetContactLoad load;
  for (std::size_t s = 0; s < slaves_.size(); ++s) {
    const SlaveState &state = states_[s];
    if (!state.touched.exists())
      continue;
    const FacetProjection &p = state.touched.projection;
    const FacetCorners corners = target_corners(state);
    const Tensor<1, 3> x = positions_[slaves_[s].node], force = state.own_area * state.traction.traction;
    const FacetCorners reaction = compute_facet_reaction(corners, p.weights, x, force);
    load.residual_force += force;
    for (unsigned int a = 0; a < 4; ++a) {
      load.residual_force += reaction[a];
      load.residual_moment += dealii::cross_product_3d(corners[a] - x, reaction[a]);
    }
    load.absolute_force += force.norm();
    if (slaves_[s].surface == 0)
      load.force += force;
    if (search_.facets()[state.touched.facet].surface == 0)
      load.force -= force;
    load.stored_energy += state.own_area * state.traction.stored_energy;
    load.dissipation += state.own_area * state.traction.dissipation;
    load.area += state.own_area;
    load.n_touching += 1.;
    const double size =
        std::sqrt(0.5 * dealii::cross_product_3d(corners[3] - corners[0], corners[2] - corners[1]).norm());
    load.deepest = std::max(load.deepest, -p.gap);
    load.deepest_relative = std::max(load.deepest_relative, -p.gap / size);
  }
  add_edges(load);
  std::array<double, 14> sums{load.stored_energy, load.dissipation, load.area, load.n_touching,
                              load.absolute_force};
  std::array<double, 2> largest{load.deepest, load.deepest_relative};
  const std::array<Tensor<1, 3> *, 3> vectors{&load.force, &load.residual_force, &load.residual_moment};
  for (unsigned int v = 0; v < 3; ++v)
    for (unsigned int i = 0; i < 3; ++i)
      sums[5 + 3 * v + i] = (*vectors[v])[i];
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM, communicator_);
  MPI_Allreduce(MPI_IN_PLACE, largest.data(), 2, MPI_DOUBLE, MPI_MAX, communicator_);
  load.stored_energy = sums[0];
  load.dissipation = sums[1];
  load.area = sums[2];
  load.n_touching = sums[3];
  load.absolute_force = sums[4];
  for (unsigned int v = 0; v < 3; ++v)
    for (unsigned int i = 0; i < 3; ++i)
      (*vectors[v])[i] = sums[5 + 3 * v + i];
  load.deepest = largest[0];
  load.deepest_relative = largest[1];
  return load;
}

double FacetContact::local_dissipation() const {
  double dissipation = 0.;
  for (const auto &state : states_)
    dissipation += state.own_area * state.traction.dissipation;
  return dissipation;
}

void FacetContact::commit() {
  for (std::size_t s = 0; s < slaves_.size(); ++s)
    touched_n_[s] = states_[s].touched;
  history_n_ = history_;
}

std::vector<FacetContact::NodeReport> FacetContact::report() const {
  std::vector<NodeReport> reports(exchange_.n_own_nodes());
  for (std::size_t s = 0; s < slaves_.size(); ++s) {
    const SlaveState &state = states_[s];
    reports[slaves_[s].node] = {state.traction.status,
                                state.traction.pressure,
                                state.touched.projection.gap,
                                history_.empty() ? 0. : history_[s].slip,
                                state.area,
                                state.traction.traction};
  }
  return reports;
}

} // namespace billet
