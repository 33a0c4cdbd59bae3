// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/contact/surface_exchange.h"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace billet {

using dealii::Tensor;

namespace {

constexpr std::size_t n_boxes = 64;       // maximum for one rank
constexpr std::size_t n_group_nodes = 16; // minimum number of nodes in a box

/// Calls MPI_Waitall in its destructor, for requests that refer to buffers without owning them.
class Requests {
public:
  explicit Requests(MPI_Comm communicator) : communicator_(communicator) {}
  ~Requests() { MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE); }
  Requests(const Requests &) = delete;
  Requests &operator=(const Requests &) = delete;

  template <class T> void send(const std::vector<T> &data, const int rank) {
    static_assert(std::is_trivially_copyable_v<T>, "sent as bytes");
    MPI_Isend(data.data(), static_cast<int>(data.size() * sizeof(T)), MPI_BYTE, rank, 0, communicator_,
              add());
  }
  template <class T> void receive(std::vector<T> &data, const int rank) {
    static_assert(std::is_trivially_copyable_v<T>, "sent as bytes");
    MPI_Irecv(data.data(), static_cast<int>(data.size() * sizeof(T)), MPI_BYTE, rank, 0, communicator_,
              add());
  }

private:
  MPI_Request *add() { return &requests_.emplace_back(MPI_REQUEST_NULL); }

  MPI_Comm communicator_;
  std::vector<MPI_Request> requests_;
};

/// Sends a list to each of these ranks, and returns the lists that they send.
template <class T>
std::vector<std::vector<T>> swap_lists(MPI_Comm communicator, const std::vector<int> &ranks,
                                       const std::vector<std::vector<T>> &to_send) {
  std::vector<std::vector<std::size_t>> n_sent(ranks.size()), n_received(ranks.size());
  {
    Requests requests(communicator);
    for (std::size_t i = 0; i < ranks.size(); ++i) {
      n_received[i].resize(1);
      requests.receive(n_received[i], ranks[i]);
      n_sent[i] = {to_send[i].size()};
      requests.send(n_sent[i], ranks[i]);
    }
  }
  std::vector<std::vector<T>> received(ranks.size());
  Requests requests(communicator);
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    received[i].resize(n_received[i][0]);
    requests.receive(received[i], ranks[i]);
    requests.send(to_send[i], ranks[i]);
  }
  return received;
}

} // namespace

SurfaceExchange::SurfaceExchange(MPI_Comm communicator, std::vector<std::uint64_t> node_keys,
                                 std::vector<SurfaceFacet> facets)
    : communicator_(communicator), node_keys_(std::move(node_keys)), n_own_facets_(facets.size()),
      facets_(std::move(facets)) {
  MPI_Comm_size(communicator_, &n_ranks_);
  if (n_ranks_ > 1)
    for (unsigned int i = 0; i < node_keys_.size(); ++i)
      own_nodes_.emplace(node_keys_[i], i);
}

std::vector<int> SurfaceExchange::find_near_ranks(const BoundingBox &box, const double distance) const {
  int own_rank = 0;
  MPI_Comm_rank(communicator_, &own_rank);
  std::vector<BoundingBox> boxes(static_cast<std::size_t>(n_ranks_));
  MPI_Allgather(&box, sizeof(BoundingBox), MPI_BYTE, boxes.data(), sizeof(BoundingBox), MPI_BYTE,
                communicator_);
  // Both ranks of a pair must compute the same answer, bit by bit; otherwise one would wait for the
  // other.
  const auto is_near = [&](const BoundingBox &other) {
    bool all = true;
    for (unsigned int i = 0; i < 3; ++i)
      all = all && box.low[i] - other.high[i] <= distance && other.low[i] - box.high[i] <= distance;
    return all;
  };
  std::vector<int> ranks;
  for (int rank = 0; rank < n_ranks_; ++rank)
    if (rank != own_rank && is_near(boxes[static_cast<std::size_t>(rank)]))
      ranks.push_back(rank);
  return ranks;
}

