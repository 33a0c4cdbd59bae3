// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/slave_tangents.h"

#include "billet/contact/facet_areas.h"
#include "billet/contact/facet_reaction.h"
#include "billet/contact/node_list.h"
#include "billet/geometry/bilinear_facet.h"
#include "billet/geometry/derivative.h"
#include "billet/geometry/planed_facet.h"

#include <limits>
#include <type_traits>

namespace billet {

using dealii::FullMatrix;
using dealii::Tensor;

namespace {

/// Computes an overlap with derivatives with respect to the variables of its corners: each corner's
/// coordinates are variables.
template <class Number>
FacetOverlapOf<Number> follow_overlap(const FacetCornersOf<Number> &slave,
                                      const FacetCornersOf<Number> &target, const double penetration,
                                      const std::array<double, 4> &gap_offsets,
                                      const std::array<double, 4> &augmentation,
                                      const FacetBulge &slave_bulge, const FacetBulge &target_bulge) {
  if constexpr (std::is_same_v<Number, double>)
    return compute_overlap(slave, target, penetration, gap_offsets, augmentation, slave_bulge, target_bulge);
  else {
    // Derivatives with respect to the 24 coordinates of this pair, then the chain rule: a slave
    // depends on many more.
    constexpr int n = 24;
    FacetCornersOf<Derivative> s, t;
    for (unsigned int a = 0; a < 4; ++a)
      for (unsigned int i = 0; i < 3; ++i) {
        s[a][i] = Derivative(n, static_cast<int>(3 * a + i), slave[a][i].val());
        t[a][i] = Derivative(n, static_cast<int>(12 + 3 * a + i), target[a][i].val());
      }
    FacetOverlapOf<Derivative> overlap =
        compute_overlap(s, t, penetration, gap_offsets, augmentation, slave_bulge, target_bulge);
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
      chain(overlap.penetrations[a]);
      for (unsigned int b = 0; b < 4; ++b) {
        chain(overlap.slave_parts[a][b]);
        chain(overlap.target_parts[a][b]);
      }
    }
    return overlap;
  }
}

/// Computes the projection `found` as a function of the corners and the node x.
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

/// Tangents of slaves on facets of type Facet, with the friction law Law or Frictionless.
template <class Facet, class Law> class SlaveTangentsOf final : public SlaveTangents {
public:
  explicit SlaveTangentsOf(const FacetContactParts &parts) : parts_(parts), touching_(parts.touching) {}

  void visit(const ContactTangent kind, const Add &add) const override {
    switch (form_of(kind)) {
    case TangentForm::numerical:
      visit_slaves([&](const std::size_t s) { add_numerical_tangent(s, add); });
      break;
    case TangentForm::exact:
      visit_slaves([&](const std::size_t s) { add_exact_tangent(s, add); });
      break;
    case TangentForm::closed:
      const FrictionTangent friction = FrictionTangent::of(kind);
      visit_slaves([&](const std::size_t s) { add_closed_tangent(friction, s, add); });
    }
  }

private:
  static constexpr bool are_overlaps = std::is_same_v<Facet, OverlapFacet>;

  /// Nodes on which a slave depends, and their positions.
  template <class Number> struct Placed {
    const std::vector<unsigned int> &nodes;
    const std::vector<Tensor<1, 3, Number>> &x;

    FacetCornersOf<Number> corners(const SurfaceFacet &facet) const {
      FacetCornersOf<Number> corners;
      for (unsigned int a = 0; a < 4; ++a)
        corners[a] = x[index_of(nodes, facet.nodes[a])];
      return corners;
    }
  };
  /// Shares and contact of a slave at these positions.
  template <class Number> struct Touched {
    std::vector<FacetShareOf<Number>> shares;
    std::vector<Tensor<1, 3, Number>> points; ///< as in TouchingSlaves::point_of()
    SharedGapOf<Number> contact;
  };

  const SurfaceFacet &facet(const unsigned int f) const { return parts_.surfaces.facet(f); }
  template <class Visit> void visit_slaves(const Visit &visit) const {
    for (std::size_t s = 0; s < touching_.size(); ++s)
      if (touching_[s].presses() && touching_[s].own_area > 0.)
        visit(s);
  }
  /// Returns the nodes on whose positions the forces of slave s depend, itself first.
  std::vector<unsigned int> collect_nodes(std::size_t s, bool with_own_facets) const;
  void add_closed_tangent(const FrictionTangent &kind, std::size_t s, const Add &add) const;
  void add_exact_tangent(std::size_t s, const Add &add) const;
  void add_numerical_tangent(std::size_t s, const Add &add) const;

  /// Computes the forces of slave s on these nodes, with the facets and the branches of its state.
  template <class Number>
  std::vector<Tensor<1, 3, Number>> follow_forces(std::size_t s, const Placed<Number> &placed) const;
  template <class Number> Touched<Number> follow_contact(std::size_t s, const Placed<Number> &placed) const;
  template <class Number>
  Tensor<1, 3, Number> follow_traction(std::size_t s, const Placed<Number> &placed,
                                       const Touched<Number> &touched) const;
  template <class Number>
  Number follow_own_area(std::size_t s, const Placed<Number> &placed,
                         const Tensor<1, 3, Number> &normal) const;
  /// Returns the point of a share at the start of the step: the slave node, or a point of its
  /// facet.
  template <class Number>
  Tensor<1, 3, Number> point_n(std::size_t s, const FacetShareOf<Number> &share) const;

  const FacetContactParts &parts_;
  const TouchingSlaves &touching_;
};

template <class Facet, class Law>
std::vector<unsigned int> SlaveTangentsOf<Facet, Law>::collect_nodes(const std::size_t s,
                                                                     const bool with_own_facets) const {
  const SlaveState &state = touching_[s];
  std::vector<unsigned int> nodes{parts_.slaves.node(s)};
  for (std::size_t i = state.first_share; i < state.end_of_shares; ++i) {
    const FacetShare &share = touching_.shares()[i];
    add_once(nodes, facet(share.facet).nodes);
    if constexpr (are_overlaps)
      add_once(nodes, facet(share.slave_facet).nodes);
  }
  if (with_own_facets)
    parts_.surfaces.search().visit_around(parts_.slaves.node(s),
                                          [&](const unsigned int f) { add_once(nodes, facet(f).nodes); });
  return nodes;
}

template <class Facet, class Law>
void SlaveTangentsOf<Facet, Law>::add_closed_tangent([[maybe_unused]] const FrictionTangent &kind,
                                                     const std::size_t s, const Add &add) const {
  const SlaveState &state = touching_[s];
  const Tensor<1, 3> &n = state.contact.normal;
  const Tensor<2, 3> along_normal = parts_.penalties[s].normal * dealii::outer_product(n, n);
  Tensor<2, 3> K = along_normal;
  if constexpr (!std::is_same_v<Law, Frictionless>) {
    SlaveHistory ignored;
    compute_slave_traction(parts_.friction->law(), parts_.penalties[s], n, state.contact.gap,
                           touching_.motion_of(s), parts_.friction->base(s), ignored, kind, &K);
  }
  const std::vector<unsigned int> nodes = collect_nodes(s, false);
  FullMatrix<double> matrix(3 * nodes.size(), 3 * nodes.size());
  // Weights of the nodes in the slave's motion, and in forces of this rank, for all shares and for
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
    const FacetShare &share = touching_.shares()[i];
    own.assign(nodes.size(), 0.);
    if constexpr (!are_overlaps)
      own[0] = 1.;
    for (unsigned int a = 0; a < 4; ++a) {
      if constexpr (are_overlaps)
        own[index_of(nodes, facet(share.slave_facet).nodes[a])] += share.slave_weights[a];
      own[index_of(nodes, facet(share.facet).nodes[a])] -= share.projection.weights[a];
    }
    const double area = touching_.area_of(state, share);
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      weights[a] += share.share * own[a];
      areas[a] += area * own[a];
    }
    if constexpr (are_overlaps)
      if (area > 0.) // A g is the sum of all A_f g_f
        add_product(own, own, share.area, along_normal);
  }
  if constexpr (are_overlaps)
    K -= along_normal;
  add_product(areas, weights, 1., K);
  add(nodes, matrix);
}

