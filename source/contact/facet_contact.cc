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

namespace {

constexpr double rounding = 1e-13; ///< penetration that round-off makes, relative to a facet's size

} // namespace

FacetContact::FacetContact(MPI_Comm communicator, const FacetContactSettings &settings,
                           std::vector<std::uint64_t> node_keys, std::vector<SurfaceFacet> facets,
                           std::vector<ContactStiffness> stiffness, std::vector<double> sizes)
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
        sizes_.push_back(sizes[node]);
        const double part = settings.two_pass ? 0.5 : 1.;
        stiffness_.push_back({part * stiffness[node].normal, part * stiffness[node].tangential});
      }
  }
  MPI_Allreduce(MPI_IN_PLACE, &largest_reach_, 1, MPI_DOUBLE, MPI_MAX, communicator_);
  given_stiffness_ = stiffness_;
  touched_n_.resize(slaves_.size());
  pressed_n_.resize(slaves_.size());
  states_.resize(slaves_.size());
  if (settings.friction != nullptr)
    history_n_.resize(slaves_.size());
  base_ = history_ = history_n_;
  friction_memory_.set(3 * history_.size() * sizeof(SlaveHistory));
  if (settings.method == FacetMethod::overlap)
    overlaps_.emplace();
  if (settings.edges) {
    edges_.emplace(settings.partners, settings.flat_edge);
    for (const auto &of_node : stiffness)
      edge_stiffness_.push_back(of_node.normal);
  }
}

void FacetContact::rebuild() {
  // Ghosts change places: what a node touches is found again by its key.
  std::vector<std::uint64_t> keys = std::move(restored_keys_);
  restored_keys_.clear();
  if (keys.empty()) {
    keys.resize(slaves_.size());
    for (std::size_t s = 0; s < slaves_.size(); ++s)
      if (touched_n_[s].exists())
        keys[s] = search_.facets()[touched_n_[s].facet].key;
  }
  double distance = largest_reach_ + settings_.search_margin;
  if (edges_ || overlaps_) {
    // The middle of an edge or a facet is farther from nodes, and depth is not limited to the reach.
    double longest = 0.;
    for (std::size_t f = 0; f < exchange_.n_own_facets(); ++f) {
      const FacetCorners x = corners_of(exchange_.facets()[f], positions_);
      for (unsigned int i = 0; i < 4; ++i)
        longest = std::max(longest, (x[facet::around[(i + 1) % 4]] - x[facet::around[i]]).norm());
    }
    distance += (edges_ ? settings_.edge_depth : FacetOverlaps::depth) * largest_reach_ + longest;
    MPI_Allreduce(MPI_IN_PLACE, &distance, 1, MPI_DOUBLE, MPI_MAX, communicator_);
  }
  exchange_.rebuild(positions_n_, positions_, distance);
  exchange_.update(positions_n_);
  exchange_.update(positions_);
  if (edges_)
    exchange_.update(edge_stiffness_);
  search_.set_surface(exchange_.facets(), slaves_);
  search_.rebuild(positions_n_, positions_);
  if (overlaps_)
    overlaps_->rebuild(search_, positions_n_, positions_, settings_.search_margin,
                       settings_.partners == FacetSearch::Partners::other_surfaces_and_self,
                       settings_.two_pass);
  if (edges_)
    edges_->rebuild(search_.facets(), exchange_.n_own_facets(), positions_, settings_.search_margin,
                    settings_.edge_depth);
  std::unordered_map<std::uint64_t, unsigned int> index;
  for (unsigned int f = 0; f < search_.facets().size(); ++f)
    index.emplace(search_.facets()[f].key, f);
  for (std::size_t s = 0; s < slaves_.size(); ++s)
    if (touched_n_[s].exists()) {
      const auto found = index.find(keys[s]);
      touched_n_[s].facet = found == index.end() ? TouchedFacet::none : found->second;
    }
  const std::size_t bytes =
      search_.n_candidates() * sizeof(unsigned int) + search_.facets().size() * sizeof(SurfaceFacet);
  memory_.set(bytes);
  contact_memory_.set(slaves_.size() * (sizeof(SlaveNode) + sizeof(SlaveState)));
  if (settings_.partners == FacetSearch::Partners::other_surfaces_and_self)
    self_memory_.set(bytes);
  if (edges_)
    edge_memory_.set(edges_->n_pairs() * 2 * sizeof(std::size_t));
}

