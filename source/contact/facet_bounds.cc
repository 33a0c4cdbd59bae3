// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/facet_bounds.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

void FacetBounds::add_row_sums(std::vector<double> &row_sums) {
  const SurfaceExchange &exchange = parts_.surfaces.exchange();
  sums_.assign(exchange.n_nodes(), 0.);
  for (std::size_t s = 0; s < parts_.touching.size(); ++s) {
    const SlaveState &state = parts_.touching[s];
    if (!(state.own_area > 0.))
      continue;
    const double k = std::max(parts_.penalties[s].normal, parts_.penalties[s].tangential);
    const std::vector<FacetShare> &shares = parts_.touching.shares();
    double columns = 1.;
    for (std::size_t i = state.first_share; i < state.end_of_shares; ++i)
      for (const double weight : shares[i].projection.weights)
        columns += shares[i].share * std::abs(weight);
    for (std::size_t i = state.first_share; i < state.end_of_shares; ++i) {
      const FacetShare &share = shares[i];
      const double spring = columns * k * parts_.touching.spring_area_of(state, share);
      if (share.slave_facet == FacetShare::none)
        sums_[parts_.slaves.node(s)] += spring;
      for (unsigned int a = 0; a < 4; ++a) {
        if (share.slave_facet != FacetShare::none)
          sums_[parts_.surfaces.facet(share.slave_facet).nodes[a]] += share.slave_weights[a] * spring;
        sums_[parts_.surfaces.facet(share.facet).nodes[a]] += std::abs(share.projection.weights[a]) * spring;
      }
    }
  }
  if (parts_.edges)
    parts_.edges->add_row_sums(sums_);
  exchange.collect(sums_);
  for (std::size_t i = 0; i < exchange.n_own_nodes(); ++i)
    row_sums[i] += sums_[i];
}

void FacetBounds::add_crossings(Crossings &crossings) const {
  if (parts_.touching.duration() == 0.)
    return;
  const FacetSearch::Positions &positions_n = parts_.surfaces.positions_n(),
                               &positions = parts_.surfaces.positions();
  double farthest = 0.;
  for (std::size_t i = 0; i < positions.size(); ++i)
    farthest = std::max(farthest, (positions[i] - positions_n[i]).norm_square());
  // A node and a facet may approach each other; Crossings covers twice the distance.
  farthest = 4. * std::sqrt(farthest);
  for (std::size_t s = 0; s < parts_.touching.size(); ++s) {
    const SlaveState &state = parts_.touching[s];
    if (!(state.own_area > 0.) || std::abs(state.contact.gap) > farthest)
      continue;
    double area = 0.;
    Tensor<1, 3> moved;
    for (std::size_t i = state.first_share; i < state.end_of_shares; ++i) {
      const FacetShare &share = parts_.touching.shares()[i];
      const FacetCorners before = corners_of(parts_.surfaces.facet(share.facet), positions_n),
                         now = parts_.surfaces.moved().corners(share.facet);
      Tensor<1, 3> part =
          parts_.touching.point_of(s, share, positions) - parts_.touching.point_of(s, share, positions_n);
      for (unsigned int a = 0; a < 4; ++a)
        part -= share.projection.weights[a] * (now[a] - before[a]);
      moved += share.share * part;
      area += parts_.touching.spring_area_of(state, share);
    }
    crossings.add(parts_.penalties[s].normal * area, state.contact.gap, moved * state.contact.normal);
  }
}

} // namespace billet
