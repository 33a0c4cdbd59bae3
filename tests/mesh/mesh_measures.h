// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_MESH_MEASURES_H
#define BILLET_TESTS_MESH_MEASURES_H

#include "billet/mesh/boundary_groups.h"
#include "billet/mesh/mesh_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace billet::testing {

using Position = std::array<double, 3>;

inline Position cross(const Position &a, const Position &b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline Position minus(const Position &a, const Position &b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline double dot(const Position &a, const Position &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Returns the volume of all hexahedra: two points of Gauss along each axis are exact.
inline double volume(const MeshFile &mesh) {
  constexpr int signs[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                               {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
  const double gauss = 1. / std::sqrt(3.);
  double sum = 0.;
  for (const auto &hexahedron : mesh.hexahedra)
    for (const auto &point : signs) {
      std::array<Position, 3> tangents{};
      for (unsigned int n = 0; n < 8; ++n)
        for (unsigned int a = 0; a < 3; ++a) {
          double slope = signs[n][a] / 8.;
          for (const unsigned int b : {(a + 1) % 3, (a + 2) % 3})
            slope *= 1. + signs[n][b] * gauss * point[b];
          for (unsigned int d = 0; d < 3; ++d)
            tangents[a][d] += slope * mesh.positions[hexahedron.nodes[n]][d];
        }
      sum += dot(cross(tangents[0], tangents[1]), tangents[2]);
    }
  return sum;
}

/// Returns the area of all exterior faces with one of these ids, as their diagonals span it.
inline double area(const MeshFile &mesh, const BoundaryGroups &groups, const std::vector<unsigned int> &ids) {
  constexpr unsigned int faces[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                        {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  std::map<BoundaryGroups::Face, unsigned int> n_elements;
  double sum = 0.;
  for (const bool adds : {false, true})
    for (const auto &hexahedron : mesh.hexahedra)
      for (const auto &face : faces) {
        BoundaryGroups::Face nodes{};
        std::array<Position, 4> x{};
        for (unsigned int i = 0; i < 4; ++i) {
          nodes[i] = hexahedron.nodes[face[i]];
          x[i] = mesh.positions[nodes[i]];
        }
        std::sort(nodes.begin(), nodes.end());
        if (!adds)
          ++n_elements[nodes];
        else if (n_elements[nodes] == 1 && std::count(ids.begin(), ids.end(), groups.id(nodes)) > 0) {
          const Position normal = cross(minus(x[2], x[0]), minus(x[3], x[1]));
          sum += 0.5 * std::sqrt(dot(normal, normal));
        }
      }
  return sum;
}

/// Returns the ids that a name or a number stands for; none if it is unknown.
inline std::vector<unsigned int> ids_of(const BoundaryGroups &groups, const std::string &name) {
  const auto &names = groups.names().ids_of_name;
  const auto &numbers = groups.names().ids_of_number;
  const bool is_number = name.find_first_not_of("0123456789") == std::string::npos;
  if (is_number && numbers.count(static_cast<unsigned int>(std::stoul(name))) > 0)
    return numbers.at(static_cast<unsigned int>(std::stoul(name)));
  return !is_number && names.count(name) > 0 ? names.at(name) : std::vector<unsigned int>();
}

} // namespace billet::testing

#endif