void FacetContact::update_search(const Positions &positions_n, const Positions &positions) {
  positions_n_ = positions_n;
  positions_ = positions;
  exchange_.update(positions_n_);
  exchange_.update(positions_);
  const auto over_all_ranks = [this](BoundingBox motion) {
    // One reduction for both ends of the box: the largest of −low and of high.
    std::array<double, 6> ends{-motion.low[0], -motion.low[1], -motion.low[2],
                               motion.high[0], motion.high[1], motion.high[2]};
    MPI_Allreduce(MPI_IN_PLACE, ends.data(), 6, MPI_DOUBLE, MPI_MAX, communicator_);
    for (unsigned int i = 0; i < 3; ++i) {
      motion.low[i] = -ends[i];
      motion.high[i] = ends[3 + i];
    }
    return motion;
  };
  is_rebuilt_ = search_.is_outdated(positions_, over_all_ranks);
  if (is_rebuilt_)
    rebuild();
  moved_.reset();
  if (overlaps_)
    update_overlaps();
}

void FacetContact::update_overlaps() {
  nodal_lifts_.clear();
  nodal_augmentations_.clear();
  // All ranks have lifts or none.
  if (has_lifts_) {
    nodal_lifts_.assign(exchange_.n_nodes(), 0.);
    nodal_augmentations_ = nodal_lifts_;
    for (std::size_t s = 0; s < slaves_.size(); ++s) {
      nodal_augmentations_[slaves_[s].node] = augmentation(s);
      nodal_lifts_[slaves_[s].node] = lift(s).now - augmentation(s);
    }
    exchange_.update(nodal_lifts_);
    exchange_.update(nodal_augmentations_);
  }
  overlaps_->update(search_, positions_n_, positions_, nodal_lifts_, nodal_augmentations_);
}

void FacetContact::find_overlaps(const std::size_t s) {
  SlaveState &state = states_[s];
  state = SlaveState();
  state.first_share = shares_.size();
  double largest = 0.;
  search_.visit_around(slaves_[s].node, [&](const unsigned int f) {
    const unsigned int corner = corner_of(search_.facets()[f], slaves_[s].node);
    overlaps_->visit(f, [&](const FacetOverlaps::Overlap &overlap) {
      shares_.push_back(
          share_of_overlap(overlap.integrals, corner, f, overlap.target, overlap.depth, depth_rounding(s)));
      const FacetShare &share = shares_.back();
      if (share.share > largest) {
        largest = share.share;
        state.touched.facet = overlap.target;
      }
      if (!(share.area > 0.))
        shares_.pop_back();
    });
  });
  state.end_of_shares = shares_.size();
  if (!state.touched.exists())
    return;
  state.contact = combine(shares_, state.first_share);
  state.contact.gap -= augmentation(s);
  state.area = effective_area(shares_, state.first_share);
  for (std::size_t i = state.first_share; i < state.end_of_shares; ++i)
    state.own_area += area_of(state, shares_[i]);
  if (state.contact.gap < -rounding * sizes_[s])
    return;
  // Facets that fit just touch; others are within the lifts of their other corners.
  state.contact.gap = std::max(0., state.contact.gap);
  state.rests = state.contact.gap <= flush_gap(s);
  if (!state.rests)
    state.touched = TouchedFacet();
}

void FacetContact::compute_areas(const std::size_t s, SlaveState &state) const {
  // What is only near counts in bounds alone, which want to know it about: undeformed, a quarter of each
  // facet.
  const double quarter = 0.25 * sizes_[s] * sizes_[s];
  search_.visit_around(slaves_[s].node, [&](const unsigned int f) {
    const double share =
        state.is_near
            ? quarter
            : moved_.areas(f).share(corner_of(search_.facets()[f], slaves_[s].node), state.contact.normal);
    state.area += share;
    if (f < exchange_.n_own_facets())
      state.own_area += share;
  });
}

bool FacetContact::is_resting(const TouchedFacet &below, const std::size_t s, const double on_it) const {
  const SurfaceFacet &facet = search_.facets()[below.facet];
  const FacetProjection before =
      raised(PlanedFacet(corners_of(facet, positions_n_)).project(positions_n_[slaves_[s].node], {}), facet);
  return before.exists && before.gap - lift(s).at_start <= on_it;
}

void FacetContact::count_changes() {
  n_changes_.resize(slaves_.size());
  const bool is_first = seen_.empty();
  seen_.resize(slaves_.size());
  for (std::size_t s = 0; s < slaves_.size(); ++s) {
    const SlaveState &state = states_[s];
    const std::uint64_t now = state.presses() ? 4 * search_.facets()[state.touched.facet].key +
                                                    static_cast<std::uint64_t>(state.traction.status) + 1
                                              : 0;
    if (!is_first && now != seen_[s])
      ++n_changes_[s];
    seen_[s] = now;
  }
}

std::vector<FacetContact::Restless> FacetContact::find_restless() const {
  std::vector<Restless> restless;
  for (std::size_t s = 0; s < n_changes_.size(); ++s)
    if (n_changes_[s] > settings_.most_changes)
      restless.push_back({positions_[slaves_[s].node], n_changes_[s]});
  return restless;
}

