// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/mesh/mesh_volumes.h"

#include "billet/mesh/boundary_groups.h"
#include "billet/mesh/mesh_cursor.h"
#include "billet/nearest_name.h"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

namespace billet {

namespace {

/// Returns the names of all volumes, separated by commas.
std::string list_names(const std::vector<MeshVolume> &volumes) {
  std::string list;
  for (const MeshVolume &volume : volumes)
    list += (list.empty() ? "" : ", ") + name_of(volume);
  return list;
}

/// Returns the volumes that a scene means by a name. They are those with this name, with it in
/// other letters, or with this number. The first of these ways that finds one counts.
std::vector<std::size_t> find_volumes(const std::vector<MeshVolume> &volumes, const std::string &name) {
  long long number = -1;
  if (!is_integer(name, number))
    number = -1;
  std::vector<std::size_t> exact, similar, numbered;
  for (std::size_t v = 0; v < volumes.size(); ++v)
    if (name_of(volumes[v]) == name)
      exact.push_back(v);
    else if (lower_case(name_of(volumes[v])) == lower_case(name))
      similar.push_back(v);
    else if (number >= 0 && volumes[v].number != FaceGroup::no_number && volumes[v].number == number)
      numbered.push_back(v);
  return !exact.empty() ? exact : !similar.empty() ? similar : numbered;
}

[[noreturn]] void refuse_name(const std::vector<MeshVolume> &volumes, const std::string &name) {
  if (volumes.empty())
    throw std::invalid_argument("names volume '" + name +
                                "', but the file has no volumes; allowed is no value, which takes all of it");
  std::vector<std::string> known;
  for (const MeshVolume &volume : volumes)
    known.push_back(name_of(volume));
  throw std::invalid_argument("names volume '" + name + "'; allowed are the volumes of the file: " +
                              list_names(volumes) + did_you_mean(name, known));
}

/// Adds groups of the faces between hexahedra that are taken and others.
void add_interfaces(MeshFile &mesh, const VolumeChoice &choice) {
  std::map<std::string, std::size_t> groups;
  for (const FaceGroup &group : mesh.groups)
    groups.emplace(lower_case(group.name), FaceGroup::no_number);
  // A group of the file with the same name keeps it.
  const auto add = [&](const GroupedFace &face, const std::string &name) {
    const auto [found, is_new] = groups.emplace(lower_case(name), mesh.groups.size());
    if (is_new)
      mesh.groups.push_back({name, FaceGroup::no_number});
    if (found->second != FaceGroup::no_number)
      mesh.faces.push_back({face.nodes, found->second});
  };
  std::vector<std::vector<std::size_t>> volumes_of(mesh.hexahedra.size());
  for (std::size_t v = 0; v < choice.volumes.size(); ++v)
    for (const unsigned int hexahedron : choice.volumes[v].members)
      volumes_of[hexahedron].push_back(v);
  std::map<BoundaryGroups::Face, GroupedFace> taken_faces;
  for (const bool is_second_pass : {false, true})
    for (std::size_t e = 0; e < mesh.hexahedra.size(); ++e) {
      if (choice.is_taken[e] == is_second_pass)
        continue;
      for (const auto &corners : hexahedron_faces) {
        GroupedFace face{{}, 0};
        for (unsigned int i = 0; i < 4; ++i)
          face.nodes[i] = mesh.hexahedra[e].nodes[corners[i]];
        BoundaryGroups::Face key = face.nodes;
        std::sort(key.begin(), key.end());
        if (!is_second_pass) {
          taken_faces.emplace(key, face);
          continue;
        }
        if (taken_faces.count(key) == 0)
          continue;
        add(face, "interface");
        for (const std::size_t v : volumes_of[e])
          add(face, "interface " + name_of(choice.volumes[v]));
      }
    }
}

/// Removes the hexahedra that are not taken.
void remove_others(MeshFile &mesh, const std::vector<bool> &is_taken) {
  std::vector<FileHexahedron> kept;
  std::vector<unsigned int> new_index(is_taken.size());
  for (std::size_t e = 0; e < is_taken.size(); ++e) {
    new_index[e] = static_cast<unsigned int>(kept.size());
    if (is_taken[e])
      kept.push_back(mesh.hexahedra[e]);
  }
  mesh.hexahedra = std::move(kept);
  const auto select = [&](const std::vector<unsigned int> &members) {
    std::vector<unsigned int> selected;
    for (const unsigned int member : members)
      if (is_taken[member])
        selected.push_back(new_index[member]);
    return selected;
  };
  for (GroupedSet &set : mesh.element_sets)
    set.members = select(set.members);
  for (MeshVolume &volume : mesh.volumes)
    volume.members = select(volume.members);
}

} // namespace

std::string name_of(const MeshVolume &volume) {
  return volume.name.empty() ? std::to_string(volume.number) : writable_name(volume.name);
}

VolumeChoice choose_volumes(MeshFile &mesh, const std::vector<std::string> &names) {
  VolumeChoice choice{{}, std::vector<bool>(mesh.hexahedra.size(), names.empty())};
  for (const MeshVolume &volume : mesh.volumes)
    if (!volume.members.empty())
      choice.volumes.push_back(volume);
  for (const std::string &name : names) {
    const std::vector<std::size_t> found = find_volumes(choice.volumes, name);
    if (found.empty())
      refuse_name(choice.volumes, name);
    for (const std::size_t v : found)
      for (const unsigned int hexahedron : choice.volumes[v].members)
        choice.is_taken[hexahedron] = true;
  }
  if (std::find(choice.is_taken.begin(), choice.is_taken.end(), false) != choice.is_taken.end()) {
    add_interfaces(mesh, choice);
    remove_others(mesh, choice.is_taken);
  }
  return choice;
}

std::vector<std::string> separate_parts(const VolumeChoice &choice) {
  std::vector<std::string> names;
  std::vector<bool> is_in_part(choice.is_taken.size(), false);
  for (const MeshVolume &volume : choice.volumes) {
    const auto is_free = [&](const unsigned int hexahedron) { return !is_in_part[hexahedron]; };
    if (!volume.is_part || !std::all_of(volume.members.begin(), volume.members.end(), is_free))
      continue;
    names.push_back(name_of(volume));
    for (const unsigned int hexahedron : volume.members)
      is_in_part[hexahedron] = true;
  }
  return names.size() > 1 ? names : std::vector<std::string>();
}

UntakenVolumes find_untaken(const std::vector<VolumeChoice> &choices) {
  std::vector<bool> is_taken(choices.front().is_taken.size(), false), is_named = is_taken;
  for (const VolumeChoice &choice : choices)
    for (std::size_t e = 0; e < is_taken.size(); ++e)
      is_taken[e] = is_taken[e] || choice.is_taken[e];
  UntakenVolumes untaken;
  for (const MeshVolume &volume : choices.front().volumes) {
    const auto is_free = [&](const unsigned int hexahedron) { return !is_taken[hexahedron]; };
    if (std::all_of(volume.members.begin(), volume.members.end(), is_free))
      untaken.names.push_back(name_of(volume));
    for (const unsigned int hexahedron : volume.members)
      is_named[hexahedron] = true;
  }
  for (std::size_t e = 0; e < is_taken.size(); ++e)
    untaken.n_unnamed += !is_taken[e] && !is_named[e] ? 1 : 0;
  return untaken;
}

} // namespace billet
