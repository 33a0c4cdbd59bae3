// SPDX-License-Identifier: LGPL-2.1-or-later
// The same block of 2 x 1 x 2 in all formats: volume, and areas of faces by the names and numbers of groups.
#include "samples.h"

#include <array>
#include <map>

using namespace billet;
using namespace billet::testing;

namespace {

using Position = std::array<double, 3>;

Position cross(const Position &a, const Position &b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Position minus(const Position &a, const Position &b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

double dot(const Position &a, const Position &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

constexpr unsigned int faces[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                      {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

/// Returns the volume of parallelepipeds.
double volume(const MeshFile &mesh) {
  double sum = 0.;
  for (const auto &hexahedron : mesh.hexahedra) {
    const auto edge = [&](const unsigned int corner) {
      return minus(mesh.positions[hexahedron.nodes[corner]], mesh.positions[hexahedron.nodes[0]]);
    };
    sum += dot(cross(edge(1), edge(3)), edge(4));
  }
  return sum;
}

/// Returns the area of all faces with one of these ids.
double area(const MeshFile &mesh, const BoundaryGroups &groups, const std::vector<unsigned int> &ids) {
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

bool near(const double a, const double b) { return std::abs(a - b) < 1e-9; }

void check_areas(const std::string &sample, const std::map<std::string, double> &areas) {
  const MeshFile mesh = load(read_text(sample));
  const BoundaryGroups groups(mesh);
  for (const auto &[name, expected] : areas) {
    const auto &names = groups.names().ids_of_name;
    const auto &numbers = groups.names().ids_of_number;
    const bool is_number = name.find_first_not_of("0123456789") == std::string::npos;
    std::vector<unsigned int> ids;
    if (is_number && numbers.count(static_cast<unsigned int>(std::stoul(name))) > 0)
      ids = numbers.at(static_cast<unsigned int>(std::stoul(name)));
    else if (!is_number && names.count(name) > 0)
      ids = names.at(name);
    check(sample + " area of " + name, near(area(mesh, groups, ids), expected));
  }
}

} // namespace

int main() {
  for (const std::string &sample : samples()) {
    const MeshFile mesh = load(read_text(sample));
    check(sample + " volume", near(volume(mesh), 4.));
    check(sample + " size", mesh.hexahedra.size() == 4 && mesh.positions.size() == 18);
  }
  const std::map<std::string, double> names{{"bottom", 2.}, {"top", 2.}, {"walls", 6.}, {"corner faces", 6.}};
  const std::map<std::string, double> numbers{{"0", 6.}, {"4", 2.}, {"7", 2.}, {"9", 6.}, {"11", 6.}};
  for (const std::string sample :
       {"msh2.msh", "msh2_binary.msh", "msh40.msh", "msh41.msh", "msh41_binary.msh"}) {
    check_areas(sample, names);
    check_areas(sample, numbers);
  }
  check_areas("msh1.msh", numbers); // has no names
  check_areas("no_groups.msh", {{"0", 16.}, {"surface 1", 2.}, {"surface 26", 2.}});
  check_areas("gmsh.inp", {{"bottom", 2.}, {"top", 2.}, {"walls", 6.}, {"corner_faces", 6.}});
  check_areas(
      "part.inp",
      {{"bottom", 2.}, {"top", 2.}, {"Walls", 6.}, {"corner faces", 6.}, {"skin", 16.}, {"Nall", 16.}});
  check_areas("block.ucd", {{"0", 2.}, {"1", 2.}, {"2", 4.}, {"3", 4.}, {"4", 2.}, {"7", 2.}});
  // VTK has one number for each face: Gmsh's version of these files writes none.
  check_areas("meshio5.vtk", {{"4", 2.}});

  // A face in one group has its number as id, as ever.
  const MeshFile mesh = load(read_text("msh41.msh"));
  const BoundaryGroups groups(mesh);
  check("ids of single groups", groups.names().ids_of_number.at(4) == std::vector<unsigned int>{4} &&
                                    groups.names().ids_of_number.at(0) == std::vector<unsigned int>{0});
  const auto &walls = groups.names().ids_of_name.at("walls");
  const auto &corner = groups.names().ids_of_name.at("corner faces");
  const auto n_common = std::count_if(walls.begin(), walls.end(), [&](const unsigned int id) {
    return std::count(corner.begin(), corner.end(), id) > 0;
  });
  check("faces in two groups have an id of their own", walls.size() == 2 && n_common == 1);
  return exit_code();
}