template <class Facet> void FacetContact::find_contact(const std::size_t s) {
  SlaveState &state = states_[s];
  const TouchedFacet now = state.touched;
  state = SlaveState();
  state.first_share = shares_.size();
  if (search_.has_candidates(s) || touched_n_[s].exists()) {
    // Indices of facets are those of the last search, which a restless node outlives seldom.
    const bool is_restless = settings_.most_changes > 0 && s < n_changes_.size() &&
                             n_changes_[s] > settings_.most_changes && now.exists() && !is_rebuilt_;
    if (is_restless)
      state.touched = keep_facet<Facet>(moved_, s, positions_n_, now, settings_.limits, lift(s));
    if (!state.touched.exists())
      state.touched = choose_facet<Facet>(moved_, s, positions_n_, touched_n_[s], settings_.limits, lift(s));
  }
  if (state.touched.exists()) {
    state.contact =
        share_facets<Facet>(moved_, state.touched, positions_[slaves_[s].node], settings_.limits, shares_);
    state.contact.gap -= lift(s).now;
    if (!(state.contact.gap < 0.)) {
      state.touched = TouchedFacet();
      shares_.resize(state.first_share);
    } else if (has_started_) {
      state.touched.offset = std::min(state.touched.offset, -state.contact.gap);
      state.contact.gap += state.touched.offset;
    } else // where bodies start in each other they part
      state.touched.offset = 0.;
  }
  if (!state.touched.exists() && search_.has_candidates(s)) {
    const TouchedFacet below = find_facet_below(moved_, s, settings_.limits);
    const double on_it = settings_.touching_gap * sizes_[s];
    state.rests =
        below.exists() && below.projection.gap - lift(s).now <= on_it && is_resting(below, s, on_it);
    state.is_near = below.exists() && !state.rests;
    if (state.rests)
      state.touched = below;
    if (below.exists()) {
      state.contact = {below.projection.normal, below.projection.gap - lift(s).now};
      shares_.push_back({below.facet, 1., below.projection});
    }
  }
  state.end_of_shares = shares_.size();
  if (state.end_of_shares > state.first_share)
    compute_areas(s, state);
}

SlaveMotion FacetContact::compute_motion(const std::size_t s, const double duration) const {
  SlaveMotion mean{Tensor<1, 3>(), Tensor<2, 3>(), duration, augmentation(s), flush_gap(s)};
  for (std::size_t i = states_[s].first_share; i < states_[s].end_of_shares; ++i) {
    const FacetShare &share = shares_[i];
    const SlaveMotion motion = compute_slave_motion(corners_of(search_.facets()[share.facet], positions_n_),
                                                    moved_.corners(share.facet), share.projection.weights,
                                                    slave_point(s, share, positions_n_),
                                                    slave_point(s, share, positions_), duration);
    mean.displacement += share.share * motion.displacement;
    // Nearly a rotation; what it carries along is made a unit vector again.
    mean.rotation += share.share * motion.rotation;
  }
  return mean;
}

SlaveMotion FacetContact::compute_motion_after_contact(const std::size_t s, const double duration) const {
  if (!touched_n_[s].exists())
    return {};
  const unsigned int facet = touched_n_[s].facet, node = slaves_[s].node;
  const FacetCorners corners_n = corners_of(search_.facets()[facet], positions_n_);
  return compute_slave_motion(corners_n, moved_.corners(facet),
                              PlanedFacet(corners_n).project(positions_n_[node], {}).weights,
                              positions_n_[node], positions_[node], duration);
}

double FacetContact::own_part(const std::size_t s) const {
  double n_own = 0., n_facets = 0.;
  search_.visit_around(slaves_[s].node, [&](const unsigned int f) {
    n_facets += 1.;
    n_own += f < exchange_.n_own_facets() ? 1. : 0.;
  });
  return n_own / n_facets;
}

void FacetContact::account_for_friction(const std::size_t s, const SlaveMotion &motion) {
  const FrictionRule rule{stiffness_[s].tangential, start_weight_, is_static_, lifts_n_.empty(),
                          lifts_.empty()};
  double part = 1.; // of the step, in which it touches
  if (is_static_ && history_[s].is_active && !history_n_[s].is_active)
    part = part_in_contact(states_[s].contact.gap + motion.lift, states_[s].contact.normal, motion);
  else if (is_static_ && !history_[s].is_active)
    part = part_before_leaving(pressed_n_[s].depth,
                               motion.displacement * (motion.rotation * pressed_n_[s].normal));
  const SlaveTraction &traction = states_[s].traction;
  double limit_n = 0.;
  if (is_static_ && history_[s].is_active && traction.slip > 0. && traction.pressure > 0.)
    limit_n = std::hypot(history_[s].tangential[0], history_[s].tangential[1]) * pressed_n_[s].pressure /
              traction.pressure;
  const FrictionAccount account =
      compute_friction_account(history_n_[s], history_[s], motion, rule, part, limit_n);
  const double own = own_part(s);
  states_[s].dissipation = own * account.dissipated(history_n_[s].area, history_[s].area);
  states_[s].dissipation_handed_over =
      own * account.handed_over().dissipated(history_n_[s].area, history_[s].area);
  states_[s].damping = own * history_[s].area * account.damping;
  states_[s].taken_beyond = own * account.taken_beyond(history_n_[s].area, history_[s].area);
  states_[s].missed = own * account.missed(history_n_[s].area);
}

