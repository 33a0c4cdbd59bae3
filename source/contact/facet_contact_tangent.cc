// SPDX-License-Identifier: LGPL-2.1-or-later
// What FacetContact does in schemes with a matrix.
#include "billet/contact/facet_areas.h"
#include "billet/contact/facet_contact.h"
#include "billet/contact/facet_reaction.h"
#include "billet/geometry/bilinear_facet.h"
#include "billet/geometry/derivative.h"
#include "billet/geometry/planed_facet.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace billet {

using dealii::FullMatrix;
using dealii::Tensor;

namespace {

std::size_t index_of(const std::vector<unsigned int> &nodes, const unsigned int node) {
  return static_cast<std::size_t>(std::find(nodes.begin(), nodes.end(), node) - nodes.begin());
}

void add_once(std::vector<unsigned int> &nodes, const std::array<unsigned int, 4> &more) {
  for (const unsigned int node : more)
    if (index_of(nodes, node) == nodes.size())
      nodes.push_back(node);
}

bool is_exact(const ContactTangent kind) {
  return kind == ContactTangent::exact || kind == ContactTangent::numerical;
}

/// An overlap with derivatives by the variables of its corners: each corner's coordinates are variables.
template <class Number>
FacetOverlapOf<Number>
follow_overlap(const FacetCornersOf<Number> &slave, const FacetCornersOf<Number> &target, const double depth,
               const std::array<double, 4> &lifts, const std::array<double, 4> &augmentation,
               const FacetBulge &slave_bulge, const FacetBulge &target_bulge) {
  if constexpr (std::is_same_v<Number, double>)
    return compute_overlap(slave, target, depth, lifts, augmentation, slave_bulge, target_bulge);
  else {
    // By the 24 of this pair alone, and then by the chain rule: many fewer than a slave depends on.
    constexpr int n = 24;
    FacetCornersOf<Derivative> s, t;
    for (unsigned int a = 0; a < 4; ++a)
      for (unsigned int i = 0; i < 3; ++i) {
        s[a][i] = Derivative(n, static_cast<int>(3 * a + i), slave[a][i].val());
        t[a][i] = Derivative(n, static_cast<int>(12 + 3 * a + i), target[a][i].val());
      }
    FacetOverlapOf<Derivative> overlap =
        compute_overlap(s, t, depth, lifts, augmentation, slave_bulge, target_bulge);
    const auto chain = [&](Derivative &value) {
      Derivative result = value.val();
      result.resize(slave[0][0].size());
      for (int j = 0; j < result.size(); ++j)
        result.fastAccessDx(j) = 0.;
      if (value.size() > 0)
        for (unsigned int a = 0; a < 4; ++a)
          for (unsigned int i = 0; i < 3; ++i) {
            const auto add = [&](const Derivative &variable, const double slope) {
              for (int j = 0; j < result.size(); ++j)
                result.fastAccessDx(j) += slope * variable.dx(j);
            };
            add(slave[a][i], value.dx(static_cast<int>(3 * a + i)));
            add(target[a][i], value.dx(static_cast<int>(12 + 3 * a + i)));
          }
      value = result;
    };
    for (unsigned int i = 0; i < 3; ++i)
      chain(overlap.normal[i]);
    for (unsigned int a = 0; a < 4; ++a) {
      chain(overlap.areas[a]);
      chain(overlap.gaps[a]);
      chain(overlap.depths[a]);
      for (unsigned int b = 0; b < 4; ++b) {
        chain(overlap.slave_parts[a][b]);
        chain(overlap.target_parts[a][b]);
      }
    }
    return overlap;
  }
}

/// The projection `found` as it follows the corners and the node x.
template <class Facet, class Number>
FacetProjectionOf<Number> follow(const FacetCornersOf<Number> &corners, const Tensor<1, 3, Number> &x,
                                 const FacetLimits &limits, const FacetProjection &found) {
  if constexpr (std::is_same_v<Facet, BilinearFacet>)
    return BilinearFacet::follow<Number>(corners, x, limits, found);
  else if constexpr (std::is_same_v<Facet, MeanGapFacet>)
    return MeanGapFacetOf<Number>(corners).project(x, limits);
  else
    return PlanedFacetOf<Number>(corners).project(x, limits);
}

} // namespace

std::vector<unsigned int> FacetContact::collect_nodes(const std::size_t s, const bool with_own_facets) const {
  const SlaveState &state = states_[s];
  std::vector<unsigned int> nodes{slaves_[s].node};
  for (std::size_t i = state.first_share; i < state.end_of_shares; ++i) {
    add_once(nodes, search_.facets()[shares_[i].facet].nodes);
    if (shares_[i].slave_facet != FacetShare::none)
      add_once(nodes, search_.facets()[shares_[i].slave_facet].nodes);
  }
  if (with_own_facets)
    search_.visit_around(slaves_[s].node,
                         [&](const unsigned int f) { add_once(nodes, search_.facets()[f].nodes); });
  return nodes;
}

