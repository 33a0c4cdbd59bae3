// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/facet_choice.h"

#include "billet/contact/facet_sharing.h"
#include "billet/geometry/bilinear_facet.h"
#include "billet/geometry/planed_facet.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace billet {

using dealii::Tensor;

namespace {

/// Reduction of the scalar product of the normals of node and facet for which another facet
/// replaces the last one.
constexpr double far_better = 0.5;

/// Maximum distance beyond a facet's edge at which a node counts as in line with it, as where the
/// ends of two bodies are coplanar. Round-off must not decide whether the node is beside the body.
constexpr double in_line = 1e-3;

/// Minimum scalar product of the normals of facets that count as coplanar or stacked. For a node
/// that touches one of them, the other is not the second flank of a concave edge.
constexpr double one_plane = 0.99;

/// Choice of a facet for one node. Each consider_ function adds a facet to the options.
template <class Facet> class Choice {
public:
  Choice(const MovedFacets &facets, const unsigned int node, const FacetSearch::Positions &positions_n,
         const ContactLimits &limits, const GapOffset &gap_offset, const bool has_pressed = false)
      : facets_(facets), search_(facets.search()), positions_n_(positions_n), limits_(limits), node_(node),
        x_n_(positions_n[node]), x_(facets.position(node)), gap_offset_(gap_offset),
        has_pressed_(has_pressed) {}

  const TouchedFacet &best() const { return best_; }

  /// Considers a facet around the last one. The two may not meet smoothly, as at the edge of an
  /// end. The node may then be far behind one of them without having come through it.
  void consider_around(const TouchedFacet &last, const unsigned int facet) {
    TouchedFacet touched = project_onto(facet, {});
    if (!touched.exists() || !is_held(touched))
      return;
    if (meet_smoothly(last.projection.normal, touched.projection.normal))
      touched.offset = std::min(last.offset, penetration_of(touched));
    else if (!has_come_through(touched))
      return;
    if (faces(touched) && is_on_its_own_side(touched))
      take_better(touched);
  }

  /// Considers the facet that the node touches.
  void consider_held(const TouchedFacet &last) {
    TouchedFacet touched = project_onto(last.facet, last.projection.parameters);
    touched.offset = std::min(last.offset, penetration_of(touched));
    if (touched.exists() && is_held(touched) && faces(touched) && is_on_its_own_side(touched))
      take_better(touched);
  }

  /// Considers a facet that the node may have come through.
  void consider_new(const unsigned int facet) {
    TouchedFacet touched = project_onto(facet, {});
    if (touched.exists() && has_come_through(touched) && faces(touched) && is_on_its_own_side(touched))
      take_better(touched);
  }

  /// Considers a facet only if it meets the touched facet at a concave edge, or faces the node much
  /// better.
  void consider_beside_held(const unsigned int facet) {
    if (facet == best_.facet ||
        facets_.plane(facet).normal() * facets_.plane(best_.facet).normal() > one_plane)
      return;
    TouchedFacet held;
    std::swap(held, best_);
    consider_new(facet);
    if (!best_.exists() || !(is_deeper_beside(best_, held) ||
                             (held.projection.normal - best_.projection.normal) * normal() > far_better))
      best_ = held;
  }

  /// Considers the seam of facets around the last one if the node is behind all of them.
  void consider_seam(const TouchedFacet &last) {
    TouchedFacet nearest;
    nearest.projection.excess = limits_.seam_tolerance;
    unsigned int n_near = 0;
    bool is_behind_all = true;
    const auto add = [&](const unsigned int facet) {
      const TouchedFacet touched{facet, project(facet, limits_.seam_tolerance, {})};
      if (!touched.projection.exists)
        return;
      ++n_near;
      is_behind_all = is_behind_all && penetration_of(touched) > 0. && is_held(touched) && faces(touched);
      if (touched.projection.excess < nearest.projection.excess)
        nearest = touched;
    };
    add(last.facet);
    search_.visit_ring(last.facet, add);
    if (n_near > 1 && is_behind_all) {
      best_ = nearest;
      best_.offset = std::min(last.offset, penetration_of(nearest));
    }
  }

private:
  FacetProjection project(const unsigned int facet, const double tolerance,
                          const std::array<double, 2> &start) const {
    return facets_.project<Facet>(facet, x_, make_limits(tolerance, limits_), start);
  }

  /// Projects the node. Returns the facet if the node is behind it and within the zone in which
  /// facets may share it, and otherwise none.
  TouchedFacet project_onto(const unsigned int facet, const std::array<double, 2> &start) const {
    const double tolerance = std::max(limits_.tolerance, limits_.zone);
    const PlanedFacet &plane = facets_.plane(facet);
    const double raised_by = gap_offset_.now + facet::max_height(search_.facets()[facet].bulge);
    if (plane.is_before(x_ - raised_by * plane.normal(), tolerance) || plane.is_aside(x_, tolerance))
      return {};
    const TouchedFacet touched{facet, project(facet, tolerance, start)};
    return touched.projection.exists && penetration_of(touched) > 0. ? touched : TouchedFacet();
  }

  double penetration_of(const TouchedFacet &touched) const {
    return gap_offset_.now - touched.projection.gap;
  }

  const Tensor<1, 3> &normal() {
    if (!normal_)
      normal_ = compute_node_normal(facets_, node_);
    return *normal_;
  }

  bool faces(const TouchedFacet &touched) {
    return limits_.max_alignment >= 1. || normal() * touched.projection.normal < limits_.max_alignment;
  }

  bool is_held(const TouchedFacet &touched) const {
    return touched.projection.gap >= -limits_.held_penetration * search_.facets()[touched.facet].reach;
  }

  /// Whether the node was in front of the facet at the start of the step, or slightly behind it,
  /// which sets the offset. The facet's plane suffices for this. A node that is now outside the
  /// body but was behind the facet was under the body's end, beside this facet, and is leaving.
  bool has_come_through(TouchedFacet &touched) const {
    const SurfaceFacet &target = search_.facets()[touched.facet];
    const PlanedFacet plane(corners_of(target, positions_n_));
    const double penetration = gap_offset_.at_start - raised(plane.project(x_n_, {}), target).gap;
    if (has_pressed_ || penetration <= in_line * plane.radius())
      return true;
    touched.offset = penetration_of(touched);
    return penetration <= target.reach && !is_out(touched);
  }

  /// Calls visit(projection, whether it meets smoothly) for the facets around the corner nearest to
  /// a node beyond the edge of one of them.
  template <class Visit> void visit_beside(const TouchedFacet &touched, const Visit &visit) const {
    search_.visit_around(
        search_.nearest_corner(touched.facet, touched.projection.parameters), [&](const unsigned int facet) {
          const FacetProjection p =
              facet == touched.facet ? FacetProjection() : project(facet, limits_.tolerance, {});
          if (p.exists)
            visit(p, meet_smoothly(touched.projection.normal, p.normal));
        });
  }

  /// Whether the node is in front of a facet around the nearest corner that bounds the body there,
  /// as beside a block. Its edges do not matter: a corner bulges, so that the block's top is then
  /// above the edge of its end.
  bool is_out(const TouchedFacet &touched) const {
    bool is_out = false;
    visit_beside(touched, [&](const FacetProjection &p, const bool is_smooth) {
      is_out = is_out || (!is_smooth && p.gap >= 0.);
    });
    return is_out;
  }

  /// Whether a node beyond the facet's edge is on the facet's side: within the tolerance, it must
  /// not be outside the body. Farther out, a smooth neighbour must share it.
  bool is_on_its_own_side(const TouchedFacet &touched) const {
    const double excess = touched.projection.excess;
    if (excess <= std::min(in_line, limits_.tolerance))
      return true;
    bool is_near = excess <= limits_.tolerance, is_out = false;
    visit_beside(touched, [&](const FacetProjection &p, const bool is_smooth) {
      is_near = is_near || is_smooth;
      is_out = is_out || (!is_smooth && p.gap >= 0.);
    });
    return is_near && !is_out;
  }

  /// Whether the middle of neither facet lies behind the other facet.
  bool is_concave(const TouchedFacet &a, const TouchedFacet &b) const {
    const Tensor<1, 3> from_a_to_b = facets_.plane(b.facet).centre() - facets_.plane(a.facet).centre();
    return from_a_to_b * a.projection.normal >= 0. && from_a_to_b * b.projection.normal <= 0.;
  }

  bool is_deeper_beside(const TouchedFacet &a, const TouchedFacet &b) const {
    return a.projection.gap < b.projection.gap && is_concave(b, a);
  }

  void take_better(const TouchedFacet &other) {
    const double deeper = best_.projection.gap - other.projection.gap;
    if (!best_.exists() || (is_concave(best_, other) ? deeper > 0. : deeper < 0.))
      best_ = other;
  }

  const MovedFacets &facets_;
  const FacetSearch &search_;
  const FacetSearch::Positions &positions_n_;
  const ContactLimits &limits_;
  const unsigned int node_;
  const Tensor<1, 3> x_n_, x_;
  const GapOffset gap_offset_;
  const bool has_pressed_;
  std::optional<Tensor<1, 3>> normal_; ///< of the node, computed on first use
  TouchedFacet best_;
};

} // namespace