template <class Visit> void FacetContact::visit_forces(const std::size_t s, const Visit &visit) const {
  const SlaveState &state = states_[s];
  if (!state.presses() || !(state.own_area > 0.))
    return;
  for (std::size_t i = state.first_share; i < state.end_of_shares; ++i) {
    const FacetShare &share = shares_[i];
    const double area = area_of(state, share);
    if (!(area > 0.))
      continue;
    const Tensor<1, 3> part = area * state.traction.traction;
    visit(share, part,
          moved_.reaction(share.facet)(share.projection.weights, slave_point(s, share, positions_), part));
  }
}

template <class Facet, class Law> void FacetContact::evaluate(const Law &law, const double duration) {
  shares_.clear();
  for (std::size_t s = 0; s < slaves_.size(); ++s) {
    if constexpr (std::is_same_v<Facet, OverlapFacet>)
      find_overlaps(s);
    else
      find_contact<Facet>(s);
    SlaveState &state = states_[s];
    const SharedGap &contact = state.contact;
    if constexpr (std::is_same_v<Law, Frictionless>) {
      if (state.presses())
        state.traction = compute_slave_traction(law, stiffness_[s].normal, contact.normal, contact.gap);
    } else if (state.presses()) {
      const SlaveMotion motion = compute_motion(s, duration);
      state.traction = compute_slave_traction(law, stiffness_[s], contact.normal, contact.gap, motion,
                                              base_[s], history_[s]);
      history_[s].area = state.area;
      account_for_friction(s, motion);
    } else {
      history_[s] = SlaveHistory();
      history_[s].slip = history_n_[s].slip;
      if (history_n_[s].is_active)
        account_for_friction(s, compute_motion_after_contact(s, duration));
    }
    visit_forces(s, [&](const FacetShare &share, const Tensor<1, 3> &force, const FacetCorners &reaction) {
      if (share.slave_facet == FacetShare::none)
        nodal_forces_[slaves_[s].node] += force;
      else
        for (unsigned int a = 0; a < 4; ++a)
          nodal_forces_[search_.facets()[share.slave_facet].nodes[a]] += share.slave_weights[a] * force;
      for (unsigned int a = 0; a < 4; ++a)
        nodal_forces_[search_.facets()[share.facet].nodes[a]] += reaction[a];
    });
  }
}

void FacetContact::add_forces(const Positions &positions_n, const Positions &positions, const double duration,
                              Positions &forces) {
  Usage::count(Capability::contact, slaves_.size());
  Usage::count(Capability::body_contact, slaves_.size());
  Usage::count_if(!history_n_.empty(), Capability::friction, slaves_.size());
  Usage::count_if(settings_.partners == FacetSearch::Partners::other_surfaces_and_self,
                  Capability::self_contact, slaves_.size());
  update_search(positions_n, positions);
  duration_ = duration;
  nodal_forces_.assign(exchange_.n_nodes(), Tensor<1, 3>());
  choose_friction(settings_.friction, [&](const auto &law) {
    visit_method(settings_.method,
                 [&](auto facet) { evaluate<typename decltype(facet)::type>(law, duration); });
  });

  if (settings_.most_changes > 0)
    count_changes();
  if (edges_) {
    Usage::count(Capability::edges, edges_->n_pairs());
    crossings_ = edges_->find_crossings(positions_n_, positions_, has_started_);
  }
  for (const auto &crossing : crossings_)
    if (crossing.counted_gap() < 0.) {
      const auto crossing_forces = crossing.forces(edge_stiffness(crossing));
      for (unsigned int i = 0; i < 4; ++i)
        nodal_forces_[crossing.nodes[i]] += crossing_forces[i];
    }
  exchange_.collect(nodal_forces_);
  for (std::size_t i = 0; i < exchange_.n_own_nodes(); ++i)
    forces[i] += nodal_forces_[i];
}