void FacetContact::visit_tangents(const ContactTangent kind, const AddTangent &add) const {
  const auto visit = [&](const auto &law, const auto &add_one) {
    for (std::size_t s = 0; s < slaves_.size(); ++s)
      if (states_[s].presses() && states_[s].own_area > 0.)
        add_one(law, s);
  };
  choose_friction(settings_.friction, [&](const auto &law) {
    const auto visit_facets = [&](auto method) {
      using Facet = typename decltype(method)::type;
      using Law = std::decay_t<decltype(law)>;
      if (kind == ContactTangent::numerical)
        visit(law, [&](const Law &l, const std::size_t s) { add_numerical_tangent<Facet>(l, s, add); });
      else if (kind == ContactTangent::exact)
        visit(law, [&](const Law &l, const std::size_t s) { add_exact_tangent<Facet>(l, s, add); });
      else
        visit(law, [&](const Law &l, const std::size_t s) { add_closed_tangent(l, kind, s, add); });
    };
    visit_method(settings_.method, visit_facets);
  });
}

template <class Law>
void FacetContact::add_closed_tangent(const Law &law, const ContactTangent kind, const std::size_t s,
                                      const AddTangent &add) const {
  const SlaveState &state = states_[s];
  const Tensor<1, 3> &n = state.contact.normal;
  const Tensor<2, 3> along_normal = stiffness_[s].normal * dealii::outer_product(n, n);
  Tensor<2, 3> K = along_normal;
  if constexpr (!std::is_same_v<Law, Frictionless>) {
    SlaveHistory ignored;
    compute_slave_traction(law, stiffness_[s], n, state.contact.gap, compute_motion(s, duration_), base_[s],
                           ignored, kind, &K);
  } else
    (void)law, (void)kind;
  const std::vector<unsigned int> nodes = collect_nodes(s, false);
  FullMatrix<double> matrix(3 * nodes.size(), 3 * nodes.size());
  // By how much the node's motion, and forces of this rank, are those of the nodes; of all shares, and of
  // one.
  std::vector<double> weights(nodes.size()), areas(nodes.size()), own(nodes.size());
  const auto add_product = [&](const std::vector<double> &rows, const std::vector<double> &columns,
                               const double factor, const Tensor<2, 3> &D) {
    for (std::size_t a = 0; a < nodes.size(); ++a)
      for (std::size_t b = 0; b < nodes.size(); ++b)
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j < 3; ++j)
            matrix(3 * a + i, 3 * b + j) += factor * rows[a] * columns[b] * D[i][j];
  };
  for (std::size_t i = state.first_share; i < state.end_of_shares; ++i) {
    const FacetShare &share = shares_[i];
    const bool is_overlap = share.slave_facet != FacetShare::none;
    own.assign(nodes.size(), 0.);
    if (!is_overlap)
      own[0] = 1.;
    for (unsigned int a = 0; a < 4; ++a) {
      if (is_overlap)
        own[index_of(nodes, search_.facets()[share.slave_facet].nodes[a])] += share.slave_weights[a];
      own[index_of(nodes, search_.facets()[share.facet].nodes[a])] -= share.projection.weights[a];
    }
    const double area = area_of(state, share);
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      weights[a] += share.share * own[a];
      areas[a] += area * own[a];
    }
    if (is_overlap && area > 0.) // A g is the sum of all A_f g_f
      add_product(own, own, share.area, along_normal);
  }
  const bool are_overlaps = shares_[state.first_share].slave_facet != FacetShare::none;
  add_product(areas, weights, 1., are_overlaps ? K - along_normal : K);
  add(nodes, matrix);
}