std::vector<BoundingBox> SurfaceExchange::make_boxes(const Positions &positions_n,
                                                     const Positions &positions) const {
  // Groups of nodes are halved along their longest extent until there are enough of them.
  std::vector<unsigned int> nodes(node_keys_.size());
  std::iota(nodes.begin(), nodes.end(), 0);
  struct Group {
    std::size_t begin, end;
    BoundingBox box;
  };
  const auto make_group = [&](const std::size_t begin, const std::size_t end) {
    Group group{begin, end, BoundingBox::empty()};
    for (std::size_t i = begin; i < end; ++i) {
      group.box.add(positions_n[nodes[i]]);
      group.box.add(positions[nodes[i]]);
    }
    return group;
  };
  std::vector<Group> groups{make_group(0, nodes.size())};
  for (std::size_t n_last = 0; n_last != groups.size() && 2 * groups.size() <= n_boxes;) {
    n_last = groups.size();
    for (std::size_t g = 0; g < n_last; ++g) {
      const Group group = groups[g];
      if (group.end - group.begin < 2 * n_group_nodes)
        continue;
      const Tensor<1, 3> extent = group.box.high - group.box.low;
      unsigned int axis = 0;
      for (unsigned int i = 1; i < 3; ++i)
        if (extent[i] > extent[axis])
          axis = i;
      const std::size_t half = (group.begin + group.end) / 2;
      const auto first = nodes.begin();
      std::nth_element(
          first + static_cast<std::ptrdiff_t>(group.begin), first + static_cast<std::ptrdiff_t>(half),
          first + static_cast<std::ptrdiff_t>(group.end), [&](const unsigned int a, const unsigned int b) {
            return positions[a][axis] < positions[b][axis];
          });
      groups[g] = make_group(group.begin, half);
      groups.push_back(make_group(half, group.end));
    }
  }
  std::vector<BoundingBox> boxes;
  boxes.reserve(groups.size());
  for (const auto &group : groups)
    boxes.push_back(group.box);
  return boxes;
}

SurfaceExchange::Parcel SurfaceExchange::pack(const Positions &positions_n, const Positions &positions,
                                              const double distance, const std::vector<BoundingBox> &boxes,
                                              Neighbour &neighbour) const {
  Parcel parcel;
  BoundingBox all = BoundingBox::empty();
  for (const auto &box : boxes)
    all.add(box);
  // Index in the parcel.
  std::vector<unsigned int> index(node_keys_.size(), static_cast<unsigned int>(-1));
  for (std::size_t f = 0; f < n_own_facets_; ++f) {
    SurfaceFacet facet = facets_[f];
    BoundingBox facet_box = BoundingBox::empty();
    for (const unsigned int node : facet.nodes) {
      facet_box.add(positions_n[node]);
      facet_box.add(positions[node]);
    }
    facet_box.enlarge(distance);
    if (!all.overlaps(facet_box) || std::none_of(boxes.begin(), boxes.end(), [&](const BoundingBox &box) {
          return box.overlaps(facet_box);
        }))
      continue;
    for (unsigned int &node : facet.nodes) {
      if (index[node] == static_cast<unsigned int>(-1)) {
        index[node] = static_cast<unsigned int>(neighbour.sent.size());
        neighbour.sent.push_back(node);
        parcel.node_keys.push_back(node_keys_[node]);
      }
      node = index[node];
    }
    parcel.facets.push_back(facet);
  }
  return parcel;
}

void SurfaceExchange::unpack(const Parcel &parcel, std::map<std::uint64_t, unsigned int> &ghosts,
                             Neighbour &neighbour) {
  for (const std::uint64_t key : parcel.node_keys) {
    const auto own = own_nodes_.find(key);
    const bool is_own = own != own_nodes_.end();
    bool is_new = false;
    if (is_own)
      neighbour.received.push_back(own->second);
    else {
      const auto ghost = ghosts.emplace(key, static_cast<unsigned int>(n_nodes()));
      is_new = ghost.second;
      n_ghost_nodes_ += is_new ? 1 : 0;
      neighbour.received.push_back(ghost.first->second);
    }
    neighbour.is_provider.push_back(is_new);
  }
  for (SurfaceFacet facet : parcel.facets) {
    for (unsigned int &node : facet.nodes)
      node = neighbour.received[node];
    facets_.push_back(facet);
  }
}