void FacetContact::add_row_sums(std::vector<double> &row_sums) {
  std::vector<double> &all = nodal_sums_;
  all.assign(exchange_.n_nodes(), 0.);
  for (std::size_t s = 0; s < slaves_.size(); ++s) {
    const SlaveState &state = states_[s];
    if (!(state.own_area > 0.))
      continue;
    const double k = std::max(stiffness_[s].normal, history_.empty() ? 0. : stiffness_[s].tangential);
    double columns = 1.;
    for (std::size_t i = state.first_share; i < state.end_of_shares; ++i)
      for (const double weight : shares_[i].projection.weights)
        columns += shares_[i].share * std::abs(weight);
    for (std::size_t i = state.first_share; i < state.end_of_shares; ++i) {
      const FacetShare &share = shares_[i];
      const double spring = columns * k * spring_area_of(state, share);
      if (share.slave_facet == FacetShare::none)
        all[slaves_[s].node] += spring;
      for (unsigned int a = 0; a < 4; ++a) {
        if (share.slave_facet != FacetShare::none)
          all[search_.facets()[share.slave_facet].nodes[a]] += share.slave_weights[a] * spring;
        all[search_.facets()[share.facet].nodes[a]] += std::abs(share.projection.weights[a]) * spring;
      }
    }
  }
  for (const auto &crossing : crossings_) {
    // Of ½ k A g², but for the second derivatives of A and g, which count g/L less. The whole area, always:
    // it changes fast where it fades.
    const double k = edge_stiffness(crossing), depth = std::max(-crossing.counted_gap(), 0.);
    double sum = 0.;
    for (const auto &gradient : crossing.area_gradients)
      sum += gradient.norm();
    for (unsigned int i = 0; i < 4; ++i)
      all[crossing.nodes[i]] +=
          k * (2. * crossing.weights[i] * crossing.full_area +
               depth * (crossing.weights[i] * sum + 2. * crossing.area_gradients[i].norm()));
  }
  exchange_.collect(all);
  for (std::size_t i = 0; i < exchange_.n_own_nodes(); ++i)
    row_sums[i] += all[i];
}

void FacetContact::add_crossings(Crossings &crossings) const {
  if (duration_ == 0.)
    return;
  double farthest = 0.;
  for (std::size_t i = 0; i < positions_.size(); ++i)
    farthest = std::max(farthest, (positions_[i] - positions_n_[i]).norm_square());
  // A node and a facet may go towards each other; Crossings looks twice as far.
  farthest = 4. * std::sqrt(farthest);
  for (std::size_t s = 0; s < slaves_.size(); ++s) {
    const SlaveState &state = states_[s];
    if (!(state.own_area > 0.) || std::abs(state.contact.gap) > farthest)
      continue;
    double area = 0.;
    Tensor<1, 3> moved;
    for (std::size_t i = state.first_share; i < state.end_of_shares; ++i) {
      const FacetShare &share = shares_[i];
      const FacetCorners before = corners_of(search_.facets()[share.facet], positions_n_),
                         now = moved_.corners(share.facet);
      Tensor<1, 3> part = slave_point(s, share, positions_) - slave_point(s, share, positions_n_);
      for (unsigned int a = 0; a < 4; ++a)
        part -= share.projection.weights[a] * (now[a] - before[a]);
      moved += share.share * part;
      area += spring_area_of(state, share);
    }
    crossings.add(stiffness_[s].normal * area, state.contact.gap, moved * state.contact.normal);
  }
}

void FacetContact::add_edges(FacetContactLoad &load) const {
  for (const auto &crossing : crossings_) {
    if (!(crossing.counted_gap() < 0.))
      continue;
    const double stiffness = edge_stiffness(crossing);
    const auto forces = crossing.forces(stiffness);
    for (unsigned int i = 0; i < 4; ++i) {
      load.residual_force += forces[i];
      load.residual_moment +=
          dealii::cross_product_3d(positions_[crossing.nodes[i]] - positions_[crossing.nodes[0]], forces[i]);
      if (crossing.surfaces[0] != crossing.surfaces[1] && crossing.surfaces[i / 2] == 0) {
        load.force += forces[i];
        load.moment += dealii::cross_product_3d(positions_[crossing.nodes[i]], forces[i]);
      }
    }
    load.absolute_force += (forces[0] + forces[1]).norm();
    load.stored_energy += 0.5 * stiffness * crossing.area * crossing.counted_gap() * crossing.counted_gap();
    load.deepest = std::max(load.deepest, -crossing.gap);
    load.deepest_relative =
        std::max(load.deepest_relative, -0.5 * crossing.gap / std::sqrt(crossing.full_area));
  }
}

bool FacetContact::presses_at_both_ends() const {
  bool pressed_n = false, presses = false;
  for (std::size_t s = 0; s < slaves_.size(); ++s) {
    pressed_n = pressed_n || pressed_n_[s].pressure > 0.;
    presses = presses || (states_[s].presses() && states_[s].traction.pressure > 0.);
  }
  std::vector<int> ends{pressed_n ? 1 : 0, presses ? 1 : 0};
  dealii::Utilities::MPI::max(ends, communicator_, ends);
  return ends[0] + ends[1] == 2;
}

