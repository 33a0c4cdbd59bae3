// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/facet_choice.h"

#include "billet/geometry/bilinear_facet.h"
#include "billet/geometry/planed_facet.h"

namespace billet {

using dealii::Tensor;

namespace {

Tensor<1, 3> middle_of(const FacetCorners &corners) {
  return 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
}

/// The choice for one node. Each consider_ adds a facet to what is chosen from.
template <class Facet> class Choice {
public:
  Choice(const FacetSearch &search, const unsigned int node, const FacetSearch::Positions &positions_n,
         const FacetSearch::Positions &positions, const FacetSearch::Positions &normals,
         const ContactLimits &limits)
      : search_(search), positions_n_(positions_n), positions_(positions), limits_(limits),
        x_n_(positions_n[node]), x_(positions[node]),
        normal_(normals.empty() ? Tensor<1, 3>() : normals[node]) {}

  const TouchedFacet &best() const { return best_; }

  /// One that the node touches, or one around that.
  void consider_held(const unsigned int facet, const std::array<double, 2> &start) {
    const TouchedFacet touched{facet, project(facet, limits_.tolerance, start)};
    if (is_behind(touched) && is_held(touched) && is_on_its_own_side(touched))
      take_better(touched);
  }

  /// One that the node may have come through.
  void consider_new(const unsigned int facet) {
    const TouchedFacet touched{facet, project(facet, limits_.tolerance, {})};
    if (is_behind(touched) && has_come_through(facet) && is_on_its_own_side(touched))
      take_better(touched);
  }

  /// Only where it meets the one that is held in a concave edge.
  void consider_beside_held(const unsigned int facet) {
    const TouchedFacet held = best_;
    consider_new(facet);
    if (best_.facet != held.facet && !is_concave(held, best_))
      best_ = held;
  }

  /// The seam of facets around the last one, all of which the node is behind.
  void consider_seam(const unsigned int last) {
    TouchedFacet nearest;
    nearest.projection.excess = limits_.seam_tolerance;
    unsigned int n_near = 0;
    bool is_behind_all = true;
    const auto look_at = [&](const unsigned int facet) {
      const TouchedFacet touched{facet, project(facet, limits_.seam_tolerance, {})};
      if (!touched.projection.exists)
        return;
      ++n_near;
      is_behind_all = is_behind_all && is_behind(touched) && is_held(touched);
      if (touched.projection.excess < nearest.projection.excess)
        nearest = touched;
    };
    look_at(last);
    search_.visit_ring(last, look_at);
    if (n_near > 1 && is_behind_all)
      best_ = nearest;
  }

private:
  FacetProjection project(const unsigned int facet, const double tolerance,
                          const std::array<double, 2> &start) const {
    return Facet(corners_of(search_.facets()[facet], positions_)).project(x_, {tolerance}, start);
  }

  /// Within its border, and the normals oppose.
  bool is_behind(const TouchedFacet &touched) const {
    return touched.projection.exists && touched.projection.gap < 0. &&
           normal_ * touched.projection.normal < limits_.largest_alignment;
  }

  bool is_held(const TouchedFacet &touched) const {
    return touched.projection.gap >= -limits_.held_depth * search_.facets()[touched.facet].reach;
  }

  /// At the start of the step the node was before the facet, or not far behind. Its plane is enough to tell.
  bool has_come_through(const unsigned int facet) const {
    const SurfaceFacet &target = search_.facets()[facet];
    return PlanedFacet(corners_of(target, positions_n_)).project(x_n_, {}).gap >= -target.reach;
  }

  /// A node that is beyond the border, within the tolerance, may be out of the body: before the facet next to
  /// this one, as beside a block.
  bool is_on_its_own_side(const TouchedFacet &touched) const {
    bool is_out = false;
    if (touched.projection.excess > 0.)
      search_.visit_ring(touched.facet, [&](const unsigned int facet) {
        const FacetProjection p = project(facet, limits_.tolerance, {});
        is_out = is_out || (p.exists && p.gap >= 0.);
      });
    return !is_out;
  }

  /// The middle of neither lies behind the other.
  bool is_concave(const TouchedFacet &a, const TouchedFacet &b) const {
    const Tensor<1, 3> from_a_to_b = middle_of(corners_of(search_.facets()[b.facet], positions_)) -
                                     middle_of(corners_of(search_.facets()[a.facet], positions_));
    return from_a_to_b * a.projection.normal >= 0. && from_a_to_b * b.projection.normal <= 0.;
  }

  void take_better(const TouchedFacet &other) {
    const double deeper = best_.projection.gap - other.projection.gap;
    if (!best_.exists() || (is_concave(best_, other) ? deeper > 0. : deeper < 0.))
      best_ = other;
  }

  const FacetSearch &search_;
  const FacetSearch::Positions &positions_n_, &positions_;
  const ContactLimits &limits_;
  const Tensor<1, 3> x_n_, x_, normal_;
  TouchedFacet best_;
};

} // namespace

template <class Facet>
TouchedFacet choose_facet(const FacetSearch &search, const std::size_t slave,
                          const FacetSearch::Positions &positions_n, const FacetSearch::Positions &positions,
                          const FacetSearch::Positions &normals, const TouchedFacet &last,
                          const ContactLimits &limits) {
  Choice<Facet> choice(search, search.slaves()[slave].node, positions_n, positions, normals, limits);
  if (last.exists()) {
    choice.consider_held(last.facet, last.projection.parameters);
    if (!choice.best().exists())
      search.visit_ring(last.facet, [&](const unsigned int facet) { choice.consider_held(facet, {}); });
    if (!choice.best().exists())
      choice.consider_seam(last.facet);
  }
  if (choice.best().exists())
    search.visit_candidates(slave, [&](const unsigned int facet) { choice.consider_beside_held(facet); });
  else
    search.visit_candidates(slave, [&](const unsigned int facet) { choice.consider_new(facet); });
  return choice.best();
}

FacetSearch::Positions compute_node_normals(const std::vector<SurfaceFacet> &facets,
                                            const FacetSearch::Positions &positions) {
  FacetSearch::Positions normals(positions.size());
  for (const auto &facet : facets) {
    const FacetCorners x = corners_of(facet, positions);
    const Tensor<1, 3> area_vector = dealii::cross_product_3d(x[3] - x[0], x[2] - x[1]);
    for (const unsigned int node : facet.nodes)
      normals[node] += area_vector;
  }
  for (auto &normal : normals) {
    const double size = normal.norm();
    if (size > 0.)
      normal /= size;
  }
  return normals;
}

#define BILLET_INSTANTIATE(Facet)                                                                            \
  template TouchedFacet choose_facet<Facet>(                                                                 \
      const FacetSearch &, std::size_t, const FacetSearch::Positions &, const FacetSearch::Positions &,      \
      const FacetSearch::Positions &, const TouchedFacet &, const ContactLimits &);
BILLET_INSTANTIATE(PlanedFacet)
BILLET_INSTANTIATE(BilinearFacet)
#undef BILLET_INSTANTIATE

} // namespace billet
