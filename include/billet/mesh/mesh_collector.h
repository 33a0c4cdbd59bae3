// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MESH_MESH_COLLECTOR_H
#define BILLET_MESH_MESH_COLLECTOR_H

#include "billet/mesh/mesh_file.h"

#include <array>
#include <map>
#include <string>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

namespace billet {

/// Kind of a cell of a mesh file, as far as it matters here.
enum class CellKind {
  hexahedron,
  quadrilateral,
  line,        ///< counts in a two-dimensional mesh only
  triangle,    ///< refused in a two-dimensional mesh, else no face of a hexahedron
  ignored,     ///< others that are no face of a hexahedron
  tetrahedron, ///< this and those below are refused
  wedge,
  pyramid,
  second_order
};

/// Kind and number of nodes of a type of cells in a file format.
struct CellShape {
  CellKind kind = CellKind::ignored;
  unsigned int n_nodes = 0; ///< 0: the type is unknown
};

/// Nodes, cells and groups of a file in the order in which it has them. Cells name nodes by their
/// numbers in the file, which may follow later.
class MeshCollector {
public:
  /// `node_word`: "node", or words for a format that does not number its nodes.
  explicit MeshCollector(std::string node_word = "node") : node_word_(std::move(node_word)) {}

  void add_node(long long number, const std::array<double, 3> &position);
  /// Adds a cell with `shape.n_nodes` nodes.
  void add_cell(const CellShape &shape, long long number, const long long *nodes,
                const std::vector<std::size_t> &groups);
  void add_face(const std::array<long long, 4> &nodes, std::size_t group);
  /// Adds an edge of a group, which counts in a file without hexahedra only.
  void add_edge(const std::array<long long, 2> &nodes, const FaceGroup &group);

  /// Returns the index of the group with this name, number and kind; adds it if there is none.
  std::size_t group(const std::string &name, unsigned int number, const std::string &kind = "");
  /// Returns the index of the group without a name and with this number. Throws if it is no
  /// boundary id.
  std::size_t numbered_group(long long number);

  /// Returns the index of the volume with this name and number; adds it if there is none.
  std::size_t volume(const std::string &name, unsigned int number, bool is_part);
  /// Adds a hexahedron, by its number, to a volume.
  void add_to_volume(std::size_t volume, long long hexahedron) {
    volume_members_.emplace_back(volume, hexahedron);
  }

  /// Counts something of the file that is not read.
  void leave_unread(const std::string &keyword) { ++mesh_.unread[keyword]; }

  bool has_node(const long long number) const { return node_index_.count(number) > 0; }
  unsigned int node_index(long long number, const char *named_by, long long name) const;
  MeshFile &mesh() { return mesh_; }

  /// Resolves node numbers. Throws std::invalid_argument if a node is missing, if there are solid
  /// cells other than hexahedra, or neither hexahedra nor quadrilaterals.
  MeshFile finish();

private:
  struct Hexahedron {
    long long number;
    std::array<long long, 8> nodes;
  };
  struct Face {
    std::array<long long, 4> nodes;
    std::size_t group;
  };
  struct Quadrilateral {
    long long number;
    std::array<long long, 4> nodes;
  };
  struct Edge {
    std::array<long long, 2> nodes;
    FaceGroup group;
  };
  static void check_number(long long number);
  std::size_t count(CellKind kind) const;
  void check_kinds() const;
  void finish_plane();
  void finish_volumes(const std::unordered_map<long long, unsigned int> &hexahedra);

  std::string node_word_;
  MeshFile mesh_;
  std::unordered_map<long long, unsigned int> node_index_;
  std::vector<Hexahedron> hexahedra_;
  std::vector<Face> faces_;
  std::vector<Quadrilateral> quadrilaterals_;
  std::vector<Edge> edges_;
  std::vector<std::pair<std::size_t, long long>> volume_members_;
  std::map<CellKind, std::size_t> n_cells_;
  std::map<std::tuple<std::string, unsigned int, std::string>, std::size_t> group_index_;
  std::map<std::pair<std::string, unsigned int>, std::size_t> volume_index_;
};

} // namespace billet

#endif
