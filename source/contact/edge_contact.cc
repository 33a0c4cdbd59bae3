// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/edge_contact.h"

#include "billet/contact/facet_choice.h"
#include "billet/contact/key_numbers.h"
#include "billet/geometry/box_tree.h"
#include "billet/geometry/segment_pair.h"

#include <algorithm>
#include <cmath>

namespace billet {

using dealii::Tensor;

namespace {

Tensor<1, 3> unit_normal(const facet::Expansion &surface) {
  const Tensor<1, 3> area_vector = surface.mean_area_vector();
  const double size = area_vector.norm();
  return size > 0. ? area_vector / size : Tensor<1, 3>();
}

/// Returns the factor by which an edge's share fades towards its ends, and its derivative with
/// respect to the parameter. The ends are nodes, which facets detect. The factor is smooth and
/// extends over each half of the edge, since steps must resolve it.
std::array<double, 2> fade(const double parameter) {
  const double z = 2. * std::min(parameter, 1. - parameter);
  return {z * z * (3. - 2. * z), 12. * z * (1. - z) * (parameter < 0.5 ? 1. : -1.)};
}

/// Whether edges meet at their ends, as those of flush faces do. Their area is 0, and round-off
/// decides whether they cross.
bool meets_at_end(const SegmentPair &pair) {
  constexpr double rounding = 1e-6;
  return std::any_of(pair.parameters.begin(), pair.parameters.end(),
                     [](const double s) { return std::min(s, 1. - s) < rounding; });
}

/// Sets the area and its gradients. With a, b the edges and d the difference, d·a = d·b = 0 at any
/// positions. Motions of nodes add δr to d at fixed s and t, and δa, δb to the edges; therefore
///   a² δs − a·b δt = −(a·δr + d·δa),   a·b δs − b² δt = −(b·δr + d·δb).
void set_area(const Tensor<1, 3> &a, const Tensor<1, 3> &b, EdgeContact::Crossing &crossing) {
  const double aa = a * a, bb = b * b, ab = a * b, determinant = aa * bb - ab * ab;
  const Tensor<1, 3> d = crossing.gap * crossing.normal;
  const auto [f, f_s] = fade(crossing.weights[1]);
  const auto [h, h_t] = fade(crossing.weights[3]);
  crossing.full_area = 0.25 * std::sqrt(aa * bb);
  crossing.area = crossing.full_area * f * h;
  const double A_s = crossing.full_area * f_s * h / determinant,
               A_t = crossing.full_area * f * h_t / determinant;
  const Tensor<1, 3> by_difference = A_s * (ab * b - bb * a) + A_t * (aa * b - ab * a),
                     by_a = -(A_s * bb + A_t * ab) * d + crossing.area / aa * a,
                     by_b = (A_s * ab + A_t * aa) * d + crossing.area / bb * b;
  const auto &w = crossing.weights;
  crossing.area_gradients = {w[0] * by_difference - by_a, w[1] * by_difference + by_a,
                             -w[2] * by_difference - by_b, -w[3] * by_difference + by_b};
}

} // namespace

std::array<Tensor<1, 3>, 4> EdgeContact::Crossing::forces(const double stiffness) const {
  std::array<Tensor<1, 3>, 4> forces;
  for (unsigned int i = 0; i < 4; ++i)
    forces[i] =
        -stiffness * counted_gap() *
        ((i < 2 ? weights[i] : -weights[i]) * area * normal + 0.5 * counted_gap() * area_gradients[i]);
  return forces;
}

EdgeContact::EdgeContact(const FacetSearch::Partners partners, const double max_alignment)
    : partners_(partners), max_alignment_(max_alignment) {}

void EdgeContact::connect(const std::vector<SurfaceFacet> &facets) {
  const auto is_same = [](const SurfaceFacet &a, const SurfaceFacet &b) {
    return a.key == b.key && a.nodes == b.nodes && a.surface == b.surface && a.reach == b.reach;
  };
  if (!facets_.empty() && std::equal(facets.begin(), facets.end(), facets_.begin(), facets_.end(), is_same))
    return;
  facets_ = facets;
  std::map<std::array<unsigned int, 2>, Edge> edges;
  for (unsigned int f = 0; f < facets_.size(); ++f)
    for (unsigned int i = 0; i < 4; ++i) {
      const unsigned int a = facets_[f].nodes[facet::around[i]],
                         b = facets_[f].nodes[facet::around[(i + 1) % 4]];
      if (a == b)
        continue;
      const auto found = edges.emplace(std::array<unsigned int, 2>{std::min(a, b), std::max(a, b)},
                                       Edge{{a, b}, {f, none}, facets_[f].reach, {facets_[f].key, i}});
      if (found.second)
        continue;
      Edge &edge = found.first->second;
      edge.facets[1] = f;
      if (facets_[f].key < facets_[edge.facets[0]].key) {
        std::swap(edge.facets[0], edge.facets[1]);
        edge.nodes = {a, b}; // from the same facet on all ranks, for equal results
        edge.id = {facets_[f].key, i};
      }
      edge.reach = std::min(edge.reach, facets_[f].reach);
    }
  all_edges_.clear();
  for (const auto &entry : edges)
    all_edges_.push_back(entry.second);
}

std::vector<EdgeContact::Edge> EdgeContact::find_outward_edges(const Positions &positions) const {
  struct Plane {
    Tensor<1, 3> normal, centre;
  };
  std::vector<Plane> planes;
  planes.reserve(facets_.size());
  for (const auto &surface_facet : facets_) {
    const facet::Expansion x = corners_of(surface_facet, positions);
    planes.push_back({unit_normal(x), x.e_0});
  }
  std::vector<Edge> outward_edges;
  for (const auto &edge : all_edges_) {
    if (edge.facets[1] != none) {
      const Plane &x = planes[edge.facets[0]], &y = planes[edge.facets[1]];
      if (x.normal * y.normal >= max_alignment_ || (y.centre - x.centre) * x.normal > 0.)
        continue;
    }
    outward_edges.push_back(edge);
  }
  return outward_edges;
}

bool EdgeContact::is_between_normals(const Edge &edge, const Tensor<1, 3> &normal,
                                     const Positions &positions) const {
  // Tolerance of the normal outside the angle between theirs [radians].
  constexpr double beside = 0.35;
  Tensor<1, 3> middle = unit_normal(corners_of(facets_[edge.facets[0]], positions));
  if (edge.facets[1] != none)
    middle = 0.5 * (middle + unit_normal(corners_of(facets_[edge.facets[1]], positions)));
  const double cosine = middle.norm(); // of half that angle
  return normal * middle > cosine * std::cos(std::min(std::acos(std::min(cosine, 1.)) + beside, M_PI_2));
}

bool EdgeContact::may_touch(const Edge &slave, const Edge &target) const {
  const SurfaceFacet &a = facets_[slave.facets[0]], &b = facets_[target.facets[0]];
  if (a.surface != b.surface)
    return a.surface < b.surface;
  // Edges with a common facet are too close to touch.
  if (partners_ == FacetSearch::Partners::other_surfaces || a.key >= b.key)
    return false;
  for (const unsigned int i : slave.facets)
    for (const unsigned int j : target.facets)
      if (i != none && j != none)
        for (const unsigned int node : facets_[i].nodes)
          if (std::find(facets_[j].nodes.begin(), facets_[j].nodes.end(), node) != facets_[j].nodes.end())
            return false;
  return true;
}

void EdgeContact::rebuild(const std::vector<SurfaceFacet> &facets, const std::size_t n_own_facets,
                          const Positions &positions, const double margin, const double penetration) {
  connect(facets);
  penetration_ = penetration;
  edges_ = find_outward_edges(positions);
  std::vector<BoundingBox> boxes;
  for (const auto &edge : edges_) {
    boxes.push_back(BoundingBox::empty());
    for (const unsigned int node : edge.nodes)
      boxes.back().add(positions[node]);
    boxes.back().enlarge(penetration * edge.reach + margin);
  }
  const BoxTree tree(boxes);
  pairs_.clear();
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const Edge &edge = edges_[e];
    if (edge.facets[0] >= n_own_facets)
      continue;
    const Tensor<1, 3> &x = positions[edge.nodes[0]], &y = positions[edge.nodes[1]];
    tree.visit_near(0.5 * (x + y), 0.25 * (y - x).norm_square(), [&](const unsigned int target) {
      if (boxes[target].overlaps(boxes[e]) && may_touch(edge, edges_[target]))
        pairs_.push_back({e, target});
    });
  }
}