template <class Facet, class Law, class Number>
std::vector<Tensor<1, 3, Number>>
FacetContact::follow_forces(const Law &law, const std::size_t s, const std::vector<unsigned int> &nodes,
                            const std::vector<Tensor<1, 3, Number>> &x) const {
  const SlaveState &state = states_[s];
  const auto corners_now = [&](const unsigned int facet) {
    FacetCornersOf<Number> corners;
    for (unsigned int a = 0; a < 4; ++a)
      corners[a] = x[index_of(nodes, search_.facets()[facet].nodes[a])];
    return corners;
  };
  std::vector<FacetShareOf<Number>> shares;
  std::vector<Tensor<1, 3, Number>> points; // as slave_point()
  if constexpr (std::is_same_v<Facet, OverlapFacet>) {
    for (std::size_t i = state.first_share; i < state.end_of_shares; ++i) {
      const FacetShare &share = shares_[i];
      const SurfaceFacet &own = search_.facets()[share.slave_facet];
      const unsigned int corner = corner_of(own, slaves_[s].node);
      const auto corners = corners_now(share.slave_facet);
      const auto overlap = follow_overlap<Number>(
          corners, corners_now(share.facet), share.depth, corners_of(own, nodal_lifts_),
          corners_of(own, nodal_augmentations_), own.bulge, search_.facets()[share.facet].bulge);
      shares.push_back(
          share_of_overlap(overlap, corner, share.slave_facet, share.facet, share.depth, depth_rounding(s)));
      points.push_back(facet::interpolate(shares.back().slave_weights, corners));
    }
  } else {
    const FacetLimits limits = make_limits(std::numeric_limits<double>::infinity(), settings_.limits);
    for (std::size_t i = state.first_share; i < state.end_of_shares; ++i) {
      const FacetShare &share = shares_[i];
      const auto projection =
          raised(follow<Facet, Number>(corners_now(share.facet), x[0], limits, share.projection),
                 search_.facets()[share.facet]);
      shares.push_back({share.facet, projection.share, projection});
      points.push_back(x[0]);
    }
  }
  SharedGapOf<Number> contact;
  if (shares.size() == 1) {
    shares[0].share = 1.;
    contact = {shares[0].projection.normal, shares[0].projection.gap};
  } else
    contact = combine(shares, 0);
  // Overlaps know what depths allow.
  contact.gap -= std::is_same_v<Facet, OverlapFacet> ? augmentation(s) : lift(s).now - state.touched.offset;

  Tensor<1, 3, Number> traction;
  if constexpr (std::is_same_v<Law, Frictionless>)
    traction = compute_slave_traction(law, stiffness_[s].normal, contact.normal, contact.gap).traction;
  else {
    SlaveMotionOf<Number> mean{Tensor<1, 3, Number>(), Tensor<2, 3, Number>(), duration_, augmentation(s),
                               flush_gap(s)};
    for (std::size_t i = 0; i < shares.size(); ++i) {
      const auto &share = shares[i];
      Tensor<1, 3, Number> point_n = positions_n_[slaves_[s].node];
      if constexpr (std::is_same_v<Facet, OverlapFacet>) {
        point_n.clear();
        for (unsigned int a = 0; a < 4; ++a)
          point_n += share.slave_weights[a] * positions_n_[search_.facets()[share.slave_facet].nodes[a]];
      }
      const auto motion = compute_slave_motion<Number>(
          corners_of(search_.facets()[share.facet], positions_n_), corners_now(share.facet),
          share.projection.weights, point_n, points[i], duration_);
      mean.displacement += share.share * motion.displacement;
      mean.rotation += share.share * motion.rotation;
    }
    SlaveHistory ignored;
    traction =
        compute_slave_traction(law, stiffness_[s], contact.normal, contact.gap, mean, base_[s], ignored)
            .traction;
  }
  std::vector<Tensor<1, 3, Number>> forces(nodes.size());
  const auto add_reaction = [&](const FacetShareOf<Number> &share, const Tensor<1, 3, Number> &point,
                                const Tensor<1, 3, Number> &part) {
    const FacetReactionOf<Number> reaction(corners_now(share.facet));
    const FacetCornersOf<Number> on_corners = reaction(share.projection.weights, point, part);
    for (unsigned int a = 0; a < 4; ++a)
      forces[index_of(nodes, search_.facets()[share.facet].nodes[a])] += on_corners[a];
  };
  if constexpr (std::is_same_v<Facet, OverlapFacet>) {
    const Number area = effective_area(shares, 0);
    for (std::size_t i = 0; i < shares.size(); ++i) {
      if (shares[i].slave_facet >= exchange_.n_own_facets())
        continue;
      const Tensor<1, 3, Number> part = Number(shares[i].share * area) * traction;
      for (unsigned int a = 0; a < 4; ++a)
        forces[index_of(nodes, search_.facets()[shares[i].slave_facet].nodes[a])] +=
            shares[i].slave_weights[a] * part;
      add_reaction(shares[i], points[i], part);
    }
    return forces;
  }
  Number area = 0.;
  search_.visit_around(slaves_[s].node, [&](const unsigned int f) {
    if (f < exchange_.n_own_facets())
      area += FacetAreasOf<Number>(corners_now(f))
                  .share(corner_of(search_.facets()[f], slaves_[s].node), contact.normal);
  });
  const Tensor<1, 3, Number> force = area * traction;
  forces[0] = force;
  for (std::size_t i = 0; i < shares.size(); ++i)
    add_reaction(shares[i], points[i], Tensor<1, 3, Number>(shares[i].share * force));
  return forces;
}