template <class Facet, class Law>
template <class Number>
auto SlaveTangentsOf<Facet, Law>::follow_contact(const std::size_t s, const Placed<Number> &placed) const
    -> Touched<Number> {
  const SlaveState &state = touching_[s];
  Touched<Number> touched;
  for (std::size_t i = state.first_share; i < state.end_of_shares; ++i) {
    const FacetShare &share = touching_.shares()[i];
    if constexpr (are_overlaps) {
      const SurfaceFacet &own = facet(share.slave_facet), &target = facet(share.facet);
      const auto corners = placed.corners(own);
      const auto overlap = follow_overlap<Number>(
          corners, placed.corners(target), share.penetration, corners_of(own, parts_.overlaps->gap_offsets()),
          corners_of(own, parts_.overlaps->augmentation()), own.bulge, target.bulge);
      touched.shares.push_back(share_of_overlap(overlap, corner_of(own, parts_.slaves.node(s)),
                                                share.slave_facet, share.facet, share.penetration,
                                                parts_.slaves.penetration_rounding(s)));
      touched.points.push_back(facet::interpolate(touched.shares.back().slave_weights, corners));
    } else {
      const FacetLimits limits = make_limits(std::numeric_limits<double>::infinity(), parts_.settings.limits);
      const SurfaceFacet &target = facet(share.facet);
      const auto projection = raised(
          follow<Facet, Number>(placed.corners(target), placed.x[0], limits, share.projection), target);
      touched.shares.push_back({share.facet, projection.share, projection});
      touched.points.push_back(placed.x[0]);
    }
  }
  if (touched.shares.size() == 1) {
    FacetShareOf<Number> &only = touched.shares[0];
    only.share = 1.;
    touched.contact = {only.projection.normal, only.projection.gap};
  } else
    touched.contact = combine(touched.shares, 0);
  // Overlaps already contain the allowed penetrations.
  touched.contact.gap -=
      are_overlaps ? parts_.offsets.augmentation[s] : parts_.offsets.of(s).now - state.touched.offset;
  return touched;
}

