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

/// By how much the scalar product of the normals of node and facet has to be less for another facet to
/// replace the last one.
constexpr double far_better = 0.5;

/// A node that is less beyond the border than this is in line with it, as where the ends of two bodies lie in
/// one plane: round-off must not tell whether it is beside the body.
constexpr double in_line = 1e-3;

Tensor<1, 3> middle_of(const FacetCorners &corners) {
  return 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
}

/// A point and the mean plane of a facet: what is quicker to tell than a projection.
class MeanPlane {
public:
  MeanPlane(const FacetCorners &x, const Tensor<1, 3> &point)
      : corners_(x), middle_(middle_of(x)), arm_(point - middle_),
        normal_(dealii::cross_product_3d(x[3] - x[0], x[2] - x[1])), height_(arm_ * normal_) {}

  /// The whole facet, and its surface continued by `tolerance` beyond the border, is behind the point.
  bool is_before(const double tolerance) const {
    const double warp = 0.25 * std::abs((corners_[0] + corners_[3] - corners_[1] - corners_[2]) * normal_);
    return height_ > warp * (1. + 2. * tolerance) * (1. + 2. * tolerance);
  }
  /// Neither above nor below the facet nor within `tolerance` of its border, wherever its normals point.
  bool is_aside(const double tolerance) const {
    const double square = normal_.norm_square();
    if (!(square > 0.))
      return true;
    double farthest = 0.; // corner, from the middle, squared
    for (const auto &corner : corners_)
      farthest = std::max(farthest, (corner - middle_).norm_square());
    const double largest =
        (1. + 4. * tolerance) * std::sqrt(farthest) + std::abs(height_) / std::sqrt(square);
    return arm_.norm_square() - height_ * height_ / square > largest * largest;
  }

private:
  const FacetCorners &corners_;
  Tensor<1, 3> middle_, arm_, normal_; ///< arm from the middle; the normal of any length, 0 without area
  double height_;                      ///< of the point, times the length of the normal
};

