// SPDX-License-Identifier: LGPL-2.1-or-later
// Volumes of mesh files: which there are, what a body takes of them, the faces beside the others, and names
// that a scene can write.
#include "mesh_measures.h"
#include "samples.h"

#include "billet/mesh/mesh_volumes.h"

namespace volumes_test {

using namespace billet;
using namespace billet::testing;

namespace {

bool near(const double a, const double b) { return std::abs(a - b) <= 1e-7; }

std::string user_text(const std::string &name) {
  std::ifstream stream(std::string(SOURCE_DIR) + "/users/" + name, std::ios::binary);
  std::ostringstream buffer;
  buffer << stream.rdbuf();
  return buffer.str();
}

/// What a body has that takes some volumes.
struct Taken {
  MeshFile mesh;
  VolumeChoice choice;
};

Taken take(const std::string &text, const std::vector<std::string> &names, const bool is_plane = false) {
  Taken taken{is_plane ? parse_plane_mesh(text, &access_sample) : parse_mesh(text, &access_sample), {}};
  taken.choice = choose_volumes(taken.mesh, names);
  mend_and_check(taken.mesh, DoubledNodes::refused, 0.);
  return taken;
}

double named_area(const MeshFile &mesh, const std::string &name) {
  const BoundaryGroups groups(mesh);
  return area(mesh, groups, ids_of(groups, name));
}

std::string refused_name(const std::string &text, const std::string &name) {
  try {
    take(text, {name});
  } catch (const std::invalid_argument &error) {
    return error.what();
  }
  return "";
}

/// A block of 2 x 1 x 4, of which the lower volume has 6 and the upper one 2, in several formats.
void check_stack(const std::string &file) {
  using Names = std::vector<std::string>;
  const std::string text = user_text(file);
  const bool is_deck = file == "stack_inp.inp"; // without sections, and with sets for Gmsh's own volumes
  const Taken all = take(text, {}), lower = take(text, {"lower"}), upper = take(text, {"UPPER"});
  check(file + ": all of it",
        near(volume(all.mesh), 8.) && separate_parts(all.choice).size() == (is_deck ? 0 : 2));
  check(file + ": one volume", near(volume(lower.mesh), 6.) && near(volume(upper.mesh), 2.));
  check(file + ": both", near(volume(take(text, {"lower", "upper"}).mesh), 8.));
  check(file + ": the face between them has names", near(named_area(lower.mesh, "interface"), 2.) &&
                                                        near(named_area(lower.mesh, "interface upper"), 2.) &&
                                                        near(named_area(upper.mesh, "interface lower"), 2.) &&
                                                        near(named_area(upper.mesh, "between"), 2.) &&
                                                        near(named_area(all.mesh, "between"), 0.));
  check(file + ": a group of the other volume has no face",
        near(named_area(upper.mesh, "lid"), 2.) && near(named_area(lower.mesh, "lid"), 0.));
  const UntakenVolumes rest = find_untaken({lower.choice}), none = find_untaken({lower.choice, upper.choice});
  check(file + ": what no body takes", rest.names == (is_deck ? Names{"Volume2", "upper"} : Names{"upper"}) &&
                                           rest.n_unnamed == 0 && none.names.empty() && none.n_unnamed == 0);
  const std::string message = refused_name(text, "uper");
  check(file + ": an unknown name", message.find("names volume 'uper'") != std::string::npos &&
                                        message.find("lower, upper") != std::string::npos &&
                                        message.find("did you mean 'upper'") != std::string::npos);
}

/// Two cubes in a row, as elements 1 and 7.
std::string cubes(const std::string &more) {
  return "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n"
         "22,2,0,0\n23,2,1,0\n26,2,0,1\n27,2,1,1\n"
         "*ELEMENT, TYPE=C3D8, ELSET=left\n1,1,2,3,4,5,6,7,8\n"
         "*ELEMENT, TYPE=C3D8\n7,2,22,23,3,6,26,27,7\n" +
         more;
}

void check_decks() {
  const std::string sections = "*ELSET, ELSET=right\n7\n*ELSET, ELSET=EALL\nleft, right\n";
  const Taken left = take(cubes(sections), {"Left"});
  check("sets of elements",
        near(volume(left.mesh), 1.) && near(volume(take(cubes(sections), {"eall"}).mesh), 2.));
  check("a set with more than the body takes", near(named_area(left.mesh, "interface EALL"), 1.));
  check("sets without sections are no parts", separate_parts(take(cubes(sections), {}).choice).empty());
  const std::string materials = sections + "*SOLID SECTION, ELSET=LEFT, MATERIAL=a\n*SOLID SECTION, "
                                           "ELSET=right, MATERIAL=b\n*SOLID SECTION, ELSET=EALL\n";
  check("sets with sections are",
        separate_parts(take(cubes(materials), {}).choice) == std::vector<std::string>{"left", "right"});
  const Taken unnamed = take(cubes(""), {"left"});
  check("elements without a set",
        find_untaken({unnamed.choice}).n_unnamed == 1 && near(named_area(unnamed.mesh, "interface"), 1.));
  const std::string surface = "*SURFACE, NAME=interface\n1, S1\n";
  check("a surface keeps its name", near(named_area(take(cubes(surface), {"left"}).mesh, "interface"), 1.) &&
                                        near(named_area(take(cubes(surface), {}).mesh, "interface"), 1.));
  check("a file without volumes",
        refused_name(user_text("unnamed_vtk.vtk"), "core").find("has no volumes") != std::string::npos);
}

/// A mesh of Gmsh of two squares in a row, or two cubes above them.
std::string gmsh(const std::string &names, const std::string &elements) {
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n" + names +
         "$EndPhysicalNames\n$Nodes\n12\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 1 1 0\n6 2 1 0\n7 0 0 1\n8 1 "
         "0 1\n9 2 0 1\n10 0 1 1\n11 1 1 1\n12 2 1 1\n$EndNodes\n$Elements\n" +
         elements + "$EndElements\n";
}

void check_numbers_and_sections() {
  const std::string solid = "5 5 2 10 1 1 2 5 4 7 8 11 10\n6 5 2 0 2 2 3 6 5 8 9 12 11\n";
  const std::string text = gmsh("0\n", "2\n" + solid);
  check("a volume by its number", near(volume(take(text, {"10"}).mesh), 1.));
  check("a volume of the geometry",
        near(volume(take(text, {"volume 2"}).mesh), 1.) && separate_parts(take(text, {}).choice).empty());
  const std::string twice = gmsh("0\n", "3\n" + solid + "7 5 2 11 1 1 2 5 4 7 8 11 10\n");
  check("an element in two volumes",
        near(volume(take(twice, {"11"}).mesh), 1.) && take(twice, {"10"}).mesh.hexahedra.size() == 1);
  const std::string plane =
      gmsh("2\n2 1 \"steel\"\n2 2 \"lead\"\n", "2\n5 3 2 1 1 1 2 5 4\n6 3 2 2 2 2 3 6 5\n");
  const Taken lead = take(plane, {"lead"}, true);
  check("surfaces of a section",
        lead.mesh.hexahedra.size() == 1 &&
            near(named_area(lead.mesh, "interface steel"), lead.mesh.positions.back()[2]) &&
            separate_parts(take(plane, {}, true).choice).size() == 2);
}

/// Groups with names that a scene cannot write, or that mean something else there.
void check_names() {
  const std::string text =
      gmsh("8\n2 1 \"top face\"\n2 2 \"a, b\"\n2 3 \"all\"\n2 4 \"5\"\n2 6 \"-\"\n2 7 "
           "\"bot#1\"\n2 8 \"bot_1\"\n3 10 \"so#lid\"\n",
           "9\n1 3 2 1 1 1 4 10 7\n2 3 2 2 2 3 6 12 9\n3 3 2 3 3 7 8 11 10\n4 3 2 4 4 8 9 12 "
           "11\n7 3 2 6 6 1 4 5 2\n8 3 2 7 7 1 2 8 7\n9 3 2 8 8 2 3 9 8\n"
           "5 5 2 10 1 1 2 5 4 7 8 11 10\n6 5 2 10 1 2 3 6 5 8 9 12 11\n");
  const MeshFile mesh = take(text, {"so_lid"}).mesh;
  const BoundaryGroups groups(mesh);
  const auto ids = [&](const std::string &name) { return ids_of(groups, name); };
  using Ids = std::vector<unsigned int>;
  check("a comma", ids("a_ b") == Ids{2} && ids("a, b").empty());
  check("the sign of comments", ids("bot_1_") == Ids{7} && ids("bot_1") == Ids{8});
  check("all", ids("name all") == Ids{3} && ids("all").empty());
  check("no letter", ids("name -") == Ids{6});
  check("a number", groups.names().ids_of_number.at(5) == Ids{4});
  std::string both = text;
  both.replace(both.find("2 1 \"top"), 3, "2 5").replace(both.find("1 3 2 1"), 7, "1 3 2 5");
  const BoundaryGroups ambiguous(take(both, {}).mesh);
  check("a number of another group",
        ambiguous.names().ambiguous.at("5").size() == 2 && ids_of(ambiguous, "name 5") == Ids{4} &&
            ids_of(ambiguous, "number 5") == Ids{5} && ids_of(ambiguous, "top face") == Ids{5});
}

} // namespace

BILLET_TEST(volumes) {
  for (const std::string file : {"stack_msh22.msh", "stack_msh40.msh", "stack_msh41.msh", "stack_inp.inp"})
    check_stack(file);
  check("a file by materials", near(volume(take(read_text("block.ucd"), {"0"}).mesh), 4.));
  check_decks();
  check_numbers_and_sections();
  check_names();
}

} // namespace volumes_test
