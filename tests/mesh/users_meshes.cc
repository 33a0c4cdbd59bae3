// SPDX-License-Identifier: LGPL-2.1-or-later
// Meshes as users have them, by Gmsh in all formats that it writes, and of decks for CalculiX: read alike
// (elements, nodes, volume, areas of named faces) or refused with the reason. Two-dimensional meshes
// (section_*) are read as a layer; area and lengths are expected. make_users_meshes.py makes them, and what
// is expected, by Gmsh and meshio.
#include "mesh_measures.h"
#include "samples.h"

namespace users_meshes_test {

using namespace billet;
using namespace billet::testing;

namespace {

std::string text_of(const std::string &name) {
  std::ifstream stream(std::string(SOURCE_DIR) + "/users/" + name, std::ios::binary);
  if (!stream)
    throw std::invalid_argument("'" + name + "' is no file that can be read");
  std::ostringstream buffer;
  buffer << stream.rdbuf();
  return buffer.str();
}

/// What a file holds by expected.txt: sizes and areas, or part of the message.
struct Expected {
  std::string name, message;
  std::size_t n_elements = 0, n_nodes = 0;
  double volume = 0.;
  std::vector<std::pair<std::string, double>> areas;
};

std::vector<Expected> expected_meshes() {
  std::vector<Expected> all;
  std::istringstream text(text_of("expected.txt"));
  for (std::string line; std::getline(text, line);) {
    std::istringstream words(line);
    if (line.front() == ' ') {
      double area = 0.;
      std::string group;
      words >> area >> std::ws;
      std::getline(words, group);
      all.back().areas.emplace_back(group, area);
      continue;
    }
    all.emplace_back();
    Expected &mesh = all.back();
    words >> mesh.name;
    if (line.find(" refused ") != std::string::npos)
      mesh.message = line.substr(line.find(" refused ") + 9);
    else
      words >> mesh.n_elements >> mesh.n_nodes >> mesh.volume;
  }
  return all;
}

/// Files have 9 digits at least, from which areas and volumes have some less.
bool near(const double a, const double b) { return std::abs(a - b) <= 1e-7 * std::abs(b); }

/// Compares a mesh, of which `n_layers` nodes stand for one of the file and whose measures are `height` times
/// those of the file; prints what differs.
bool is_as_expected(const MeshFile &mesh, const Expected &expected, const std::size_t n_layers = 1,
                    const double height = 1.) {
  const auto agrees = [&](const std::string &what, const double found, const double wanted) {
    if (!near(found, wanted))
      std::cout << expected.name << ": " << what << " " << found << ", not " << wanted << std::endl;
    return near(found, wanted);
  };
  const auto count = [](const std::size_t n) { return static_cast<double>(n); };
  bool holds = agrees("elements", count(mesh.hexahedra.size()), count(expected.n_elements));
  holds = agrees("nodes", count(mesh.positions.size()), count(n_layers * expected.n_nodes)) && holds;
  holds = agrees("volume", volume(mesh) / height, expected.volume) && holds;
  const BoundaryGroups groups(mesh);
  for (const auto &[name, wanted] : expected.areas)
    holds = agrees(name, area(mesh, groups, ids_of(groups, name)) / height, wanted) && holds;
  return holds;
}

bool is_as_expected_of_section(const MeshFile &mesh, const Expected &expected) {
  return is_as_expected(mesh, expected, 2, mesh.positions.back()[2]);
}

} // namespace

BILLET_TEST(users_meshes) {
  std::size_t n_refused = 0;
  const auto all = expected_meshes();
  for (const Expected &expected : all) {
    std::string message;
    bool holds = false;
    try {
      const bool is_section = expected.name.rfind("section_", 0) == 0;
      const std::string text = text_of(expected.name);
      MeshFile mesh = is_section ? parse_plane_mesh(text, &text_of) : parse_mesh(text, &text_of);
      mend_and_check(mesh, DoubledNodes::refused, 0.);
      holds = expected.message.empty() &&
              (is_section ? is_as_expected_of_section(mesh, expected) : is_as_expected(mesh, expected));
    } catch (const std::invalid_argument &error) {
      message = error.what();
      holds = !expected.message.empty() && message.find(expected.message) != std::string::npos;
      ++n_refused;
    }
    if (!holds && !message.empty())
      std::cout << expected.name << ": " << message << std::endl;
    check(expected.name, holds);
  }
  check("sixty meshes and more", all.size() >= 60 && n_refused >= 10);
}

} // namespace users_meshes_test