template <class Facet, class Law>
template <class Number>
Tensor<1, 3, Number> SlaveTangentsOf<Facet, Law>::point_n(const std::size_t s,
                                                          const FacetShareOf<Number> &share) const {
  const FacetSearch::Positions &positions_n = parts_.surfaces.positions_n();
  if constexpr (!are_overlaps)
    return positions_n[parts_.slaves.node(s)];
  Tensor<1, 3, Number> point;
  for (unsigned int a = 0; a < 4; ++a)
    point += share.slave_weights[a] * positions_n[facet(share.slave_facet).nodes[a]];
  return point;
}

template <class Facet, class Law>
template <class Number>
Tensor<1, 3, Number> SlaveTangentsOf<Facet, Law>::follow_traction(const std::size_t s,
                                                                  const Placed<Number> &placed,
                                                                  const Touched<Number> &touched) const {
  const SharedGapOf<Number> &contact = touched.contact;
  if constexpr (std::is_same_v<Law, Frictionless>)
    return compute_slave_traction(Frictionless(), parts_.penalties[s].normal, contact.normal, contact.gap)
        .traction;
  else {
    const double duration = touching_.duration();
    SlaveMotionOf<Number> mean{Tensor<1, 3, Number>(), Tensor<2, 3, Number>(), duration,
                               parts_.offsets.augmentation[s], parts_.slaves.flush_gap(s)};
    for (std::size_t i = 0; i < touched.shares.size(); ++i) {
      const FacetShareOf<Number> &share = touched.shares[i];
      const SurfaceFacet &target = facet(share.facet);
      const auto motion = compute_slave_motion<Number>(corners_of(target, parts_.surfaces.positions_n()),
                                                       placed.corners(target), share.projection.weights,
                                                       point_n(s, share), touched.points[i], duration);
      mean.displacement += share.share * motion.displacement;
      mean.rotation += share.share * motion.rotation;
    }
    SlaveHistory ignored;
    return compute_slave_traction(parts_.friction->law(), parts_.penalties[s], contact.normal, contact.gap,
                                  mean, parts_.friction->base(s), ignored)
        .traction;
  }
}

template <class Facet, class Law>
template <class Number>
Number SlaveTangentsOf<Facet, Law>::follow_own_area(const std::size_t s, const Placed<Number> &placed,
                                                    const Tensor<1, 3, Number> &normal) const {
  const unsigned int node = parts_.slaves.node(s);
  Number area = 0.;
  parts_.surfaces.search().visit_around(node, [&](const unsigned int f) {
    if (parts_.surfaces.owns(f))
      area += FacetAreasOf<Number>(placed.corners(facet(f))).share(corner_of(facet(f), node), normal);
  });
  return area;
}

