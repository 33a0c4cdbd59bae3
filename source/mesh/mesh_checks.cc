// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mesh/mesh_checks.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <unordered_map>

namespace billet {

namespace {

constexpr unsigned int unused = static_cast<unsigned int>(-1);

using Position = std::array<double, 3>;

Position difference(const Position &a, const Position &b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

double norm(const Position &a) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

double determinant(const Position &a, const Position &b, const Position &c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/// List of at most three things for a message, and their number.
class Examples {
public:
  void add(const std::string &example) {
    constexpr std::size_t max_examples = 3;
    if (n_++ < max_examples)
      text_ += (text_.empty() ? "" : "; ") + example;
  }
  bool is_empty() const { return n_ == 0; }
  const std::string &text() const { return text_; }
  /// Returns "7 elements ...: first; second; third".
  std::string describe(const std::string &what) const {
    return (n_ == 1 ? "" : std::to_string(n_) + " " + what + ", such as: ") + text_;
  }

private:
  std::size_t n_ = 0;
  std::string text_;
};

/// Gives nodes their new indices; `unused` removes one.
void renumber(MeshFile &mesh, const std::vector<unsigned int> &new_index) {
  for (auto &hexahedron : mesh.hexahedra)
    for (unsigned int &node : hexahedron.nodes)
      node = new_index[node];
  std::vector<GroupedFace> faces;
  for (GroupedFace face : mesh.faces) {
    for (unsigned int &node : face.nodes)
      node = new_index[node];
    if (std::count(face.nodes.begin(), face.nodes.end(), unused) == 0)
      faces.push_back(face);
  }
  mesh.faces = std::move(faces);
  for (GroupedSet &set : mesh.node_sets) {
    std::vector<unsigned int> members;
    for (const unsigned int node : set.members)
      if (new_index[node] != unused)
        members.push_back(new_index[node]);
    set.members = std::move(members);
  }
}

void drop_unused_nodes(MeshFile &mesh) {
  std::vector<unsigned int> new_index(mesh.positions.size(), unused);
  for (const auto &hexahedron : mesh.hexahedra)
    for (const unsigned int node : hexahedron.nodes)
      new_index[node] = 0;
  unsigned int n = 0;
  for (std::size_t node = 0; node < new_index.size(); ++node)
    if (new_index[node] != unused) {
      mesh.positions[n] = mesh.positions[node];
      mesh.node_numbers[n] = mesh.node_numbers[node];
      new_index[node] = n++;
    }
  mesh.positions.resize(n);
  mesh.node_numbers.resize(n);
  renumber(mesh, new_index);
}

/// Returns for each node the first node within a distance of it, or itself if there is none. The
/// distance is the smaller one of the radii of both.
std::vector<unsigned int> nearest_first(const MeshFile &mesh, const std::vector<double> &radii) {
  const auto &x = mesh.positions;
  std::vector<unsigned int> first(x.size());
  std::iota(first.begin(), first.end(), 0U);
  // Nodes of large radii come first, so that a node meets only nodes whose radii are not smaller.
  std::vector<unsigned int> order = first;
  std::stable_sort(order.begin(), order.end(),
                   [&](const unsigned int a, const unsigned int b) { return radii[a] > radii[b]; });
  // The node is in a cell of the level of its radius: cells are twice as wide as the radii of a
  // level.
  using Cell = std::array<std::int64_t, 4>;
  const auto level_of = [&](const unsigned int node) {
    int level = 0;
    // 2^(level - 1) < radius <= 2^level.
    return std::frexp(radii[node], &level) == 0.5 ? level - 1 : level;
  };
  const auto cell_of = [&](const Position &p, const int level) {
    Cell cell{0, 0, 0, level};
    for (unsigned int c = 0; c < 3; ++c)
      cell[c] = static_cast<std::int64_t>(std::floor(std::ldexp(p[c] - x.front()[c], -level - 1)));
    return cell;
  };
  const auto hash = [](const Cell &cell) {
    std::uint64_t h = 0;
    for (const std::int64_t c : cell)
      h = (h ^ static_cast<std::uint64_t>(c)) * 0x9E3779B97F4A7C15ULL + (h >> 29U);
    return static_cast<std::size_t>(h);
  };
  std::unordered_map<Cell, std::vector<unsigned int>, decltype(hash)> kept(x.size(), hash);
  std::vector<int> levels; // so far
  for (const unsigned int node : order) {
    if (levels.empty() || levels.back() != level_of(node))
      levels.push_back(level_of(node));
    for (const int level : levels) {
      // At most two cells along each axis are near.
      std::array<Cell, 2> range{};
      for (unsigned int side = 0; side < 2; ++side) {
        Position corner = x[node];
        for (double &c : corner)
          c += side == 0 ? -radii[node] : radii[node];
        range[side] = cell_of(corner, level);
      }
      for (Cell cell = range[0]; cell[0] <= range[1][0]; ++cell[0])
        for (cell[1] = range[0][1]; cell[1] <= range[1][1]; ++cell[1])
          for (cell[2] = range[0][2]; cell[2] <= range[1][2]; ++cell[2])
            if (const auto found = kept.find(cell); found != kept.end())
              for (const unsigned int other : found->second)
                if (norm(difference(x[other], x[node])) <= radii[node])
                  first[node] = std::min(first[node], other);
    }
    if (first[node] == node)
      kept[cell_of(x[node], levels.back())].push_back(node);
  }
  return first;
}

/// Returns the same with one distance for all nodes.
std::vector<unsigned int> nearest_first(const MeshFile &mesh, const double distance) {
  return nearest_first(mesh, std::vector<double>(mesh.positions.size(), distance));
}

std::string number(const long long value) { return std::to_string(value); }

void check_collapsed(const MeshFile &mesh, const double distance, const bool is_merged) {
  Examples collapsed;
  for (const auto &[element, nodes] : mesh.hexahedra) {
    std::string pair;
    for (unsigned int a = 0; a < 8 && pair.empty(); ++a)
      for (unsigned int b = a + 1; b < 8 && pair.empty(); ++b)
        if (nodes[a] == nodes[b])
          pair = is_merged ? "element " + number(element) + " has two corners at node " +
                                 number(mesh.node_numbers[nodes[a]])
                           : "element " + number(element) + " has node " +
                                 number(mesh.node_numbers[nodes[a]]) + " twice";
        else if (norm(difference(mesh.positions[nodes[a]], mesh.positions[nodes[b]])) <= distance)
          pair = "element " + number(element) + " has nodes " + number(mesh.node_numbers[nodes[a]]) +
                 " and " + number(mesh.node_numbers[nodes[b]]) + " at the same place";
    if (!pair.empty())
      collapsed.add(pair);
  }
  if (!collapsed.is_empty())
    throw std::invalid_argument(
        collapsed.describe("of its elements are collapsed") +
        (is_merged
             ? " after nodes were merged: the distance of 'Merge nodes within' is too large, or the element "
               "is collapsed in the file"
             : "; allowed are hexahedra with eight different corners"));
}

void refuse_doubled(const MeshFile &mesh, const std::vector<unsigned int> &first) {
  Examples doubled;
  for (std::size_t node = 0; node < first.size(); ++node)
    if (first[node] != node)
      doubled.add("nodes " + number(mesh.node_numbers[first[node]]) + " and " +
                  number(mesh.node_numbers[node]) +
                  " of it are at the same place, so that the elements there are not joined");
  if (!doubled.is_empty())
    throw std::invalid_argument(
        doubled.describe("of its nodes are doubled") +
        ". 'Merge nodes within' (a length, such as 1e-3 of an edge) joins them, and 0 "
        "keeps them apart, for parts that only touch");
}

void check_repeated(const MeshFile &mesh) {
  std::vector<std::pair<std::array<unsigned int, 8>, std::size_t>> sorted;
  for (std::size_t i = 0; i < mesh.hexahedra.size(); ++i) {
    sorted.emplace_back(mesh.hexahedra[i].nodes, i);
    std::sort(sorted.back().first.begin(), sorted.back().first.end());
  }
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 1; i < sorted.size(); ++i)
    if (sorted[i].first == sorted[i - 1].first)
      throw std::invalid_argument("elements " + number(mesh.hexahedra[sorted[i - 1].second].number) +
                                  " and " + number(mesh.hexahedra[sorted[i].second].number) +
                                  " of it have the same corners; delete one of them");
}

/// Signs of the corners' coordinates in the reference element.
constexpr int signs[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                             {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

/// Returns the Jacobian in the Gauss point next to a corner, where the elements need it.
double jacobian(const MeshFile &mesh, const std::array<unsigned int, 8> &nodes, const unsigned int corner) {
  constexpr double gauss_point = 0.57735026918962576451;
  std::array<Position, 3> derivative{};
  for (unsigned int i = 0; i < 8; ++i) {
    std::array<double, 3> factor{};
    for (unsigned int c = 0; c < 3; ++c)
      factor[c] = 0.5 * (1. + gauss_point * signs[i][c] * signs[corner][c]);
    for (unsigned int c = 0; c < 3; ++c)
      for (unsigned int k = 0; k < 3; ++k)
        derivative[c][k] +=
            0.5 * signs[i][c] * factor[(c + 1) % 3] * factor[(c + 2) % 3] * mesh.positions[nodes[i]][k];
  }
  return determinant(derivative[0], derivative[1], derivative[2]);
}

void check_inverted(MeshFile &mesh) {
  const auto is_inverted = [&](const FileHexahedron &hexahedron) {
    double volume = 0.;
    for (unsigned int corner = 0; corner < 8; ++corner)
      volume += jacobian(mesh, hexahedron.nodes, corner);
    return volume < 0.;
  };
  // Some programs write the corners of all hexahedra in the other order.
  if (std::all_of(mesh.hexahedra.begin(), mesh.hexahedra.end(), is_inverted))
    for (auto &hexahedron : mesh.hexahedra)
      for (unsigned int i = 0; i < 4; ++i)
        std::swap(hexahedron.nodes[i], hexahedron.nodes[i + 4]);
  constexpr double rounding = 1e-14; // of the cube of an element's size
  Examples inverted;
  for (const FileHexahedron &hexahedron : mesh.hexahedra) {
    double size = 0.;
    for (const unsigned int node : hexahedron.nodes)
      size = std::max(size, norm(difference(mesh.positions[node], mesh.positions[hexahedron.nodes[0]])));
    for (unsigned int corner = 0; corner < 8; ++corner)
      if (!(jacobian(mesh, hexahedron.nodes, corner) > rounding * size * size * size)) {
        inverted.add("element " + number(hexahedron.number) + " is inverted or flat near its node " +
                     number(mesh.node_numbers[hexahedron.nodes[corner]]));
        break;
      }
  }
  if (!inverted.is_empty())
    throw std::invalid_argument(
        inverted.describe("of its elements are inverted or flat") +
        "; allowed are hexahedra with a positive Jacobian. Check the order of its nodes: "
        "four around one face, then the four above them");
}

/// Finds nodes that are close to each other for the edges there, or within `same_place`. No edge of
/// an element is as short as that.
NearNodes find_near_nodes(const MeshFile &mesh, const double same_place) {
  constexpr double near = 1e-3; // of the shortest edge at a node
  constexpr unsigned int edges[12][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                         {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  std::vector<double> radii(mesh.positions.size(), std::numeric_limits<double>::max());
  for (const FileHexahedron &hexahedron : mesh.hexahedra)
    for (const auto &edge : edges) {
      const unsigned int a = hexahedron.nodes[edge[0]], b = hexahedron.nodes[edge[1]];
      const double length = near * norm(difference(mesh.positions[a], mesh.positions[b]));
      radii[a] = std::min(radii[a], length);
      radii[b] = std::min(radii[b], length);
    }
  for (double &radius : radii)
    radius = std::max(radius, same_place);
  const std::vector<unsigned int> first = nearest_first(mesh, radii);
  NearNodes found;
  Examples examples;
  for (std::size_t node = 0; node < first.size(); ++node)
    if (first[node] != node) {
      ++found.n_pairs;
      found.distance =
          std::max(found.distance, norm(difference(mesh.positions[first[node]], mesh.positions[node])));
      examples.add(number(mesh.node_numbers[first[node]]) + " and " + number(mesh.node_numbers[node]));
    }
  found.examples = examples.text();
  return found;
}

} // namespace

NearNodes mend_and_check(MeshFile &mesh, const DoubledNodes doubled, const double distance) {
  drop_unused_nodes(mesh);
  Position least = mesh.positions.front(), most = least;
  for (const Position &position : mesh.positions)
    for (unsigned int c = 0; c < 3; ++c) {
      least[c] = std::min(least[c], position[c]);
      most[c] = std::max(most[c], position[c]);
    }
  const double same_place = 1e-10 * norm(difference(most, least));
  NearNodes near_nodes;
  if (doubled == DoubledNodes::merged) {
    check_collapsed(mesh, -1., false);
    renumber(mesh, nearest_first(mesh, std::max(distance, same_place)));
    check_collapsed(mesh, -1., true);
    drop_unused_nodes(mesh);
    near_nodes = find_near_nodes(mesh, same_place);
  } else {
    check_collapsed(mesh, same_place, false);
    if (doubled == DoubledNodes::refused)
      near_nodes = find_near_nodes(mesh, same_place);
    if (near_nodes.n_pairs > 0) // these include those at the same place
      refuse_doubled(mesh, nearest_first(mesh, same_place));
  }
  check_repeated(mesh);
  check_inverted(mesh);
  return near_nodes;
}

} // namespace billet
