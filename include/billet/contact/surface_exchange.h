// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_CONTACT_SURFACE_EXCHANGE_H
#define BILLET_CONTACT_SURFACE_EXCHANGE_H

#include "billet/contact/facet_search.h"

#include <mpi.h>

#include <map>
#include <type_traits>

namespace billet {

/// Brings the facets of other ranks near a rank's own surface nodes to that rank, with data of
/// their nodes, and returns forces.
///
/// A rank's own nodes come first, as given, then the ghost nodes, which belong to facets of other
/// ranks. Facets have the same order. Ranks whose surfaces are near each other exchange messages;
/// all ranks together exchange only one box each. All functions except the const ones are
/// collective. With one rank nothing happens.
class SurfaceExchange {
public:
  using Positions = FacetSearch::Positions;

  /// Constructs the exchange. `node_keys` are the same on all ranks that have a node, and different
  /// for different nodes. Nodes of `facets` are indices of `node_keys`; each facet is on one rank,
  /// with a unique key. Both may be empty.
  SurfaceExchange(MPI_Comm communicator, std::vector<std::uint64_t> node_keys,
                  std::vector<SurfaceFacet> facets);

  /// Finds the ghosts. These are facets of other ranks within `distance` (the same on all ranks) of
  /// the boxes around small groups of own nodes. Their boxes cover the motion from the start of the
  /// step to now. Positions are those of own nodes; ghosts after them are ignored. Indices of
  /// former ghosts become invalid.
  void rebuild(const Positions &positions_n, const Positions &positions, double distance);

  /// Returns the keys of own nodes.
  const std::vector<std::uint64_t> &node_keys() const { return node_keys_; }
  std::size_t n_own_nodes() const { return node_keys_.size(); }
  std::size_t n_nodes() const { return node_keys_.size() + n_ghost_nodes_; }
  std::size_t n_own_facets() const { return n_own_facets_; }
  /// Returns own facets, then ghosts.
  const std::vector<SurfaceFacet> &facets() const { return facets_; }

  /// Overwrites the values of ghost nodes by those of their owners. `values`, of all nodes, is
  /// resized. T is any trivially copyable type, such as an array of all data of a node.
  template <class T> void update(std::vector<T> &values) const {
    static_assert(std::is_trivially_copyable_v<T>, "sent as bytes");
    values.resize(n_nodes());
    forward(values.data(), sizeof(T));
  }

  /// Adds the values of ghost nodes to those of their owners, in the order of the ranks, so that
  /// sums are reproducible. The ghosts' values are 0 afterwards. For a node that several ranks own,
  /// one of them receives the addition, or this rank if it is one of them. Only the sum over all
  /// ranks matters. T is Tensor<1, 3> or double.
  template <class T> void collect(std::vector<T> &values) const;

private:
  /// A rank whose surface is near.
  struct Neighbour {
    int rank;
    std::vector<unsigned int> sent;     ///< own nodes that are ghosts there, or would be
    std::vector<unsigned int> received; ///< local indices of the nodes that come from there
    /// Whether the ghost comes from this rank; otherwise the node is known already.
    std::vector<bool> is_provider;
  };
  /// Message with facets from one neighbour to another.
  struct Parcel {
    std::vector<std::uint64_t> node_keys;
    std::vector<SurfaceFacet> facets; ///< nodes are indices of `node_keys`
  };

  /// Updates values of `size` bytes each.
  void forward(void *values, std::size_t size) const;
  std::vector<int> find_near_ranks(const BoundingBox &box, double distance) const;
  std::vector<BoundingBox> make_boxes(const Positions &positions_n, const Positions &positions) const;
  Parcel pack(const Positions &positions_n, const Positions &positions, double distance,
              const std::vector<BoundingBox> &boxes, Neighbour &neighbour) const;
  void unpack(const Parcel &parcel, std::map<std::uint64_t, unsigned int> &ghosts, Neighbour &neighbour);

  MPI_Comm communicator_;
  int n_ranks_;
  std::vector<std::uint64_t> node_keys_;
  std::map<std::uint64_t, unsigned int> own_nodes_;
  std::size_t n_own_facets_, n_ghost_nodes_ = 0;
  std::vector<SurfaceFacet> facets_;
  std::vector<Neighbour> neighbours_; ///< by rank
};

} // namespace billet

#endif