FacetContactLoad FacetContact::compute_load() const {
  FacetContactLoad load;
  const bool hands_over = is_static_ && presses_at_both_ends();
  for (std::size_t s = 0; s < slaves_.size(); ++s) {
    const SlaveState &state = states_[s];
    load.dissipation += hands_over ? state.dissipation_handed_over : state.dissipation;
    load.damping += state.damping;
    if (!state.presses())
      continue;
    visit_forces(s, [&](const FacetShare &share, const Tensor<1, 3> &force, const FacetCorners &reaction) {
      const FacetCorners corners = moved_.corners(share.facet);
      load.residual_force += force;
      for (unsigned int a = 0; a < 4; ++a) {
        load.residual_force += reaction[a];
        load.residual_moment +=
            dealii::cross_product_3d(corners[a] - slave_point(s, share, positions_), reaction[a]);
      }
      const unsigned int of_node = slaves_[s].surface, of_facet = search_.facets()[share.facet].surface;
      if (of_node == of_facet) // nothing in all
        return;
      if (of_node == 0) {
        load.force += force;
        load.moment += dealii::cross_product_3d(slave_point(s, share, positions_), force);
      }
      if (of_facet == 0) {
        load.force -= force;
        for (unsigned int a = 0; a < 4; ++a)
          load.moment += dealii::cross_product_3d(corners[a], reaction[a]);
      }
    });
    load.absolute_force += state.own_area * state.traction.traction.norm();
    // What augmented tractions hold is no stretch of a spring.
    load.stored_energy += lifts_.empty() ? state.own_area * state.traction.stored_energy
                                         : 0.5 * state.own_area * stiffness_[s].normal *
                                               (state.contact.gap + augmentation(s)) *
                                               (state.contact.gap + augmentation(s));
    load.area += state.own_area;
    load.n_touching += 1.;
    const FacetCorners corners = moved_.corners(state.touched.facet);
    const double size =
        std::sqrt(0.5 * dealii::cross_product_3d(corners[3] - corners[0], corners[2] - corners[1]).norm());
    const double depth = state.touched.offset - state.contact.gap - lift(s).now;
    load.deepest = std::max(load.deepest, depth);
    load.deepest_relative = std::max(load.deepest_relative, depth / size);
  }
  add_edges(load);
  std::array<double, 18> sums{load.stored_energy, load.dissipation,    load.area,
                              load.n_touching,    load.absolute_force, load.damping};
  std::array<double, 2> largest{load.deepest, load.deepest_relative};
  const std::array<Tensor<1, 3> *, 4> vectors{&load.force, &load.moment, &load.residual_force,
                                              &load.residual_moment};
  for (unsigned int v = 0; v < vectors.size(); ++v)
    for (unsigned int i = 0; i < 3; ++i)
      sums[6 + 3 * v + i] = (*vectors[v])[i];
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), static_cast<int>(sums.size()), MPI_DOUBLE, MPI_SUM, communicator_);
  MPI_Allreduce(MPI_IN_PLACE, largest.data(), 2, MPI_DOUBLE, MPI_MAX, communicator_);
  load.stored_energy = sums[0];
  load.dissipation = sums[1];
  load.area = sums[2];
  load.n_touching = sums[3];
  load.absolute_force = sums[4];
  load.damping = sums[5];
  for (unsigned int v = 0; v < vectors.size(); ++v)
    for (unsigned int i = 0; i < 3; ++i)
      (*vectors[v])[i] = sums[6 + 3 * v + i];
  load.deepest = largest[0];
  load.deepest_relative = largest[1];
  return load;
}

double FacetContact::largest_spring() const {
  double largest = 0.;
  for (std::size_t s = 0; s < slaves_.size(); ++s)
    largest =
        std::max(largest, std::max(stiffness_[s].normal, history_.empty() ? 0. : stiffness_[s].tangential) *
                              sizes_[s] * sizes_[s]);
  return largest;
}

double FacetContact::local_dissipation() const {
  double dissipation = 0.;
  for (const auto &state : states_)
    dissipation += state.dissipation;
  return dissipation;
}

StepWorks FacetContact::compute_step_works(const double weight) const {
  StepWorks works;
  const bool hands_over = is_static_ && presses_at_both_ends();
  for (std::size_t s = 0; s < slaves_.size(); ++s) {
    const SlaveState &state = states_[s];
    works.touching -= state.taken_beyond - state.missed -
                      (hands_over ? state.dissipation_handed_over - state.dissipation : 0.);
    const PressureHistory &before = pressed_n_[s];
    const double ramp_depth =
        initial_depths_.empty() ? 0. : (allowed_part_n_ - allowed_part_) * initial_depths_[s];
    if (state.presses() && state.traction.pressure > 0.) {
      const double depth = std::max(0., -(state.contact.gap + augmentation(s)));
      const double closing = ramp_depth - compute_motion(s, duration_).displacement * state.contact.normal;
      works.add(before.pressure * state.own_area, state.traction.pressure * state.own_area, before.depth,
                depth, closing, ramp_depth, weight);
    } else if (before.pressure > 0. && touched_n_[s].exists()) {
      const SlaveMotion motion = compute_motion_after_contact(s, duration_);
      const Tensor<1, 3> normal = motion.rotation * before.normal;
      works.add(before.pressure * own_part(s) * before.area, 0., before.depth, 0.,
                ramp_depth - motion.displacement * normal, ramp_depth, weight);
    }
  }
  works.touching = dealii::Utilities::MPI::sum(works.touching, communicator_);
  works.ramp = dealii::Utilities::MPI::sum(works.ramp, communicator_);
  return works;
}

