// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_TESTS_STL_MESHES_H
#define BILLET_TESTS_STL_MESHES_H

#include "billet/geometry/triangle_mesh.h"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>

namespace billet::testing {

/// A unit sphere: an icosahedron, each facet cut into four `levels` times.
inline TriangleMesh icosphere(const unsigned int levels) {
  const double t = 0.5 * (1. + std::sqrt(5.));
  TriangleMesh mesh;
  mesh.points = {dealii::Tensor<1, 3>({-1., t, 0.}),  dealii::Tensor<1, 3>({1., t, 0.}),
                 dealii::Tensor<1, 3>({-1., -t, 0.}), dealii::Tensor<1, 3>({1., -t, 0.}),
                 dealii::Tensor<1, 3>({0., -1., t}),  dealii::Tensor<1, 3>({0., 1., t}),
                 dealii::Tensor<1, 3>({0., -1., -t}), dealii::Tensor<1, 3>({0., 1., -t}),
                 dealii::Tensor<1, 3>({t, 0., -1.}),  dealii::Tensor<1, 3>({t, 0., 1.}),
                 dealii::Tensor<1, 3>({-t, 0., -1.}), dealii::Tensor<1, 3>({-t, 0., 1.})};
  mesh.facets = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                 {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                 {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (unsigned int level = 0; level < levels; ++level) {
    std::map<std::pair<unsigned int, unsigned int>, unsigned int> middles;
    const auto middle = [&](const unsigned int a, const unsigned int b) {
      const auto next = static_cast<unsigned int>(mesh.points.size());
      const auto [entry, is_new] = middles.emplace(std::minmax(a, b), next);
      if (is_new)
        mesh.points.push_back(mesh.points[a] + mesh.points[b]);
      return entry->second;
    };
    std::vector<std::array<unsigned int, 3>> facets;
    for (const auto &[a, b, c] : mesh.facets) {
      const unsigned int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      facets.insert(facets.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.facets = facets;
    for (auto &point : mesh.points)
      point /= point.norm();
  }
  return mesh;
}

/// Points (radius, height) of a polygon revolved about the z axis, each side cut into two triangles; a point
/// on the axis makes a fan. The outside is on the right of the polygon. `part`: of the whole circle.
inline TriangleMesh revolve(const std::vector<std::array<double, 2>> &polygon, const unsigned int n_around,
                            const double part = 1.) {
  TriangleMesh mesh;
  const auto n = static_cast<unsigned int>(polygon.size());
  for (unsigned int i = 0; i <= n_around; ++i)
    for (const auto &[radius, height] : polygon) {
      const double angle = i == n_around && part == 1. ? 0. : 2. * M_PI * part * i / n_around;
      mesh.points.push_back(
          dealii::Tensor<1, 3>({radius * std::cos(angle), radius * std::sin(angle), height}));
    }
  for (unsigned int i = 0; i < n_around; ++i)
    for (unsigned int j = 0; j + 1 < n; ++j) {
      const unsigned int a = i * n + j, b = a + n;
      if (polygon[j][0] > 0.)
        mesh.facets.push_back({a, b, a + 1});
      if (polygon[j + 1][0] > 0.)
        mesh.facets.push_back({b, b + 1, a + 1});
    }
  return mesh;
}

inline TriangleMesh torus(const double ring, const double tube, const unsigned int n) {
  std::vector<std::array<double, 2>> polygon;
  for (unsigned int i = 0; i <= n; ++i) {
    const double angle = i == n ? 0. : 2. * M_PI * i / n;
    polygon.push_back({ring + tube * std::cos(angle), tube * std::sin(angle)});
  }
  return revolve(polygon, static_cast<unsigned int>(n * (ring + tube) / tube / 2.));
}

/// A cube from −1 to 1.
inline TriangleMesh cube() {
  TriangleMesh mesh;
  for (unsigned int i = 0; i < 8; ++i)
    mesh.points.push_back(dealii::Tensor<1, 3>({i & 1U ? 1. : -1., i & 2U ? 1. : -1., i & 4U ? 1. : -1.}));
  mesh.facets = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// All digits; normals are zero.
inline void write_ascii(const TriangleMesh &mesh, const std::string &name) {
  std::ofstream file(name);
  file.precision(17);
  file << "solid of a test\n";
  for (const auto &facet : mesh.facets) {
    file << "facet normal 0 0 0\n outer loop\n";
    for (const unsigned int point : facet)
      file << "  vertex " << mesh.points[point] << "\n";
    file << " endloop\nendfacet\n";
  }
  file << "endsolid of a test\n";
}

/// In single precision, little end first.
inline void write_binary(const TriangleMesh &mesh, const std::string &name) {
  std::ofstream file(name, std::ios::binary);
  const auto write = [&file](const std::uint32_t bits, const unsigned int n_bytes) {
    for (unsigned int i = 0; i < n_bytes; ++i)
      file.put(static_cast<char>((bits >> (8 * i)) & 0xffU));
  };
  file << std::string("solid, though binary").append(60, ' ');
  write(static_cast<std::uint32_t>(mesh.facets.size()), 4);
  for (const auto &facet : mesh.facets) {
    for (unsigned int i = 0; i < 3; ++i)
      write(0, 4);
    for (const unsigned int point : facet)
      for (unsigned int i = 0; i < 3; ++i) {
        const auto value = static_cast<float>(mesh.points[point][i]);
        std::uint32_t bits = 0;
        std::memcpy(&bits, &value, 4);
        write(bits, 4);
      }
    write(0, 2);
  }
}

} // namespace billet::testing

#endif
