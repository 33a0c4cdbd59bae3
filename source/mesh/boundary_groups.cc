// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mesh/boundary_groups.h"

#include "billet/mesh/mesh_cursor.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <stdexcept>

namespace billet {

namespace {

/// Face of a hexahedron: corners in ascending order, the one opposite to the first, and the
/// hexahedron.
struct SidedFace {
  BoundaryGroups::Face nodes;
  unsigned int opposite, element;
};

bool has_letter(const std::string &name) {
  return std::any_of(name.begin(), name.end(), [](const char c) {
    return std::isalpha(static_cast<unsigned char>(c)) != 0 || static_cast<unsigned char>(c) > 127;
  });
}

/// Names of a mesh file as a scene writes them. Two names of the file have different ones.
class WritableNames {
public:
  explicit WritableNames(const std::vector<FaceGroup> &groups) {
    for (const FaceGroup &group : groups)
      if (writable_name(group.name) == group.name)
        written_.emplace(group.name, group.name);
  }
  std::string operator()(const std::string &name) {
    std::string written = writable_name(name);
    while (written_.emplace(written, name).first->second != name)
      written += '_';
    return written;
  }

private:
  std::map<std::string, std::string> written_; ///< name of the file for each of them
};

void add_once(std::vector<unsigned int> &ids, const unsigned int id) {
  if (std::count(ids.begin(), ids.end(), id) == 0)
    ids.push_back(id);
}

} // namespace

std::string writable_name(const std::string &name) {
  std::string written(trimmed(name));
  for (char &c : written)
    if (std::string(",;#\\").find(c) != std::string::npos)
      c = '_';
  const bool is_clear = has_letter(written) ? lower_case(written) != "all" : id_of_name(written).has_value();
  return is_clear ? written : "name " + written;
}

std::optional<unsigned int> id_of_name(const std::string &name) {
  constexpr long long max_id = 999999999; // as in scenes; 0 are faces in no group
  long long value = 0;
  const bool has_digits_only = name.find_first_not_of("0123456789") == std::string::npos;
  if (!has_digits_only || !is_integer(name, value) || value == 0 || value > max_id)
    return std::nullopt;
  return static_cast<unsigned int>(value);
}

void BoundaryGroups::find_exterior(const MeshFile &mesh) {
  std::vector<SidedFace> all;
  all.reserve(6 * mesh.hexahedra.size());
  for (unsigned int e = 0; e < mesh.hexahedra.size(); ++e)
    for (const auto &corners : hexahedron_faces) {
      SidedFace face{{}, 0, e};
      for (unsigned int i = 0; i < 4; ++i)
        face.nodes[i] = mesh.hexahedra[e].nodes[corners[i]];
      const auto first = std::min_element(face.nodes.begin(), face.nodes.end()) - face.nodes.begin();
      face.opposite = face.nodes[static_cast<std::size_t>((first + 2) % 4)];
      std::sort(face.nodes.begin(), face.nodes.end());
      all.push_back(face);
    }
  std::sort(all.begin(), all.end(), [](const SidedFace &a, const SidedFace &b) {
    return a.nodes != b.nodes ? a.nodes < b.nodes : a.element < b.element;
  });
  const auto number = [&](const SidedFace &face) {
    return std::to_string(mesh.hexahedra[face.element].number);
  };
  for (std::size_t i = 0; i < all.size();) {
    std::size_t end = i + 1;
    while (end < all.size() && all[end].nodes == all[i].nodes)
      ++end;
    if (end - i > 2)
      throw std::invalid_argument("elements " + number(all[i]) + ", " + number(all[i + 1]) + " and " +
                                  number(all[i + 2]) + " of it share one face; allowed are two");
    if (end - i == 2 && all[i].opposite != all[i + 1].opposite)
      throw std::invalid_argument("elements " + number(all[i]) + " and " + number(all[i + 1]) +
                                  " of it have the same corners on a face, but in another order around it");
    if (end - i == 1) {
      faces_.push_back(all[i].nodes);
      elements_.push_back(all[i].element);
    }
    i = end;
  }
}

std::size_t BoundaryGroups::index(const Face &face) const {
  const auto found = std::lower_bound(faces_.begin(), faces_.end(), face);
  return found != faces_.end() && *found == face ? static_cast<std::size_t>(found - faces_.begin())
                                                 : faces_.size();
}

BoundaryGroups::BoundaryGroups(const MeshFile &mesh, const unsigned int min_new_id) : new_id_(min_new_id) {
  find_exterior(mesh);
  std::vector<std::vector<unsigned int>> groups_of_face(faces_.size());
  const auto add = [&](const std::size_t face, const std::size_t group) {
    if (face < faces_.size())
      groups_of_face[face].push_back(static_cast<unsigned int>(group));
  };
  for (const GroupedFace &face : mesh.faces) {
    Face nodes = face.nodes;
    std::sort(nodes.begin(), nodes.end());
    add(index(nodes), face.group);
  }
  if (!mesh.node_sets.empty()) {
    // Each face with its node in the set is found four times if all its nodes are.
    std::vector<std::vector<std::size_t>> faces_at(mesh.positions.size());
    for (std::size_t f = 0; f < faces_.size(); ++f)
      for (const unsigned int node : faces_[f])
        faces_at[node].push_back(f);
    std::vector<std::size_t> set_of_node(mesh.positions.size(), mesh.node_sets.size());
    for (std::size_t s = 0; s < mesh.node_sets.size(); ++s) {
      for (const unsigned int node : mesh.node_sets[s].members)
        set_of_node[node] = s;
      for (const unsigned int node : mesh.node_sets[s].members)
        for (const std::size_t f : faces_at[node])
          if (faces_[f][0] == node && std::all_of(faces_[f].begin(), faces_[f].end(),
                                                  [&](const unsigned int n) { return set_of_node[n] == s; }))
            add(f, mesh.node_sets[s].group);
    }
  }
  if (!mesh.element_sets.empty()) {
    std::vector<std::vector<std::size_t>> faces_of(mesh.hexahedra.size());
    for (std::size_t f = 0; f < faces_.size(); ++f)
      faces_of[elements_[f]].push_back(f);
    for (const GroupedSet &set : mesh.element_sets)
      for (const unsigned int element : set.members)
        for (const std::size_t f : faces_of[element])
          add(f, set.group);
  }
  for (auto &groups : groups_of_face) {
    std::sort(groups.begin(), groups.end());
    groups.erase(std::unique(groups.begin(), groups.end()), groups.end());
  }
  assign_ids(groups_of_face, mesh);
}

void BoundaryGroups::assign_ids(const std::vector<std::vector<unsigned int>> &groups_of_face,
                                const MeshFile &mesh) {
  for (const FaceGroup &group : mesh.groups)
    if (group.number != FaceGroup::no_number)
      new_id_ = std::max(new_id_, group.number);
  ++new_id_;
  std::map<std::vector<unsigned int>, unsigned int> id_of{{{}, 0}};
  for (const auto &groups : groups_of_face)
    id_of.emplace(groups, FaceGroup::no_number);
  std::set<unsigned int> taken{0};
  for (auto &[groups, id] : id_of)
    if (groups.size() == 1 && mesh.groups[groups[0]].number != FaceGroup::no_number)
      taken.insert(id = mesh.groups[groups[0]].number);
  // Faces in several groups get the number of the first that is no other's id, or a new one.
  for (auto &[groups, id] : id_of) {
    for (std::size_t i = 0; i < groups.size() && id == FaceGroup::no_number; ++i)
      if (mesh.groups[groups[i]].number != FaceGroup::no_number &&
          taken.insert(mesh.groups[groups[i]].number).second)
        id = mesh.groups[groups[i]].number;
    if (id == FaceGroup::no_number)
      id = new_id_++;
  }
  ids_.reserve(faces_.size());
  for (const auto &groups : groups_of_face)
    ids_.push_back(id_of.at(groups));
  std::vector<std::vector<unsigned int>> ids_of_group(mesh.groups.size());
  if (std::count(ids_.begin(), ids_.end(), 0U) > 0)
    add_once(names_.ids_of_number[0], 0);
  for (const auto &[groups, id] : id_of)
    for (const unsigned int g : groups)
      add_once(ids_of_group[g], id);
  const std::set<std::size_t> qualified = qualify_names(mesh, ids_of_group);
  WritableNames written(mesh.groups);
  for (std::size_t g = 0; g < mesh.groups.size(); ++g) {
    const FaceGroup &group = mesh.groups[g];
    const bool has_long_name = qualified.count(g) > 0;
    if (!group.name.empty()) {
      auto &named = names_.ids_of_name[written(has_long_name ? group.kind + " " + group.name : group.name)];
      for (const unsigned int id : ids_of_group[g])
        add_once(named, id);
    }
    if (group.number != FaceGroup::no_number && !(has_long_name && id_of_name(group.name)))
      for (const unsigned int id : ids_of_group[g])
        add_once(names_.ids_of_number[group.number], id);
  }
  name_numbers(mesh, ids_of_group);
}

/// Lets numbers that are names of groups with other numbers stand for these. Where another group
/// has the number, both need a word in front of it.
void BoundaryGroups::name_numbers(const MeshFile &mesh,
                                  const std::vector<std::vector<unsigned int>> &ids_of_group) {
  std::map<unsigned int, std::vector<unsigned int>> ids_of_name;
  for (std::size_t g = 0; g < mesh.groups.size(); ++g)
    if (const std::optional<unsigned int> id = id_of_name(mesh.groups[g].name);
        id && mesh.groups[g].kind.empty() && mesh.groups[g].number != *id)
      for (const unsigned int face_id : ids_of_group[g])
        add_once(ids_of_name[*id], face_id);
  for (const auto &[number, ids] : ids_of_name) {
    const auto [numbered, is_new] = names_.ids_of_number.emplace(number, ids);
    if (is_new || numbered->second == ids)
      continue;
    const std::string digits = std::to_string(number);
    names_.ids_of_name["name " + digits] = ids;
    names_.ids_of_name["number " + digits] = numbered->second;
    names_.ambiguous[digits] = {"name " + digits, "number " + digits};
  }
}

/// Finds the groups whose names need their kind in front of them.
std::set<std::size_t>
BoundaryGroups::qualify_names(const MeshFile &mesh,
                              const std::vector<std::vector<unsigned int>> &ids_of_group) {
  std::map<std::string, std::vector<std::size_t>> groups_of_name;
  std::set<std::size_t> qualified;
  for (std::size_t g = 0; g < mesh.groups.size(); ++g) {
    const FaceGroup &group = mesh.groups[g];
    if (group.kind.empty())
      continue;
    const std::optional<unsigned int> id = id_of_name(group.name);
    if (!id && !has_letter(group.name))
      qualified.insert(g); // a scene would read it as a number
    else if (!ids_of_group[g].empty())
      groups_of_name[id ? std::to_string(*id) : lower_case(group.name)].push_back(g);
  }
  for (const auto &[name, groups] : groups_of_name)
    if (std::any_of(groups.begin(), groups.end(),
                    [&](const std::size_t g) { return ids_of_group[g] != ids_of_group[groups[0]]; }))
      for (const std::size_t g : groups) {
        qualified.insert(g);
        names_.ambiguous[name].push_back(writable_name(mesh.groups[g].kind + " " + mesh.groups[g].name));
      }
  return qualified;
}

unsigned int BoundaryGroups::id(const Face &face) const {
  const std::size_t i = index(face);
  return i < faces_.size() ? ids_[i] : 0;
}

} // namespace billet