template <class Facet>
TouchedFacet choose_facet(const MovedFacets &facets, const std::size_t slave,
                          const FacetSearch::Positions &positions_n, const TouchedFacet &last,
                          const ContactLimits &limits, const GapOffset &gap_offset, const bool has_pressed) {
  const FacetSearch &search = facets.search();
  Choice<Facet> choice(facets, search.slaves()[slave].node, positions_n, limits, gap_offset,
                       has_pressed && !last.exists());
  if (last.exists()) {
    choice.consider_held(last);
    if (!choice.best().exists())
      search.visit_ring(last.facet, [&](const unsigned int facet) { choice.consider_around(last, facet); });
    if (!choice.best().exists())
      choice.consider_seam(last);
  }
  if (choice.best().exists())
    search.visit_candidates(slave, [&](const unsigned int facet) { choice.consider_beside_held(facet); });
  else
    search.visit_candidates(slave, [&](const unsigned int facet) { choice.consider_new(facet); });
  return choice.best();
}

template <class Facet>
TouchedFacet keep_facet(const MovedFacets &facets, const std::size_t slave,
                        const FacetSearch::Positions &positions_n, const TouchedFacet &now,
                        const ContactLimits &limits, const GapOffset &gap_offset) {
  Choice<Facet> choice(facets, facets.search().slaves()[slave].node, positions_n, limits, gap_offset);
  choice.consider_held(now);
  return choice.best();
}

