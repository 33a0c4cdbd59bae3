// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/slave_finder.h"

#include "billet/geometry/bilinear_facet.h"
#include "billet/geometry/planed_facet.h"

#include <algorithm>

namespace billet {

namespace {

constexpr double rounding = 1e-13; ///< penetration due to round-off [facet sizes]

} // namespace

template <class Facet> void SlaveFinder<Facet>::find(const std::size_t s) {
  SlaveState &state = parts_.touching[s];
  std::vector<FacetShare> &shares = parts_.touching.shares();
  const TouchedFacet last_iteration = state.touched;
  state = SlaveState();
  state.first_share = shares.size();
  const bool has_candidates = parts_.surfaces.search().has_candidates(s);
  if (has_candidates || parts_.start.touched(s).exists())
    state.touched = choose(s, last_iteration);
  if (state.touched.exists()) {
    state.contact = share_facets<Facet>(parts_.surfaces.moved(), state.touched,
                                        parts_.surfaces.positions()[parts_.slaves.node(s)],
                                        parts_.settings.limits, shares);
    state.contact.gap -= parts_.offsets.of(s).now;
    if (!(state.contact.gap < 0.)) {
      state.touched = TouchedFacet();
      shares.resize(state.first_share);
    } else if (parts_.start.has_started()) {
      state.touched.offset = std::min(state.touched.offset, -state.contact.gap);
      state.contact.gap += state.touched.offset;
    } else // initially penetrating bodies separate here
      state.touched.offset = 0.;
  }
  if (!state.touched.exists() && has_candidates)
    find_below(s, state);
  state.end_of_shares = shares.size();
  if (state.end_of_shares > state.first_share)
    compute_areas(s, state);
}

template <class Facet>
TouchedFacet SlaveFinder<Facet>::choose(const std::size_t s, const TouchedFacet &last_iteration) const {
  const MovedFacets &facets = parts_.surfaces.moved();
  const FacetSearch::Positions &positions_n = parts_.surfaces.positions_n();
  const GapOffset gap_offset = parts_.offsets.of(s);
  TouchedFacet touched;
  // Indices of facets are valid only for the last search; it is rarely rebuilt while a node is
  // restless.
  if (parts_.restless.is_restless(s) && last_iteration.exists() && !parts_.surfaces.is_rebuilt())
    touched = keep_facet<Facet>(facets, s, positions_n, last_iteration, parts_.settings.limits, gap_offset);
  if (!touched.exists())
    touched = choose_facet<Facet>(facets, s, positions_n, parts_.start.touched(s), parts_.settings.limits,
                                  gap_offset, parts_.start.pressed(s).pressure > 0.);
  return touched;
}

template <class Facet> void SlaveFinder<Facet>::find_below(const std::size_t s, SlaveState &state) {
  const TouchedFacet below = find_facet_below(parts_.surfaces.moved(), s, parts_.settings.limits);
  if (!below.exists())
    return;
  const double on_it = parts_.settings.touching_gap * parts_.slaves.facet_size(s);
  const double gap = below.projection.gap - parts_.offsets.of(s).now;
  state.rests = gap <= on_it && is_resting(below, s, on_it);
  state.is_near = !state.rests;
  if (state.rests)
    state.touched = below;
  state.contact = {below.projection.normal, gap};
  parts_.touching.shares().push_back({below.facet, 1., below.projection});
}

template <class Facet>
bool SlaveFinder<Facet>::is_resting(const TouchedFacet &below, const std::size_t s,
                                    const double on_it) const {
  const SurfaceFacet &facet = parts_.surfaces.facet(below.facet);
  const FacetSearch::Positions &positions_n = parts_.surfaces.positions_n();
  const FacetProjection before = raised(
      PlanedFacet(corners_of(facet, positions_n)).project(positions_n[parts_.slaves.node(s)], {}), facet);
  return before.exists && before.gap - parts_.offsets.of(s).at_start <= on_it;
}

template <class Facet> void SlaveFinder<Facet>::compute_areas(const std::size_t s, SlaveState &state) const {
  // A near node counts only in bounds, for which an estimate suffices: a quarter of each undeformed
  // facet.
  const double quarter = 0.25 * parts_.slaves.facet_size(s) * parts_.slaves.facet_size(s);
  const unsigned int node = parts_.slaves.node(s);
  parts_.surfaces.search().visit_around(node, [&](const unsigned int f) {
    const double share = state.is_near ? quarter
                                       : parts_.surfaces.moved().areas(f).share(
                                             corner_of(parts_.surfaces.facet(f), node), state.contact.normal);
    state.area += share;
    if (parts_.surfaces.owns(f))
      state.own_area += share;
  });
}

void SlaveFinder<OverlapFacet>::find(const std::size_t s) {
  SlaveState &state = parts_.touching[s];
  std::vector<FacetShare> &shares = parts_.touching.shares();
  const SlaveNodes &slaves = parts_.slaves;
  state = SlaveState();
  state.first_share = shares.size();
  double maximum = 0.;
  parts_.surfaces.search().visit_around(slaves.node(s), [&](const unsigned int f) {
    const unsigned int corner = corner_of(parts_.surfaces.facet(f), slaves.node(s));
    parts_.overlaps->pairs().visit(f, [&](const FacetOverlaps::Overlap &overlap) {
      shares.push_back(share_of_overlap(overlap.integrals, corner, f, overlap.target, overlap.penetration,
                                        slaves.penetration_rounding(s)));
      const FacetShare &share = shares.back();
      if (share.share > maximum) {
        maximum = share.share;
        state.touched.facet = overlap.target;
      }
      if (!(share.area > 0.))
        shares.pop_back();
    });
  });
  state.end_of_shares = shares.size();
  if (!state.touched.exists())
    return;
  state.contact = combine(shares, state.first_share);
  state.contact.gap -= parts_.offsets.augmentation[s];
  state.area = effective_area(shares, state.first_share);
  for (std::size_t i = state.first_share; i < state.end_of_shares; ++i)
    state.own_area += parts_.touching.area_of(state, shares[i]);
  if (state.contact.gap < -rounding * slaves.facet_size(s))
    return;
  // Flush facets just touch; others are within the gap offsets of their other corners.
  state.contact.gap = std::max(0., state.contact.gap);
  state.rests = state.contact.gap <= slaves.flush_gap(s);
  if (!state.rests)
    state.touched = TouchedFacet();
}

template class SlaveFinder<PlanedFacet>;
template class SlaveFinder<MeanGapFacet>;
template class SlaveFinder<BilinearFacet>;

} // namespace billet