/// The choice for one node. Each consider_ adds a facet to what is chosen from.
template <class Facet> class Choice {
public:
  Choice(const FacetSearch &search, const unsigned int node, const FacetSearch::Positions &positions_n,
         const FacetSearch::Positions &positions, const ContactLimits &limits)
      : search_(search), positions_n_(positions_n), positions_(positions), limits_(limits), node_(node),
        x_n_(positions_n[node]), x_(positions[node]) {}

  const TouchedFacet &best() const { return best_; }

  /// One around the last one: where they do not meet smoothly, as at the edge of an end, the node may be far
  /// behind one of them and never have come through it.
  void consider_around(const TouchedFacet &last, const unsigned int facet) {
    const TouchedFacet touched = look_at(facet, {});
    if (touched.exists() && is_held(touched) &&
        (meet_smoothly(last.projection.normal, touched.projection.normal) || has_come_through(facet)) &&
        faces(touched) && is_on_its_own_side(touched))
      take_better(touched);
  }

  /// The one that the node touches.
  void consider_held(const unsigned int facet, const std::array<double, 2> &start) {
    const TouchedFacet touched = look_at(facet, start);
    if (touched.exists() && is_held(touched) && faces(touched) && is_on_its_own_side(touched))
      take_better(touched);
  }

  /// One that the node may have come through.
  void consider_new(const unsigned int facet) {
    const TouchedFacet touched = look_at(facet, {});
    if (touched.exists() && has_come_through(facet) && faces(touched) && is_on_its_own_side(touched))
      take_better(touched);
  }

  /// Only where it meets the one that is held in a concave edge, or faces the node far better.
  void consider_beside_held(const unsigned int facet) {
    if (facet == best_.facet)
      return;
    TouchedFacet held;
    std::swap(held, best_);
    consider_new(facet);
    if (!best_.exists() || !(is_deeper_beside(best_, held) ||
                             (held.projection.normal - best_.projection.normal) * normal() > far_better))
      best_ = held;
  }

  /// The seam of facets around the last one, all of which the node is behind.
  void consider_seam(const unsigned int last) {
    TouchedFacet nearest;
    nearest.projection.excess = limits_.seam_tolerance;
    unsigned int n_near = 0;
    bool is_behind_all = true;
    const auto add = [&](const unsigned int facet) {
      const TouchedFacet touched{facet, project(facet, limits_.seam_tolerance, {})};
      if (!touched.projection.exists)
        return;
      ++n_near;
      is_behind_all = is_behind_all && touched.projection.gap < 0. && is_held(touched) && faces(touched);
      if (touched.projection.excess < nearest.projection.excess)
        nearest = touched;
    };
    add(last);
    search_.visit_ring(last, add);
    if (n_near > 1 && is_behind_all)
      best_ = nearest;
  }

private:
  FacetProjection project(const unsigned int facet, const double tolerance,
                          const std::array<double, 2> &start) const {
    return Facet(corners_of(search_.facets()[facet], positions_))
        .project(x_, make_limits(tolerance, limits_), start);
  }

  /// The facet, if the node is behind it, and not farther beyond its border than where it may be shared.
  TouchedFacet look_at(const unsigned int facet, const std::array<double, 2> &start) const {
    const double tolerance = std::max(limits_.tolerance, limits_.zone);
    const FacetCorners corners = corners_of(search_.facets()[facet], positions_);
    const MeanPlane plane(corners, x_);
    if (plane.is_before(tolerance) || plane.is_aside(tolerance))
      return {};
    const TouchedFacet touched{facet, project(facet, tolerance, start)};
    return touched.projection.exists && touched.projection.gap < 0. ? touched : TouchedFacet();
  }

  const Tensor<1, 3> &normal() {
    if (!normal_)
      normal_ = compute_node_normal(search_, node_, positions_);
    return *normal_;
  }

  bool faces(const TouchedFacet &touched) {
    return limits_.largest_alignment >= 1. ||
           normal() * touched.projection.normal < limits_.largest_alignment;
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
  /// this one, as beside a block. Farther out it must be one that a smooth neighbour shares.
  bool is_on_its_own_side(const TouchedFacet &touched) const {
    const FacetProjection &own = touched.projection;
    if (!(own.excess > 0.))
      return true;
    bool is_near = own.excess <= limits_.tolerance, is_out = false;
    search_.visit_around(
        search_.nearest_corner(touched.facet, own.parameters), [&](const unsigned int facet) {
          const FacetProjection p =
              facet == touched.facet ? FacetProjection() : project(facet, limits_.tolerance, {});
          if (!p.exists)
            return;
          if (meet_smoothly(own.normal, p.normal))
            is_near = true;
          else
            is_out = is_out || (p.gap >= 0. && own.excess > in_line);
        });
    return is_near && !is_out;
  }

  /// The middle of neither lies behind the other.
  bool is_concave(const TouchedFacet &a, const TouchedFacet &b) const {
    const Tensor<1, 3> from_a_to_b = middle_of(corners_of(search_.facets()[b.facet], positions_)) -
                                     middle_of(corners_of(search_.facets()[a.facet], positions_));
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

  const FacetSearch &search_;
  const FacetSearch::Positions &positions_n_, &positions_;
  const ContactLimits &limits_;
  const unsigned int node_;
  const Tensor<1, 3> x_n_, x_;
  std::optional<Tensor<1, 3>> normal_; ///< of the node, once it has been asked for
  TouchedFacet best_;
};

} // namespace

template <class Facet>
TouchedFacet choose_facet(const FacetSearch &search, const std::size_t slave,
                          const FacetSearch::Positions &positions_n, const FacetSearch::Positions &positions,
                          const TouchedFacet &last, const ContactLimits &limits) {
  Choice<Facet> choice(search, search.slaves()[slave].node, positions_n, positions, limits);
  if (last.exists()) {
    choice.consider_held(last.facet, last.projection.parameters);
    if (!choice.best().exists())
      search.visit_ring(last.facet, [&](const unsigned int facet) { choice.consider_around(last, facet); });
    if (!choice.best().exists())
      choice.consider_seam(last.facet);
  }
  if (choice.best().exists())
    search.visit_candidates(slave, [&](const unsigned int facet) { choice.consider_beside_held(facet); });
  else
    search.visit_candidates(slave, [&](const unsigned int facet) { choice.consider_new(facet); });
  return choice.best();
}

TouchedFacet find_facet_below(const FacetSearch &search, const std::size_t slave,
                              const FacetSearch::Positions &positions, const ContactLimits &limits) {
  const unsigned int node = search.slaves()[slave].node;
  TouchedFacet nearest;
  search.visit_candidates(slave, [&](const unsigned int facet) {
    const FacetCorners corners = corners_of(search.facets()[facet], positions);
    if (MeanPlane(corners, positions[node]).is_aside(limits.tolerance))
      return;
    const FacetProjection p =
        PlanedFacet(corners).project(positions[node], make_limits(limits.tolerance, limits));
    if (p.exists && p.gap >= 0. && (!nearest.exists() || p.gap < nearest.projection.gap))
      nearest = {facet, p};
  });
  return nearest;
}

Tensor<1, 3> compute_node_normal(const FacetSearch &search, const unsigned int node,
                                 const FacetSearch::Positions &positions) {
  Tensor<1, 3> sum;
  double n_facets = 0.;
  search.visit_around(node, [&](const unsigned int facet) {
    const FacetCorners x = corners_of(search.facets()[facet], positions);
    const Tensor<1, 3> area_vector = dealii::cross_product_3d(x[3] - x[0], x[2] - x[1]);
    const double area = area_vector.norm();
    if (area > 0.) {
      sum += area_vector / area;
      n_facets += 1.;
    }
  });
  constexpr double rounding = 1e-10; // of normals that cancel
  const double length = sum.norm();
  return length > rounding * n_facets ? sum / length : Tensor<1, 3>();
}

#define BILLET_INSTANTIATE(Facet)                                                                            \
  template TouchedFacet choose_facet<Facet>(const FacetSearch &, std::size_t,                                \
                                            const FacetSearch::Positions &, const FacetSearch::Positions &,  \
                                            const TouchedFacet &, const ContactLimits &);
BILLET_INSTANTIATE(PlanedFacet)
BILLET_INSTANTIATE(BilinearFacet)
#undef BILLET_INSTANTIATE

} // namespace billet
