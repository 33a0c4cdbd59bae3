// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MESH_MESH_FILE_H
#define BILLET_MESH_MESH_FILE_H

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace billet {

// Mesh files are read without trust. Every count is compared with the size of the file before
// memory is allocated, every index with what the file has. Readers throw std::invalid_argument,
// with a message that continues "the file ..., where it ...".

/// Eight-node hexahedron of a file: corners 0 to 3 around the bottom, 4 to 7 above them.
struct FileHexahedron {
  long long number; ///< in the file
  std::array<unsigned int, 8> nodes;
};

/// Named or numbered set of faces. A face may be in several.
struct FaceGroup {
  /// No scene can write this number: the group has a name only.
  static constexpr unsigned int no_number = 4294967294U;

  std::string name; ///< empty: a number only
  unsigned int number;
  /// Kind of thing that has this name, such as "surface", in formats where others of another kind
  /// may have it, too.
  std::string kind = {};
};

/// Quadrilateral of a file that is in a group.
struct GroupedFace {
  std::array<unsigned int, 4> nodes; ///< in turn around the face
  std::size_t group;
};

/// Set of nodes or of hexahedra, as indices. It stands for exterior faces: those with all nodes in
/// the set, or all of these hexahedra.
struct GroupedSet {
  std::vector<unsigned int> members;
  std::size_t group;
};

/// Quadrilateral of a two-dimensional mesh: corners in turn around it.
struct FileQuadrilateral {
  long long number; ///< in the file
  std::array<unsigned int, 4> nodes;
};

/// Edge of such a mesh that is in a group.
struct GroupedEdge {
  std::array<unsigned int, 2> nodes;
  std::size_t group;
};

/// Content of a file without hexahedra.
struct PlaneMesh {
  std::vector<FileQuadrilateral> quadrilaterals;
  std::vector<GroupedEdge> edges;
  std::size_t n_triangles = 0;
};

/// Volume of a file: a set of its hexahedra, as ascending indices. Volumes may overlap.
struct MeshVolume {
  std::string name;    ///< empty: a number only
  unsigned int number; ///< FaceGroup::no_number: a name only
  /// Whether the file gives it a material, or means it as a body in another way.
  bool is_part;
  std::vector<unsigned int> members = {};
};

/// Content of a mesh file: hexahedra, and which faces its groups hold.
struct MeshFile {
  std::vector<long long> node_numbers; ///< in the file
  std::vector<std::array<double, 3>> positions;
  std::vector<FileHexahedron> hexahedra;
  /// Place of each corner in deal.II's elements: which edges become which axes. Results depend on
  /// it in their last digits, so each format keeps the order that deal.II gives it.
  std::array<unsigned int, 8> corners{0, 1, 5, 4, 2, 3, 7, 6};
  std::vector<FaceGroup> groups;
  std::vector<GroupedFace> faces;
  std::vector<GroupedSet> node_sets, element_sets;
  std::vector<MeshVolume> volumes;
  /// Keywords of which nothing is read, in lower case, and how often each stands there.
  std::map<std::string, std::size_t> unread;
  PlaneMesh plane; ///< empty if there are hexahedra
};

/// Returns the content of a file that a mesh file includes. Throws std::invalid_argument.
using FileAccess = std::function<std::string(const std::string &name)>;

/// Format of mesh files.
struct MeshFormat {
  std::string name;
  std::string meaning;
  bool (*recognises)(const std::string &bytes); ///< by the content
  MeshFile (*read)(const std::string &bytes, const FileAccess &access);
};

/// Returns the table of all formats, in the order in which they are tried. A new format is one file
/// with a function that returns its MeshFormat, and one line in the table.
std::vector<MeshFormat> &mesh_formats();

MeshFormat gmsh_format();
MeshFormat vtk_format();
MeshFormat abaqus_format();
MeshFormat ucd_format();

/// Reads a mesh of hexahedra from the content of a file. Its indices are sound and each number
/// stands once.
MeshFile parse_mesh(const std::string &bytes, const FileAccess &access);
/// Reads a two-dimensional mesh, as extrude_plane() gives it.
MeshFile parse_plane_mesh(const std::string &bytes, const FileAccess &access);

/// Reads a mesh file; files that it includes are relative to its folder.
MeshFile read_mesh_file(const std::string &file_name);
/// Reads a file with a two-dimensional mesh, as extrude_plane() gives it.
MeshFile read_plane_mesh_file(const std::string &file_name);

} // namespace billet

#endif