std::vector<EdgeContact::Crossing> EdgeContact::find_crossings(const Positions &positions_n,
                                                               const Positions &positions,
                                                               const bool with_offsets) {
  std::vector<Crossing> crossings;
  offsets_.clear();
  for (const auto &pair : pairs_) {
    const Edge &slave = edges_[pair[0]], &target = edges_[pair[1]];
    const Segment first{positions[slave.nodes[0]], positions[slave.nodes[1]]},
        second{positions[target.nodes[0]], positions[target.nodes[1]]};
    const SegmentPair closest = closest_points(first, second);
    if (!closest.is_crossing || meets_at_end(closest))
      continue;
    const Tensor<1, 3> along_1 = first[1] - first[0], along_2 = second[1] - second[0];
    // Nearly parallel edges have no well-defined common normal; node-to-facet contact covers them.
    constexpr double min_sine = 0.1;
    Tensor<1, 3> normal = dealii::cross_product_3d(along_1, along_2);
    const double sine = normal.norm() / (along_1.norm() * along_2.norm());
    if (sine < min_sine)
      continue;
    normal /= normal.norm();
    if (!is_between_normals(target, normal, positions))
      normal *= -1.;
    const double gap = closest.difference * normal, reach = std::min(slave.reach, target.reach);
    if (!(gap < reach) || gap < -penetration_ * reach || !is_between_normals(target, normal, positions) ||
        !is_between_normals(slave, -normal, positions))
      continue;
    const double s = closest.parameters[0], t = closest.parameters[1];
    Crossing crossing{{slave.nodes[0], slave.nodes[1], target.nodes[0], target.nodes[1]},
                      {1. - s, s, 1. - t, t},
                      normal,
                      gap,
                      0.,
                      0.,
                      0.,
                      {},
                      {facets_[slave.facets[0]].surface, facets_[target.facets[0]].surface}};
    set_area(along_1, along_2, crossing);
    const PairId id{slave.id, target.id};
    if (gap < 0. && with_offsets) {
      const auto found = offsets_n_.find(id);
      if (found != offsets_n_.end())
        crossing.offset = std::min(found->second, -gap);
      else {
        const SegmentPair before =
            closest_points({positions_n[slave.nodes[0]], positions_n[slave.nodes[1]]},
                           {positions_n[target.nodes[0]], positions_n[target.nodes[1]]});
        if (!(before.difference * normal > 0.))
          crossing.offset = -gap * (before.is_crossing ? 1. : crossing.area / crossing.full_area);
      }
    }
    offsets_.emplace(id, crossing.offset);
    crossings.push_back(crossing);
  }
  return crossings;
}

std::vector<double> EdgeContact::offsets() const {
  std::vector<double> numbers;
  RowWriter row(numbers);
  for (const auto &[pair, offset] : offsets_n_) {
    for (const auto &[key, side] : pair) {
      write_key(row, key);
      row.number(static_cast<double>(side));
    }
    row.number(offset);
  }
  return numbers;
}

void EdgeContact::add_offsets(const std::vector<double> &numbers) {
  RowReader row(numbers);
  while (!row.is_at_end()) {
    PairId pair{};
    for (auto &[key, side] : pair) {
      key = read_key(row);
      side = to_count(row.number());
    }
    offsets_n_[pair] = row.number();
  }
}

} // namespace billet