void SurfaceExchange::rebuild(const Positions &positions_n, const Positions &positions,
                              const double distance) {
  if (n_ranks_ == 1)
    return;
  neighbours_.clear();
  n_ghost_nodes_ = 0;
  facets_.resize(n_own_facets_);

  const std::vector<BoundingBox> own_boxes = make_boxes(positions_n, positions);
  BoundingBox own_box = BoundingBox::empty();
  for (const auto &box : own_boxes)
    own_box.add(box);
  const std::vector<int> ranks = find_near_ranks(own_box, distance);
  const auto boxes =
      swap_lists(communicator_, ranks, std::vector<std::vector<BoundingBox>>(ranks.size(), own_boxes));

  std::vector<std::vector<std::uint64_t>> keys_to_send;
  std::vector<std::vector<SurfaceFacet>> facets_to_send;
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    neighbours_.push_back({ranks[i], {}, {}, {}});
    Parcel parcel = pack(positions_n, positions, distance, boxes[i], neighbours_.back());
    keys_to_send.push_back(std::move(parcel.node_keys));
    facets_to_send.push_back(std::move(parcel.facets));
  }
  const auto keys = swap_lists(communicator_, ranks, keys_to_send);
  const auto facets = swap_lists(communicator_, ranks, facets_to_send);
  std::map<std::uint64_t, unsigned int> ghosts;
  for (std::size_t i = 0; i < ranks.size(); ++i)
    unpack({keys[i], facets[i]}, ghosts, neighbours_[i]);
}

void SurfaceExchange::forward(void *values, const std::size_t size) const {
  auto *const bytes = static_cast<unsigned char *>(values);
  std::vector<std::vector<unsigned char>> to_send(neighbours_.size()), received(neighbours_.size());
  {
    Requests requests(communicator_);
    for (std::size_t i = 0; i < neighbours_.size(); ++i) {
      const Neighbour &neighbour = neighbours_[i];
      received[i].resize(size * neighbour.received.size());
      requests.receive(received[i], neighbour.rank);
      to_send[i].resize(size * neighbour.sent.size());
      for (std::size_t k = 0; k < neighbour.sent.size(); ++k)
        std::memcpy(to_send[i].data() + size * k, bytes + size * neighbour.sent[k], size);
      requests.send(to_send[i], neighbour.rank);
    }
  }
  for (std::size_t i = 0; i < neighbours_.size(); ++i)
    for (std::size_t k = 0; k < neighbours_[i].received.size(); ++k)
      if (neighbours_[i].is_provider[k])
        std::memcpy(bytes + size * neighbours_[i].received[k], received[i].data() + size * k, size);
}

template <class T> void SurfaceExchange::collect(std::vector<T> &values) const {
  std::vector<std::vector<T>> to_send(neighbours_.size()), received(neighbours_.size());
  {
    Requests requests(communicator_);
    for (std::size_t i = 0; i < neighbours_.size(); ++i) {
      const Neighbour &neighbour = neighbours_[i];
      received[i].resize(neighbour.sent.size());
      requests.receive(received[i], neighbour.rank);
      for (std::size_t k = 0; k < neighbour.received.size(); ++k)
        to_send[i].push_back(neighbour.is_provider[k] ? values[neighbour.received[k]] : T());
      requests.send(to_send[i], neighbour.rank);
    }
  }
  for (std::size_t i = 0; i < neighbours_.size(); ++i)
    for (std::size_t k = 0; k < received[i].size(); ++k)
      values[neighbours_[i].sent[k]] += received[i][k];
  std::fill(values.begin() + static_cast<std::ptrdiff_t>(n_own_nodes()), values.end(), T());
}

template void SurfaceExchange::collect(std::vector<double> &) const;
template void SurfaceExchange::collect(std::vector<Tensor<1, 3>> &) const;

} // namespace billet
