// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_FACET_SEARCH_H
#define BILLET_CONTACT_FACET_SEARCH_H

#include "billet/geometry/facet_bulge.h"
#include "billet/geometry/surface_patch.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace billet {

/// A four-node facet of a deformable body's surface.
struct SurfaceFacet {
  std::array<unsigned int, 4> nodes; ///< in the order of FacetCorners
  unsigned int surface;              ///< index of its body
  std::uint64_t key;                 ///< the same on any number of ranks
  /// Maximum penetration of a node that has not touched the facet before [length]. It is a fraction
  /// of the facet's size, and less than the thickness of the wall below.
  double reach;
  FacetBulge bulge{}; ///< of the smooth surface that the facet represents; 0 if there is none
  /// Undeformed thickness of the element below, where known [length].
  double wall = std::numeric_limits<double>::infinity();
};

/// Returns the projection onto the smooth surface that a facet represents, from the projection onto
/// the facet.
template <class Projection> Projection raised(Projection projection, const SurfaceFacet &facet) {
  if (projection.exists && facet::has_height(facet.bulge))
    projection.gap -= facet::height(facet.bulge, projection.parameters);
  return projection;
}

/// Returns the index of the corner at which the facet has this node.
inline unsigned int corner_of(const SurfaceFacet &facet, const unsigned int node) {
  unsigned int corner = 0;
  while (facet.nodes[corner] != node)
    ++corner;
  return corner;
}

/// A node that may touch facets.
struct SlaveNode {
  unsigned int node;
  unsigned int surface;
};

/// Finds the facets near slave nodes while all of them move.
///
/// Each slave has a list of candidates. It contains every facet within its reach of the node, now
/// or on the straight paths of both since the start of the step. A list contains facets within
/// reach + margin, so that it remains valid until nodes have moved by more than the margin relative
/// to each other. Only then are the lists rebuilt.
///
/// The displacements since then lie in a box. No relative displacement exceeds its diagonal, and no
/// common motion enlarges it.
///
/// A facet is never a candidate of its own nodes, nor of the nodes of facets that share a node with
/// it. Building the lists takes O(n log n), with a tree of the facets' boxes; a look-up costs
/// nothing.
class FacetSearch {
public:
  enum class Partners {
    other_surfaces,          ///< facets of the node's own surface are no candidates
    other_surfaces_and_self, ///< they are, except those around the node
  };

  using Positions = std::vector<dealii::Tensor<1, 3>>;

  /// `margin` > 0 [length]
  FacetSearch(Partners partners, double margin);

  /// Sets a new surface: rebuild() must follow before the lists are used.
  void set_surface(std::vector<SurfaceFacet> facets, std::vector<SlaveNode> slaves);

  /// Whether there are no lists, or they are no longer valid at these positions. `join` extends the
  /// box of this rank's displacements to all ranks; it is not called if there are no lists.
  template <class Join> bool is_outdated(const Positions &positions, const Join &join) const {
    return !has_lists_ || exceeds_margin(join(compute_motion(positions)));
  }

  /// Builds the lists. `positions_n` are those at the start of the step, of every node of facets
  /// and slaves.
  void rebuild(const Positions &positions_n, const Positions &positions);

  const std::vector<SurfaceFacet> &facets() const { return facets_; }
  const std::vector<SlaveNode> &slaves() const { return slaves_; }

  /// Calls visit(facet) for each candidate of a slave, by ascending keys. Both are indices of the
  /// lists above.
  template <class Visit> void visit_candidates(const std::size_t slave, const Visit &visit) const {
    for (std::size_t i = first_candidate_[slave]; i < first_candidate_[slave + 1]; ++i)
      visit(candidates_[i]);
  }

  bool has_candidates(const std::size_t slave) const {
    return first_candidate_[slave] < first_candidate_[slave + 1];
  }

  /// Calls visit(facet) for each facet that has this node, by ascending keys.
  template <class Visit> void visit_around(const unsigned int node, const Visit &visit) const {
    for (std::size_t i = first_around_[node]; i < first_around_[node + 1]; ++i)
      visit(around_[i]);
  }

  /// Returns the node at the corner nearest to these parameters of a facet.
  unsigned int nearest_corner(const unsigned int facet, const std::array<double, 2> &parameters) const {
    return facets_[facet].nodes[(parameters[0] < 0. ? 0U : 1U) + (parameters[1] < 0. ? 0U : 2U)];
  }

  /// Calls visit(facet) once for each facet that shares nodes with this one.
  template <class Visit> void visit_ring(const unsigned int facet, const Visit &visit) const {
    const auto &nodes = facets_[facet].nodes;
    for (unsigned int a = 0; a < 4; ++a)
      for (std::size_t i = first_around_[nodes[a]]; i < first_around_[nodes[a] + 1]; ++i) {
        bool is_new = around_[i] != facet;
        for (unsigned int b = 0; b < a; ++b)
          is_new = is_new && !has_node(facets_[around_[i]], nodes[b]);
        if (is_new)
          visit(around_[i]);
      }
  }

  std::size_t n_rebuilds() const { return n_rebuilds_; }
  std::size_t n_candidates() const { return candidates_.size(); }

private:
  static bool has_node(const SurfaceFacet &facet, const unsigned int node) {
    return facet.nodes[0] == node || facet.nodes[1] == node || facet.nodes[2] == node ||
           facet.nodes[3] == node;
  }
  /// Returns the box of all displacements of nodes since the lists were built.
  BoundingBox compute_motion(const Positions &positions) const;
  bool exceeds_margin(const BoundingBox &motion) const;
  bool is_excluded(const SlaveNode &slave, const SurfaceFacet &facet) const;

  Partners partners_;
  double margin_;
  std::vector<SurfaceFacet> facets_;
  std::vector<SlaveNode> slaves_;
  /// Facets around node i: around_[first_around_[i]], ..., before first_around_[i + 1].
  std::vector<std::size_t> first_around_;
  std::vector<unsigned int> around_;
  Positions built_at_;
  bool has_lists_ = false;
  std::vector<std::size_t> first_candidate_;
  std::vector<unsigned int> candidates_;
  std::size_t n_rebuilds_ = 0;
};

} // namespace billet

#endif