template <class Facet, class Law>
template <class Number>
std::vector<Tensor<1, 3, Number>>
SlaveTangentsOf<Facet, Law>::follow_forces(const std::size_t s, const Placed<Number> &placed) const {
  const Touched<Number> touched = follow_contact(s, placed);
  const Tensor<1, 3, Number> traction = follow_traction(s, placed, touched);
  std::vector<Tensor<1, 3, Number>> forces(placed.nodes.size());
  const auto force_on = [&](const unsigned int node) -> Tensor<1, 3, Number> & {
    return forces[index_of(placed.nodes, node)];
  };
  const auto add_reaction = [&](const FacetShareOf<Number> &share, const Tensor<1, 3, Number> &point,
                                const Tensor<1, 3, Number> &part) {
    const FacetReactionOf<Number> reaction(placed.corners(facet(share.facet)));
    const FacetCornersOf<Number> on_corners = reaction(share.projection.weights, point, part);
    for (unsigned int a = 0; a < 4; ++a)
      force_on(facet(share.facet).nodes[a]) += on_corners[a];
  };
  if constexpr (are_overlaps) {
    const Number area = effective_area(touched.shares, 0);
    for (std::size_t i = 0; i < touched.shares.size(); ++i) {
      const FacetShareOf<Number> &share = touched.shares[i];
      if (!parts_.surfaces.owns(share.slave_facet))
        continue;
      const Tensor<1, 3, Number> part = Number(share.share * area) * traction;
      for (unsigned int a = 0; a < 4; ++a)
        force_on(facet(share.slave_facet).nodes[a]) += share.slave_weights[a] * part;
      add_reaction(share, touched.points[i], part);
    }
  } else {
    const Tensor<1, 3, Number> force = follow_own_area(s, placed, touched.contact.normal) * traction;
    forces[0] = force;
    for (std::size_t i = 0; i < touched.shares.size(); ++i)
      add_reaction(touched.shares[i], touched.points[i],
                   Tensor<1, 3, Number>(touched.shares[i].share * force));
  }
  return forces;
}

template <class Facet, class Law>
void SlaveTangentsOf<Facet, Law>::add_exact_tangent(const std::size_t s, const Add &add) const {
  const std::vector<unsigned int> nodes = collect_nodes(s, true);
  const std::size_t n = 3 * nodes.size();
  if (n > max_variables) { // only at a corner of a dozen facets
    add_numerical_tangent(s, add);
    return;
  }
  std::vector<Tensor<1, 3, Derivative>> x(nodes.size());
  for (std::size_t a = 0; a < nodes.size(); ++a)
    for (unsigned int i = 0; i < 3; ++i)
      x[a][i] = Derivative(static_cast<int>(n), static_cast<int>(3 * a + i),
                           parts_.surfaces.positions()[nodes[a]][i]);
  const auto forces = follow_forces(s, Placed<Derivative>{nodes, x});
  FullMatrix<double> matrix(n, n);
  for (std::size_t a = 0; a < nodes.size(); ++a)
    for (unsigned int i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < n; ++j)
        matrix(3 * a + i, j) = -forces[a][i].dx(static_cast<int>(j));
  add(nodes, matrix);
}

template <class Facet, class Law>
void SlaveTangentsOf<Facet, Law>::add_numerical_tangent(const std::size_t s, const Add &add) const {
  if (touching_[s].rests) { // it sticks once it is pressed, which finite differences do not show
    add_closed_tangent({}, s, add);
    return;
  }
  const FacetSearch::Positions &positions = parts_.surfaces.positions();
  const std::vector<unsigned int> nodes = collect_nodes(s, true);
  std::vector<Tensor<1, 3>> x;
  x.reserve(nodes.size());
  for (const unsigned int node : nodes)
    x.push_back(positions[node]);
  FullMatrix<double> matrix(3 * nodes.size(), 3 * nodes.size());
  const double h = difference_step * parts_.slaves.facet_size(s);
  for (std::size_t b = 0; b < nodes.size(); ++b)
    for (unsigned int j = 0; j < 3; ++j)
      for (const double sign : {1., -1.}) {
        x[b][j] = positions[nodes[b]][j] + sign * h;
        const auto forces = follow_forces(s, Placed<double>{nodes, x});
        for (std::size_t a = 0; a < nodes.size(); ++a)
          for (unsigned int i = 0; i < 3; ++i)
            matrix(3 * a + i, 3 * b + j) -= sign / (2. * h) * forces[a][i];
        x[b][j] = positions[nodes[b]][j];
      }
  add(nodes, matrix);
}

} // namespace

std::unique_ptr<SlaveTangents> make_slave_tangents(const FacetContactParts &parts) {
  std::unique_ptr<SlaveTangents> result;
  choose_friction(parts.settings.friction, [&](const auto &law) {
    visit_method(parts.settings.method, [&](auto facet) {
      using Facet = typename decltype(facet)::type;
      using Law = std::decay_t<decltype(law)>;
      result = std::make_unique<SlaveTangentsOf<Facet, Law>>(parts);
    });
  });
  return result;
}

} // namespace billet
