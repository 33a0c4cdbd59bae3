// SPDX-License-Identifier: LGPL-2.1-or-later
// STL files: as many facets as the file says or has, with finite corners.
#include "fuzz.h"

#include "billet/geometry/triangle_mesh.h"

#include <array>
#include <cstring>

namespace stl_test {

using namespace billet;
using namespace billet::testing;

namespace {

const std::vector<std::array<std::array<float, 3>, 3>> &tetrahedron() {
  using Facets = std::vector<std::array<std::array<float, 3>, 3>>;
  static const Facets facets{{{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}}},
                             {{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}},
                             {{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}}},
                             {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
  return facets;
}

std::string ascii() {
  std::ostringstream text;
  text << "solid part\n";
  for (const auto &facet : tetrahedron()) {
    text << "facet normal 0 0 0\n outer loop\n";
    for (const auto &x : facet)
      text << "  vertex " << x[0] << " " << x[1] << " " << x[2] << "\n";
    text << " endloop\nendfacet\n";
  }
  text << "endsolid part\n";
  return text.str();
}

std::string binary() {
  std::string bytes(84, ' ');
  const auto put = [&bytes](const std::size_t place, const auto value) {
    bytes.resize(std::max(bytes.size(), place + sizeof value));
    std::memcpy(bytes.data() + place, &value, sizeof value);
  };
  put(80, static_cast<std::uint32_t>(tetrahedron().size()));
  for (const auto &facet : tetrahedron()) {
    put(bytes.size(), std::array<float, 3>{});
    for (const auto &x : facet)
      put(bytes.size(), x);
    put(bytes.size(), std::uint16_t{0});
  }
  return bytes;
}

std::size_t n_words(const std::string &bytes, const std::string &word) {
  std::istringstream words(bytes);
  std::size_t n = 0;
  for (std::string next; words >> next;) {
    std::transform(next.begin(), next.end(), next.begin(), [](const char c) {
      return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    });
    n += next == word ? 1 : 0;
  }
  return n;
}

bool is_sound(const TriangleMesh &mesh, const std::string &bytes) {
  std::uint32_t announced = 0;
  if (bytes.size() >= 84)
    std::memcpy(&announced, bytes.data() + 80, sizeof announced);
  const bool is_binary = bytes.size() == 84 + std::size_t{50} * announced;
  bool holds = is_binary ? mesh.facets.size() == announced : mesh.facets.size() <= n_words(bytes, "endfacet");
  holds = holds && mesh.points.size() == 3 * mesh.facets.size() && !mesh.facets.empty();
  for (const auto &facet : mesh.facets)
    for (const unsigned int point : facet)
      holds = holds && point < mesh.points.size();
  for (const auto &point : mesh.points)
    for (unsigned int i = 0; i < 3; ++i)
      holds = holds && std::isfinite(point[i]);
  return holds;
}

} // namespace

std::map<std::string, std::string> corpus() { return {{"ascii.stl", ascii()}, {"binary.stl", binary()}}; }

Outcome judge(const std::string &bytes) {
  write_bytes("damaged.stl", bytes);
  try {
    const TriangleMesh mesh = read_stl("damaged.stl");
    if (!is_sound(mesh, bytes))
      return Outcome::unsound;
    const TriangleMesh welded = weld(mesh, 1e-6 * mesh.size());
    const TriangleEdges edges(welded);
    return edges.describe_open_edges(welded).empty() ? Outcome::accepted : Outcome::refused;
  } catch (const std::invalid_argument &error) {
    return is_message(error.what()) ? Outcome::refused : Outcome::unsound;
  }
}

BILLET_FUZZ_TARGET(stl)

} // namespace stl_test
