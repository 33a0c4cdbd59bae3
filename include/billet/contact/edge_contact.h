// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_EDGE_CONTACT_H
#define BILLET_CONTACT_EDGE_CONTACT_H

#include "billet/contact/facet_search.h"

#include <map>
#include <vector>

namespace billet {

/// Edge-to-edge contact, which node-to-facet contact cannot detect. Examples are two cubes, turned
/// by 45 degrees, that meet with one edge each, and two folds with crossing ridges. Only convex
/// edges between facets and free edges count.
class EdgeContact {
public:
  using Positions = FacetSearch::Positions;

  /// Two crossing edges; the first is the slave.
  struct Crossing {
    std::array<unsigned int, 4> nodes; ///< ends of the first edge, then of the second
    /// The closest points are Σ w_I x_I of the first two and of the last two nodes. Their
    /// difference is along the normal, so that equal and opposite forces along it balance, as do
    /// their moments.
    std::array<double, 4> weights;
    dealii::Tensor<1, 3> normal; ///< unit, out of the second edge's body, across both edges
    double gap;                  ///< [length]; may be >= 0
    /// Allowed penetration of a pair that crosses without having come through each other: only the
    /// excess counts. It never grows, and is at most the penetration [length].
    double offset;
    /// A quarter of the product of both lengths: the share of a facet's corner between such sides
    /// [length²].
    double full_area;
    /// The reduced area: equal to full_area at the middle of the edges, 0 at their ends [length²].
    double area;
    /// Derivatives of that area with respect to the nodes' positions [length]. Those of the gap are
    /// ± w_I n, since the difference is normal to both edges.
    std::array<dealii::Tensor<1, 3>, 4> area_gradients;
    std::array<unsigned int, 2> surfaces;

    /// Returns the gap that counts; < 0 where the edges press [length].
    double counted_gap() const { return gap + offset; }

    /// Returns minus the gradients of ½ k A g², g = counted_gap(). They include the gradient of the
    /// area; otherwise an edge that slides towards the end of another would gain or lose energy.
    /// Forces and moments sum to 0, since gap and area are invariant under rigid motions of all
    /// four nodes. `stiffness`: k >= 0 [pressure/length].
    std::array<dealii::Tensor<1, 3>, 4> forces(double stiffness) const;
  };

  /// Considers edges where the scalar product of their facets' normals is below `max_alignment`.
  EdgeContact(FacetSearch::Partners partners, double max_alignment);

  /// Lists the pairs that may cross before positions move by more than `margin` relative to each
  /// other. Their gaps may be down to −`penetration` times the least reach of their facets. Each
  /// pair is listed once over all ranks: on the rank that owns the facet (among the first
  /// `n_own_facets`) that identifies the slave edge.
  void rebuild(const std::vector<SurfaceFacet> &facets, std::size_t n_own_facets, const Positions &positions,
               double margin, double penetration);

  /// Returns the pairs that cross at these positions, or are about to. Their gaps are less than the
  /// lesser reach of their facets, independently of the margin.
  ///
  /// A pair may cross now although the last commit() did not find it and it did not come through
  /// since `positions_n`. Another rule excluded it before: a normal out of bounds, or a flat edge.
  /// Such a pair gets an offset, the penetration times A over the whole area: none if it has just
  /// come in over an end.
  std::vector<Crossing> find_crossings(const Positions &positions_n, const Positions &positions,
                                       bool with_offsets);

  /// Makes the pairs of the last find_crossings() those of the step's start.
  void commit() { offsets_n_ = offsets_; }

  /// Returns the offsets of this rank's pairs at the start of the step, as numbers. add_offsets()
  /// reads those of any ranks.
  std::vector<double> offsets() const;
  void add_offsets(const std::vector<double> &numbers);

  std::size_t n_pairs() const { return pairs_.size(); }

private:
  static constexpr unsigned int none = static_cast<unsigned int>(-1);
  struct Edge {
    std::array<unsigned int, 2> nodes;
    std::array<unsigned int, 2> facets; ///< the one with the lower key first; none at a free edge
    double reach;
    std::array<std::uint64_t, 2>
        id; ///< key of the first facet, and which of its sides: the same on all ranks
  };
  using PairId = std::array<std::array<std::uint64_t, 2>, 2>;
  /// Lists all edges in `all_edges_`, unless the facets are unchanged since the last call.
  void connect(const std::vector<SurfaceFacet> &facets);
  std::vector<Edge> find_outward_edges(const Positions &positions) const;
  /// Whether a unit vector lies between the normals of the edge's facets, or close to them.
  bool is_between_normals(const Edge &edge, const dealii::Tensor<1, 3> &normal,
                          const Positions &positions) const;
  bool may_touch(const Edge &slave, const Edge &target) const;

  FacetSearch::Partners partners_;
  double max_alignment_, penetration_ = 0.;
  std::vector<SurfaceFacet> facets_;
  std::vector<Edge> all_edges_, edges_;           ///< of the facets; and the convex ones among them
  std::vector<std::array<std::size_t, 2>> pairs_; ///< slave and target
  std::map<PairId, double> offsets_n_, offsets_;  ///< of the pairs that were found
};

} // namespace billet

#endif
