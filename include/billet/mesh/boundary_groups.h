// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_MESH_BOUNDARY_GROUPS_H
#define BILLET_MESH_BOUNDARY_GROUPS_H

#include "billet/mesh/mesh_file.h"

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace billet {

/// Boundary ids that numbers and names of groups stand for.
struct BoundaryNames {
  std::map<std::string, std::vector<unsigned int>> ids_of_name;
  std::map<unsigned int, std::vector<unsigned int>> ids_of_number;
};

/// The same, and the names that do not tell which group is meant.
struct GroupNames : BoundaryNames {
  /// Names, in lower case, and numbers that groups of several kinds have with different faces. Each
  /// has the names of these groups in `ids_of_name`, such as "surface top" and "nset top".
  std::map<std::string, std::vector<std::string>> ambiguous;
};

/// Nodes of the faces of a hexahedron, in turn around each.
constexpr unsigned int hexahedron_faces[6][4] = {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                                 {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

/// Returns a name of a file as a scene can write it. It has '_' for commas, semicolons, backslashes
/// and the sign of comments. It has "name" in front of it if it is "all", or has no letter and is
/// no boundary id.
std::string writable_name(const std::string &name);

/// Returns the boundary id that a scene means if it writes the name of a group; none if it is no
/// such number.
std::optional<unsigned int> id_of_name(const std::string &name);

/// Boundary ids of the exterior faces of a mesh. A face has one id but may be in several groups.
/// Faces that are in the same groups share an id, and a group stands for the ids of all its faces.
/// A face in one group with a number has this number as its id; one in no group has id 0.
///
/// Groups of different kinds may have one name. It stands for all of them if their faces are the
/// same. Otherwise it needs the kind in front of it. A name is the one of the file as
/// writable_name() gives it, with '_' behind it if another group has it.
class BoundaryGroups {
public:
  /// Nodes of a face in ascending order.
  using Face = std::array<unsigned int, 4>;

  /// Ids that groups do not have are above all their numbers and above `min_new_id`. Throws
  /// std::invalid_argument if faces of hexahedra do not fit each other.
  explicit BoundaryGroups(const MeshFile &mesh, unsigned int min_new_id = 1000);

  /// Returns the id of an exterior face; 0 for others.
  unsigned int id(const Face &face) const;
  const GroupNames &names() const { return names_; }
  /// Returns an id that no face and no group has.
  unsigned int new_id() const { return new_id_; }

private:
  void find_exterior(const MeshFile &mesh);
  std::size_t index(const Face &face) const;
  std::set<std::size_t> qualify_names(const MeshFile &mesh,
                                      const std::vector<std::vector<unsigned int>> &ids_of_group);
  void name_numbers(const MeshFile &mesh, const std::vector<std::vector<unsigned int>> &ids_of_group);
  void assign_ids(const std::vector<std::vector<unsigned int>> &groups_of_face, const MeshFile &mesh);

  std::vector<Face> faces_; ///< exterior, sorted
  std::vector<unsigned int> elements_, ids_;
  GroupNames names_;
  unsigned int new_id_;
};

} // namespace billet

#endif
