// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_EDGE_CONTACT_H
#define BILLET_CONTACT_EDGE_CONTACT_H

#include "billet/contact/facet_search.h"

#include <map>
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
    double gap;                  ///< [length]; may be >= 0
    /// Of a pair that is found to cross without having come through each other: only what is deeper counts.
    /// It never grows, and is at most the depth [length].
    double offset;
    /// A quarter of the product of both lengths, the share of a facet's corner between such sides [length²],
    double full_area;
    /// and what is left of it towards the ends of the edges, all in the middle, 0 there [length²].
    double area;
    /// Of that by the positions of the nodes [length]. The gap's are ± w_I n, since the difference stands on
    /// both edges.
    std::array<dealii::Tensor<1, 3>, 4> area_gradients;
    std::array<unsigned int, 2> surfaces;

    /// What counts; < 0 where the edges press [length].
    double counted_gap() const { return gap + offset; }

    /// Minus the gradients of ½ k A g², g = counted_gap(): of the area, too, else an edge that slides towards
    /// the end of another would make energy or lose it. Their sum is 0, and that of their moments, since
    /// neither gap nor area depends on how all four nodes move or turn together. `stiffness`: k >= 0
    /// [pressure/length].
    std::array<dealii::Tensor<1, 3>, 4> forces(double stiffness) const;
  };

  /// Edges count where the scalar product of their facets' normals is below `largest_alignment`.
  EdgeContact(FacetSearch::Partners partners, double largest_alignment);

  /// Makes lists of the pairs that may come to cross before positions move by more than `margin` relative to
  /// each other, deeper than −`depth` times the least reach of their facets. Each pair is listed once over
  /// all ranks: where the facet is owned (among the first `n_own_facets`) that names the slave edge.
  void rebuild(const std::vector<SurfaceFacet> &facets, std::size_t n_own_facets, const Positions &positions,
               double margin, double depth);

  /// The pairs that cross at these positions, or are about to: with gaps less than the lesser reach of their
  /// facets, which does not depend on the margin.
  ///
  /// A pair that the last commit() did not find, that crosses now and did not come through since
  /// `positions_n`, is one that another rule kept apart: a normal out of bounds, an edge that was flat. It
  /// gets an offset, the depth times A over the whole area: none where it has just come in over an end.
  std::vector<Crossing> find_crossings(const Positions &positions_n, const Positions &positions,
                                       bool with_offsets);

  /// The pairs of the last find_crossings() are those of the step's start.
  void commit() { offsets_n_ = offsets_; }

  /// Offsets at the start of the step, of this rank's pairs, in numbers, and back: those of any ranks.
  std::vector<double> offsets() const;
  void add_offsets(const std::vector<double> &numbers);

  std::size_t n_pairs() const { return pairs_.size(); }

private:
  static constexpr unsigned int none = static_cast<unsigned int>(-1);
  struct Edge {
    std::array<unsigned int, 2> nodes;
    std::array<unsigned int, 2> facets; ///< that with the lower key first; none at a border
    double reach;
    std::array<std::uint64_t, 2>
        id; ///< key of the first facet, and which of its sides: the same on all ranks
  };
  using PairId = std::array<std::array<std::uint64_t, 2>, 2>;
  /// Finds all edges, in `all_edges_`, unless the facets are those of the last time.
  void connect(const std::vector<SurfaceFacet> &facets);
  std::vector<Edge> find_outward_edges(const Positions &positions) const;
  /// A unit vector lies between the normals of the edge's facets, or not far beside them.
  bool is_between_normals(const Edge &edge, const dealii::Tensor<1, 3> &normal,
                          const Positions &positions) const;
  bool may_touch(const Edge &slave, const Edge &target) const;

  FacetSearch::Partners partners_;
  double largest_alignment_, depth_ = 0.;
  std::vector<SurfaceFacet> facets_;
  std::vector<Edge> all_edges_, edges_;           ///< of the facets; and of these the outward ones
  std::vector<std::array<std::size_t, 2>> pairs_; ///< slave and target
  std::map<PairId, double> offsets_n_, offsets_;  ///< of the pairs that were found
};

} // namespace billet

#endif