TouchedFacet find_facet_below(const MovedFacets &facets, const std::size_t slave,
                              const ContactLimits &limits) {
  const Tensor<1, 3> &x = facets.position(facets.search().slaves()[slave].node);
  TouchedFacet nearest;
  facets.search().visit_candidates(slave, [&](const unsigned int facet) {
    const FacetProjection p = raised(facets.plane(facet).project(x, make_limits(limits.tolerance, limits)),
                                     facets.search().facets()[facet]);
    if (p.exists && p.gap >= 0. && p.gap < facets.search().facets()[facet].reach &&
        (!nearest.exists() || p.gap < nearest.projection.gap))
      nearest = {facet, p};
  });
  return nearest;
}

Tensor<1, 3> compute_node_normal(const MovedFacets &facets, const unsigned int node) {
  Tensor<1, 3> sum;
  double n_facets = 0.;
  facets.search().visit_around(node, [&](const unsigned int facet) {
    sum += facets.plane(facet).normal();
    n_facets += 1.;
  });
  constexpr double rounding = 1e-10; // of normals that cancel
  const double length = sum.norm();
  return length > rounding * n_facets ? sum / length : Tensor<1, 3>();
}

#define BILLET_INSTANTIATE(Facet)                                                                            \
  template TouchedFacet choose_facet<Facet>(const MovedFacets &, std::size_t,                                \
                                            const FacetSearch::Positions &, const TouchedFacet &,            \
                                            const ContactLimits &, const GapOffset &, bool);                 \
  template TouchedFacet keep_facet<Facet>(const MovedFacets &, std::size_t, const FacetSearch::Positions &,  \
                                          const TouchedFacet &, const ContactLimits &, const GapOffset &);
BILLET_INSTANTIATE(PlanedFacet)
BILLET_INSTANTIATE(MeanGapFacet)
BILLET_INSTANTIATE(BilinearFacet)
#undef BILLET_INSTANTIATE

} // namespace billet