template <class Facet, class Law>
void FacetContact::add_exact_tangent(const Law &law, const std::size_t s, const AddTangent &add) const {
  const std::vector<unsigned int> nodes = collect_nodes(s, true);
  const std::size_t n = 3 * nodes.size();
  if (n > most_variables) { // only at a corner of a dozen facets
    add_numerical_tangent<Facet>(law, s, add);
    return;
  }
  std::vector<Tensor<1, 3, Derivative>> x(nodes.size());
  for (std::size_t a = 0; a < nodes.size(); ++a)
    for (unsigned int i = 0; i < 3; ++i)
      x[a][i] = Derivative(static_cast<int>(n), static_cast<int>(3 * a + i), positions_[nodes[a]][i]);
  const auto forces = follow_forces<Facet>(law, s, nodes, x);
  FullMatrix<double> matrix(n, n);
  for (std::size_t a = 0; a < nodes.size(); ++a)
    for (unsigned int i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < n; ++j)
        matrix(3 * a + i, j) = -forces[a][i].dx(static_cast<int>(j));
  add(nodes, matrix);
}

template <class Facet, class Law>
void FacetContact::add_numerical_tangent(const Law &law, const std::size_t s, const AddTangent &add) const {
  if (states_[s].rests) { // it sticks once it is pressed, which small differences do not show
    add_closed_tangent(law, ContactTangent::consistent, s, add);
    return;
  }
  const std::vector<unsigned int> nodes = collect_nodes(s, true);
  std::vector<Tensor<1, 3>> x;
  x.reserve(nodes.size());
  for (const unsigned int node : nodes)
    x.push_back(positions_[node]);
  FullMatrix<double> matrix(3 * nodes.size(), 3 * nodes.size());
  const double h = 1e-7 * sizes_[s];
  for (std::size_t b = 0; b < nodes.size(); ++b)
    for (unsigned int j = 0; j < 3; ++j)
      for (const double sign : {1., -1.}) {
        x[b][j] = positions_[nodes[b]][j] + sign * h;
        const auto forces = follow_forces<Facet>(law, s, nodes, x);
        for (std::size_t a = 0; a < nodes.size(); ++a)
          for (unsigned int i = 0; i < 3; ++i)
            matrix(3 * a + i, 3 * b + j) -= sign / (2. * h) * forces[a][i];
        x[b][j] = positions_[nodes[b]][j];
      }
  add(nodes, matrix);
}

void FacetContact::visit_couplings(const ContactTangent kind,
                                   const std::function<void(const std::vector<unsigned int> &)> &add) {
  coupled_.assign(slaves_.size(), {});
  for (std::size_t s = 0; s < slaves_.size(); ++s) {
    std::vector<unsigned int> facets;
    search_.visit_candidates(s, [&](const unsigned int f) { facets.push_back(f); });
    if (overlaps_)
      search_.visit_around(slaves_[s].node, [&](const unsigned int own) {
        overlaps_->visit_candidates(own, [&](const unsigned int f) { facets.push_back(f); });
      });
    else if (states_[s].presses()) { // where it may slide next
      const unsigned int touched = states_[s].touched.facet;
      facets.push_back(touched);
      search_.visit_ring(touched, [&](const unsigned int f) { facets.push_back(f); });
      for (std::size_t i = states_[s].first_share; i < states_[s].end_of_shares; ++i)
        facets.push_back(shares_[i].facet);
    }
    if (facets.empty())
      continue;
    std::vector<unsigned int> nodes{slaves_[s].node};
    for (const unsigned int f : facets) {
      add_once(nodes, search_.facets()[f].nodes);
      coupled_[s].push_back(search_.facets()[f].key);
    }
    std::sort(coupled_[s].begin(), coupled_[s].end());
    if (is_exact(kind) || overlaps_)
      search_.visit_around(slaves_[s].node,
                           [&](const unsigned int f) { add_once(nodes, search_.facets()[f].nodes); });
    add(nodes);
  }
}

bool FacetContact::has_new_couplings() const {
  for (std::size_t s = 0; s < slaves_.size(); ++s) {
    if (!states_[s].presses() || !(states_[s].own_area > 0.))
      continue;
    for (std::size_t i = states_[s].first_share; i < states_[s].end_of_shares; ++i)
      if (coupled_.empty() ||
          !std::binary_search(coupled_[s].begin(), coupled_[s].end(), search_.facets()[shares_[i].facet].key))
        return true;
  }
  return false;
}

} // namespace billet
