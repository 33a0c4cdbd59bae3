// SPDX-License-Identifier: LGPL-2.1-or-later
// The same block of 2 x 1 x 2 in all formats: volume, and areas of faces by the names and numbers of groups.
#include "mesh_measures.h"
#include "samples.h"

#include <map>

namespace formats_test {

using namespace billet;
using namespace billet::testing;

namespace {

bool near(const double a, const double b) { return std::abs(a - b) < 1e-9; }

void check_areas(const std::string &sample, const std::map<std::string, double> &areas) {
  const MeshFile mesh = load(read_text(sample));
  const BoundaryGroups groups(mesh);
  for (const auto &[name, expected] : areas) {
    check(sample + " area of " + name, near(area(mesh, groups, ids_of(groups, name)), expected));
  }
}

/// Sets and surfaces of one name, and names that are numbers.
void check_names_of_decks() {
  std::string deck = read_text("part.inp");
  const std::string end = "*End Assembly";
  const auto place = deck.find(end);
  check("the deck has an assembly", place != std::string::npos);
  if (place == std::string::npos)
    return;
  const std::string set = ", instance=Block-1, generate\n";
  deck.insert(place, "*Nset, nset=TOP" + set + "1, 6, 1\n*Nset, nset=2" + set + "1, 6, 1\n*Nset, nset=7" +
                         set + "13, 18, 1\n*Nset, nset=Skin" + set + "1, 18, 1\n*Nset, nset=1.5" + set +
                         "1, 6, 1\n");
  const MeshFile mesh = load(deck);
  const BoundaryGroups groups(mesh);
  const auto &names = groups.names();
  check("surface and set with different faces", names.ids_of_name.count("top") == 0 &&
                                                    names.ids_of_name.count("TOP") == 0 &&
                                                    names.ambiguous.at("top").size() == 2);
  check("both by their kinds", near(area(mesh, groups, names.ids_of_name.at("surface top")), 2.) &&
                                   near(area(mesh, groups, names.ids_of_name.at("nset TOP")), 2.) &&
                                   names.ids_of_name.at("surface top") != names.ids_of_name.at("nset TOP"));
  check("surface and set with the same faces", names.ids_of_name.at("skin") == names.ids_of_name.at("Skin"));
  check("numbers as names", names.ids_of_number.at(2) == names.ids_of_name.at("nset TOP") &&
                                names.ids_of_number.at(7) == names.ids_of_name.at("surface top"));
  check("a name without letters", names.ids_of_name.at("nset 1.5") == names.ids_of_number.at(2));
  check("what is not read", mesh.unread.at("static") == 1 && mesh.unread.count("nset") == 0);
}

} // namespace

BILLET_TEST(formats) {
  check_names_of_decks();
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
}

} // namespace formats_test
