// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_SAMPLES_H
#define BILLET_TESTS_SAMPLES_H

#include "../checks.h"

#include "billet/mesh/boundary_groups.h"
#include "billet/mesh/mesh_checks.h"
#include "billet/mesh/mesh_file.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace billet::testing {

inline const std::vector<std::string> &samples() {
  static const std::vector<std::string> names{
      "msh1.msh",         "msh2.msh",      "msh2_binary.msh", "msh40.msh",         "msh41.msh",
      "msh41_binary.msh", "no_groups.msh", "legacy.vtk",      "legacy_binary.vtk", "meshio5.vtk",
      "gmsh.inp",         "part.inp",      "block.ucd"};
  return names;
}

inline std::string path(const std::string &name) { return std::string(SOURCE_DIR) + "/files/" + name; }

inline std::string read_text(const std::string &name) {
  std::ifstream stream(path(name), std::ios::binary);
  std::ostringstream buffer;
  buffer << stream.rdbuf();
  return buffer.str();
}

/// The only file that a sample may include.
inline std::string access_sample(const std::string &name) {
  if (name != "nodes.inc")
    throw std::invalid_argument("'" + name + "' is no file that can be read");
  return read_text(name);
}

/// Returns the mesh, as a scene would use it.
inline MeshFile load(const std::string &bytes, const DoubledNodes doubled = DoubledNodes::refused,
                     const double distance = 0.) {
  MeshFile mesh = parse_mesh(bytes, &access_sample);
  mend_and_check(mesh, doubled, distance);
  return mesh;
}

/// Returns the message with which a mesh is refused; nothing if it is accepted.
inline std::string refusal(const std::string &bytes, const DoubledNodes doubled = DoubledNodes::refused,
                           const double distance = 0.) {
  try {
    const MeshFile mesh = load(bytes, doubled, distance);
    const BoundaryGroups groups(mesh);
  } catch (const std::invalid_argument &error) {
    return error.what();
  }
  return "";
}

} // namespace billet::testing

#endif
