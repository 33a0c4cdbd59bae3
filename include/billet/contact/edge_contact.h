// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_EDGE_CONTACT_H
#define BILLET_CONTACT_EDGE_CONTACT_H

#include "billet/contact/facet_search.h"

#include <vector>

namespace billet {

/// Finds edges that cross edges: what nodes against facets cannot see, such as two cubes, turned by 45
/// degrees, that meet with an edge each; or the ridges of two folds that cross. Only edges in which facets
/// meet at an outward angle, and borders.
class EdgeContact {
public:
  using Positions = FacetSearch::Positions;

  /// Two crossing edges, the first of which is the slave.
  struct Crossing {
    std::array<unsigned int, 4> nodes; ///< ends of the first edge, then of the second
    /// The points that are nearest to each other are Σ w_I x_I of the first two and of the last two nodes.
    /// The difference is along the normal, so that equal and opposite forces along it balance, and their
    /// moments.
    std::array<double, 4> weights;
    dealii::Tensor<1, 3> normal; ///< unit, out of the second edge's body, across both edges
    double gap;                  ///< [length]
    /// A quarter of the product of both lengths, the share of a facet's corner between such sides; less near
    /// the ends of the edges, and 0 there [length²]
    double area;
    std::array<unsigned int, 2> surfaces;
  };

  /// Edges count where the scalar product of their facets' normals is below `largest_alignment`.
  EdgeContact(FacetSearch::Partners partners, double largest_alignment);

  /// Makes lists of the pairs that may come to cross before positions move by more than `margin` relative to
  /// each other, deeper than −`depth` times the least reach of their facets. Each pair is listed once over
  /// all ranks: where the facet is owned (among the first `n_own_facets`) that names the slave edge.
  void rebuild(const std::vector<SurfaceFacet> &facets, std::size_t n_own_facets, const Positions &positions,
               double margin, double depth);

  /// The pairs that cross at these positions, with gaps < 0.
  std::vector<Crossing> find_crossings(const Positions &positions) const;

  std::size_t n_pairs() const { return pairs_.size(); }

private:
  static constexpr unsigned int none = static_cast<unsigned int>(-1);
  struct Edge {
    std::array<unsigned int, 2> nodes;
    std::array<unsigned int, 2> facets; ///< that with the lower key first; none at a border
    double reach;
  };
  std::vector<Edge> find_outward_edges(const Positions &positions) const;
  /// A unit vector lies between the normals of the edge's facets, or not far beside them.
  bool is_between_normals(const Edge &edge, const dealii::Tensor<1, 3> &normal,
                          const Positions &positions) const;
  bool may_touch(const Edge &slave, const Edge &target) const;

  FacetSearch::Partners partners_;
  double largest_alignment_, depth_ = 0.;
  std::vector<SurfaceFacet> facets_;
  std::vector<Edge> edges_;
  std::vector<std::array<std::size_t, 2>> pairs_; ///< slave and target
};

} // namespace billet

#endif
