// SPDX-License-Identifier: LGPL-2.1-or-later
// Thousands of damaged mesh files, the same on every machine: each is refused with a message or accepted with
// sound indices. Sanitizers and traps see the rest. It is a fuzz target, as fuzz.h says.
#include "../fuzz/fuzz.h"
#include "samples.h"

#include "billet/mesh/mesh_volumes.h"

namespace mutations_test {

using namespace billet;
using namespace billet::testing;

namespace {

/// Whether all indices of a mesh are sound, all coordinates finite, and all groups there.
bool is_sound(const MeshFile &mesh) {
  const std::size_t n_nodes = mesh.positions.size();
  bool holds = mesh.node_numbers.size() == n_nodes && !mesh.hexahedra.empty();
  const auto is_node = [&](const unsigned int node) { return node < n_nodes; };
  for (const auto &position : mesh.positions)
    for (const double x : position)
      holds = holds && std::abs(x) <= 1e61;
  std::set<long long> numbers(mesh.node_numbers.begin(), mesh.node_numbers.end());
  holds = holds && numbers.size() == n_nodes;
  for (const auto &hexahedron : mesh.hexahedra)
    holds = holds && std::all_of(hexahedron.nodes.begin(), hexahedron.nodes.end(), is_node);
  for (const auto &face : mesh.faces)
    holds = holds && std::all_of(face.nodes.begin(), face.nodes.end(), is_node) &&
            face.group < mesh.groups.size();
  for (const auto &set : mesh.node_sets)
    holds = holds && std::all_of(set.members.begin(), set.members.end(), is_node) &&
            set.group < mesh.groups.size();
  for (const auto &set : mesh.element_sets)
    for (const unsigned int element : set.members)
      holds = holds && element < mesh.hexahedra.size() && set.group < mesh.groups.size();
  for (const auto &volume : mesh.volumes)
    for (const unsigned int element : volume.members)
      holds = holds && element < mesh.hexahedra.size();
  return holds;
}

} // namespace

std::map<std::string, std::string> corpus() {
  std::map<std::string, std::string> files;
  for (const std::string &sample : samples())
    files[sample] = read_text(sample);
  return files;
}

Outcome judge(const std::string &bytes) {
  try {
    MeshFile mesh = parse_mesh(bytes, &access_sample);
    if (!is_sound(mesh))
      return Outcome::unsound;
    if (!mesh.volumes.empty())
      choose_volumes(mesh, {name_of(mesh.volumes.front())});
    if (!is_sound(mesh))
      return Outcome::unsound;
    mend_and_check(mesh, DoubledNodes::merged, 1e-6);
    if (!is_sound(mesh))
      return Outcome::unsound;
    const BoundaryGroups groups(mesh);
    return Outcome::accepted;
  } catch (const std::invalid_argument &error) {
    // A message is short and printable.
    const std::string message = error.what();
    const bool is_text = std::all_of(message.begin(), message.end(), [](const char c) { return c >= ' '; });
    return is_text && message.size() < 2000 ? Outcome::refused : Outcome::unsound;
  }
}

/// A file that is cut short anywhere, but for white space and what no mesh needs, is refused.
inline void check_cut_files() {
  for (const auto &[name, sound] : corpus()) {
    std::size_t n_accepted = 0;
    const std::size_t end = sound.find_last_not_of(" \r\n\t");
    for (std::size_t length = 0; length < end; length += 1 + sound.size() / 300)
      n_accepted += judge(sound.substr(0, length)) == Outcome::accepted ? 1 : 0;
    const bool has_no_end = name.find(".inp") != std::string::npos || name.find(".vtk") != std::string::npos;
    check(name + " cut short", has_no_end || n_accepted == 0);
  }
}

BILLET_FUZZ_TARGET(mutations)

#ifndef BILLET_FUZZ
BILLET_TEST(cut_files) { check_cut_files(); }
#endif

} // namespace mutations_test