void FacetContact::commit() {
  has_started_ = true;
  for (std::size_t s = 0; s < slaves_.size(); ++s) {
    const SlaveState &state = states_[s];
    touched_n_[s] = state.touched;
    pressed_n_[s] = {};
    if (state.presses() && state.traction.pressure > 0.)
      pressed_n_[s] = {state.traction.pressure, std::max(0., -(state.contact.gap + augmentation(s))),
                       state.area, state.contact.normal};
  }
  base_ = history_n_ = history_;
  for (std::size_t s = 0; s < lifts_.size(); ++s) // what leaves the facet begins without when it comes back
    if (!states_[s].presses())
      lifts_[s] = 0.;
  lifts_n_ = lifts_;
  if (edges_)
    edges_->commit();
}

void FacetContact::close_initial_gaps(const Positions &positions, const double within) {
  Positions ignored(exchange_.n_own_nodes());
  has_lifts_ = true;
  // Of overlaps the mean gap is known of facets that are lowered so far that they overlap.
  const double lowered = overlaps_ ? within : 0.;
  initial_depths_.assign(slaves_.size(), -lowered);
  add_forces(positions, positions, 0., ignored);
  for (std::size_t s = 0; s < slaves_.size(); ++s) {
    const SlaveState &state = states_[s];
    const bool is_before = state.touched.exists() || state.is_near;
    const double gap = is_before ? state.contact.gap + lowered : 0.;
    initial_depths_[s] = gap > 0. && gap <= within ? -gap : 0.;
  }
}

double FacetContact::allow_initial_depths() {
  has_lifts_ = true;
  initial_depths_.resize(slaves_.size());
  double deepest = 0.;
  for (std::size_t s = 0; s < slaves_.size(); ++s)
    if (states_[s].presses()) {
      const double depth = std::max(0., -states_[s].contact.gap);
      initial_depths_[s] += depth;
      deepest = std::max(deepest, depth / sizes_[s]);
    }
  return deepest;
}

void FacetContact::restart() {
  n_changes_.assign(n_changes_.size(), 0);
  seen_.clear();
  take_back_augmentation();
}

void FacetContact::take_back_augmentation() {
  lifts_ = lifts_n_;
  last_augmentations_.clear();
  base_ = history_n_;
}

bool FacetContact::was_touching(const std::size_t s) const {
  if (history_n_[s].is_active)
    return true;
  const SlaveState &state = states_[s];
  const SlaveMotion motion = compute_motion(s, duration_);
  return state.contact.gap + motion.lift - motion.displacement * state.contact.normal <= motion.flush;
}

void FacetContact::augment_friction(const std::size_t s) {
  SlaveHistory &base = base_[s];
  const SlaveHistory &now = history_[s];
  if (base.is_active) {
    base.tangential = now.tangential;
    return;
  }
  // A frame that does not depend on the normal that is sought: from_normal() jumps.
  const Tensor<2, 3> rotation = compute_motion(s, duration_).rotation;
  base.is_active = true;
  base.frame = Frame::from_normal(dealii::transpose(rotation) * now.frame.n);
  const Frame frame = base.frame.transported(rotation, now.frame.n);
  const Tensor<1, 3> traction = now.tangential[0] * now.frame.q + now.tangential[1] * now.frame.r;
  base.tangential = {traction * frame.q, traction * frame.r};
}

void FacetContact::augment() {
  has_lifts_ = true;
  lifts_.resize(slaves_.size());
  last_augmentations_.resize(slaves_.size());
  Usage::count(Capability::augmentation, slaves_.size());
  augmentation_memory_.set(lifts_.size() * (sizeof(double) + sizeof(Augmentation)));
  for (std::size_t s = 0; s < slaves_.size(); ++s) {
    const bool presses = states_[s].presses();
    if (!base_.empty() && presses && was_touching(s)) // asks for the lift so far
      augment_friction(s);
    const double gap = presses ? states_[s].contact.gap + lifts_[s] : 0.;
    const double next = presses ? std::max(0., lifts_[s] - pace_of_augmentation(s, gap) * gap) : 0.;
    last_augmentations_[s] = {lifts_[s], gap};
    lifts_[s] = next;
  }
}

void FacetContact::scale_penalties(const double normal, const double tangential) {
  stiffening_ *= normal;
  tangential_stiffening_ *= tangential;
  for (std::size_t s = 0; s < stiffness_.size(); ++s)
    stiffness_[s] = {stiffening_ * given_stiffness_[s].normal,
                     tangential_stiffening_ * given_stiffness_[s].tangential};
  for (auto &lift : lifts_)
    lift /= normal;
  for (auto &lift : lifts_n_)
    lift /= normal;
  last_augmentations_.assign(last_augmentations_.size(), Augmentation());
}

