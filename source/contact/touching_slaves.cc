// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/touching_slaves.h"

namespace billet {

using dealii::Tensor;

TouchingSlaves::TouchingSlaves(const ContactSurfaces &surfaces, const SlaveNodes &slaves,
                               const GapOffsets &offsets, const SlaveStart &start)
    : surfaces_(surfaces), slaves_(slaves), offsets_(offsets), start_(start), states_(slaves.size()) {
  memory_.set(slaves.size() * (sizeof(SlaveNode) + sizeof(SlaveState)));
}

double TouchingSlaves::own_part(const std::size_t s) const {
  double n_own = 0., n_facets = 0.;
  surfaces_.search().visit_around(slaves_.node(s), [&](const unsigned int f) {
    n_facets += 1.;
    n_own += surfaces_.owns(f) ? 1. : 0.;
  });
  return n_own / n_facets;
}

SlaveMotion TouchingSlaves::motion_of(const std::size_t s) const {
  SlaveMotion mean{Tensor<1, 3>(), Tensor<2, 3>(), duration_, offsets_.augmentation[s], slaves_.flush_gap(s)};
  for (std::size_t i = states_[s].first_share; i < states_[s].end_of_shares; ++i) {
    const FacetShare &share = shares_[i];
    const SlaveMotion motion = compute_slave_motion(
        corners_of(surfaces_.facet(share.facet), surfaces_.positions_n()),
        surfaces_.moved().corners(share.facet), share.projection.weights,
        point_of(s, share, surfaces_.positions_n()), point_of(s, share, surfaces_.positions()), duration_);
    mean.displacement += share.share * motion.displacement;
    // The sum is nearly a rotation; transported vectors are normalised again.
    mean.rotation += share.share * motion.rotation;
  }
  return mean;
}

SlaveMotion TouchingSlaves::motion_after_contact(const std::size_t s) const {
  if (!start_.touched(s).exists())
    return {};
  const unsigned int facet = start_.touched(s).facet, node = slaves_.node(s);
  const Tensor<1, 3> &x_n = surfaces_.positions_n()[node];
  const FacetCorners corners_n = corners_of(surfaces_.facet(facet), surfaces_.positions_n());
  return compute_slave_motion(corners_n, surfaces_.moved().corners(facet),
                              PlanedFacet(corners_n).project(x_n, {}).weights, x_n,
                              surfaces_.positions()[node], duration_);
}

} // namespace billet