void FacetContact::stiffen_under_load(const double normal, const double tangential) {
  scale_penalties(normal, tangential);
  has_lifts_ = true;
  initial_depths_.resize(slaves_.size());
  for (std::size_t s = 0; s < slaves_.size(); ++s) {
    if (!states_[s].presses() || !(states_[s].traction.pressure > 0.))
      continue;
    initial_depths_[s] -= (1. - 1. / normal) * states_[s].contact.gap;
    states_[s].contact.gap /= normal;
    pressed_n_[s].depth /= normal;
  }
}

double FacetContact::pace_of_augmentation(const std::size_t s, const double gap) const {
  const auto [lift_before, gap_before] = last_augmentations_[s];
  const double lifted = lifts_[s] - lift_before, closed = gap - gap_before;
  // Not where neighbours decided what became of it.
  const bool goes_on = gap_before * gap > 0. && std::abs(gap) < std::abs(gap_before) && lifted * closed > 0.;
  constexpr double fastest = 4.;
  return goes_on ? std::clamp(lifted / closed, 1., fastest) : 1.;
}

Penetration FacetContact::penetration() const {
  Penetration deepest;
  for (std::size_t s = 0; s < slaves_.size(); ++s)
    if (states_[s].presses() && states_[s].traction.pressure > 0.)
      deepest.add(std::abs(states_[s].contact.gap + augmentation(s)), sizes_[s]);
  return deepest;
}

double FacetContact::excessive_penetration() const {
  double largest = 0.;
  for (std::size_t s = 0; s < slaves_.size(); ++s)
    if (states_[s].presses() && states_[s].traction.pressure > 0.)
      largest = std::max(largest, std::abs(states_[s].contact.gap + augmentation(s)) /
                                      search_.facets()[states_[s].touched.facet].reach);
  return largest;
}

double FacetContact::closing_of_new_contacts() const {
  double largest = 0.;
  for (std::size_t s = 0; s < slaves_.size(); ++s)
    if (states_[s].presses() && states_[s].traction.pressure > 0. && !(pressed_n_[s].pressure > 0.))
      largest = std::max(largest, -(compute_motion(s, duration_).displacement * states_[s].contact.normal) /
                                      sizes_[s]);
  return largest;
}

double FacetContact::elastic_slip(const std::size_t s) const {
  const SlaveState &state = states_[s];
  if (!state.presses() || !(state.traction.pressure > 0.) || base_.empty() || !was_touching(s) ||
      state.traction.status != ContactStatus::stick)
    return 0.;
  return std::hypot(history_[s].tangential[0] - base_[s].tangential[0],
                    history_[s].tangential[1] - base_[s].tangential[1]) /
         stiffness_[s].tangential;
}

double FacetContact::augmentation_error() const {
  double worst = penetration().of_facet;
  for (std::size_t s = 0; s < slaves_.size(); ++s)
    worst = std::max(worst, elastic_slip(s) / sizes_[s]);
  return worst;
}

ContactSprings FacetContact::compute_springs() const {
  ContactSprings springs;
  springs.normal.of_nodes.resize(slaves_.size());
  springs.tangential.of_nodes.resize(slaves_.size());
  for (std::size_t s = 0; s < slaves_.size(); ++s) {
    const SlaveState &state = states_[s];
    if (!state.presses())
      continue;
    springs.add(s, state.own_area * state.traction.traction, state.contact.normal,
                state.own_area * stiffness_[s].normal * std::abs(state.contact.gap + augmentation(s)),
                state.own_area * stiffness_[s].tangential * elastic_slip(s));
  }
  return springs;
}

std::vector<SlaveForce> FacetContact::slave_forces() const {
  std::vector<SlaveForce> result(slaves_.size());
  for (std::size_t s = 0; s < slaves_.size(); ++s)
    if (states_[s].presses())
      result[s] = {states_[s].traction.status, states_[s].own_area * states_[s].traction.traction};
  return result;
}

std::vector<FacetContact::NodeReport> FacetContact::report() const {
  std::vector<NodeReport> reports(exchange_.n_own_nodes());
  for (std::size_t s = 0; s < slaves_.size(); ++s) {
    const SlaveState &state = states_[s];
    const bool touches = state.presses();
    reports[slaves_[s].node] = {
        state.traction.status,
        state.traction.pressure,
        touches ? state.contact.gap - state.touched.offset + lift(s).now : 0.,
        history_.empty() ? 0. : history_[s].slip,
        touches ? state.area : 0.,
        state.traction.traction,
        touches && state.traction.pressure > 0. ? std::abs(state.contact.gap + augmentation(s)) : 0.,
        history_.empty() ? 0. : stiffness_[s].tangential};
  }
  return reports;
}

} // namespace billet
