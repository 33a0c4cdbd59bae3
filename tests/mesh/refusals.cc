// SPDX-License-Identifier: LGPL-2.1-or-later
// What is wrong with a mesh file is said with the numbers of the file; doubled nodes can be merged.
#include "samples.h"

namespace refusals_test {

using namespace billet;
using namespace billet::testing;

namespace {

std::string replaced(std::string text, const std::string &from, const std::string &to) {
  const std::size_t place = text.find(from);
  if (place == std::string::npos)
    throw std::logic_error("'" + from + "' is not in the sample");
  return text.replace(place, from.size(), to);
}

void check_refusal(const std::string &name, const std::string &bytes, const std::vector<std::string> &words) {
  const std::string message = refusal(bytes);
  bool holds = true;
  for (const std::string &word : words)
    holds = holds && message.find(word) != std::string::npos;
  check(name, holds);
  if (!holds)
    std::cout << "  says: " << message << std::endl;
}

/// Two cubes in a row with four nodes each on the face between them, the second ones moved by `gap`.
std::string doubled_deck(const std::string &gap) {
  return "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n"
         "12," +
         gap + ",0,0\n13," + gap + ",1,0\n16," + gap + ",0,1\n17," + gap +
         ",1,1\n22,2,0,0\n23,2,1,0\n26,2,0,1\n27,2,1,1\n99,5,5,5\n"
         "*ELEMENT, TYPE=C3D8\n1,1,2,3,4,5,6,7,8\n7,12,22,23,13,16,26,27,17\n";
}

void check_doubled() {
  const std::string deck = doubled_deck("1");
  check_refusal("doubled nodes", deck,
                {"4 of its nodes are doubled", "nodes 2 and 12", "Merge nodes within"});
  const MeshFile merged = load(deck, DoubledNodes::merged, 1e-6), kept = load(deck, DoubledNodes::kept);
  check("merged nodes", merged.positions.size() == 12);
  check("kept nodes", kept.positions.size() == 16);
  check("a gap is not doubled", refusal(doubled_deck("1.001")).empty());
  check("a gap within the distance",
        load(doubled_deck("1.001"), DoubledNodes::merged, 2e-3).positions.size() == 12);
  check("a gap beyond the distance",
        load(doubled_deck("1.001"), DoubledNodes::merged, 5e-4).positions.size() == 16);
  check("a distance beyond the edges",
        refusal(deck, DoubledNodes::merged, 1.5).find("element 1 has two corners at node 1") !=
            std::string::npos);
}

NearNodes near_nodes(const std::string &bytes, const DoubledNodes doubled = DoubledNodes::refused,
                     const double distance = 0.) {
  MeshFile mesh = parse_mesh(bytes, &access_sample);
  return mend_and_check(mesh, doubled, distance);
}

/// Nodes that are probably doubled: closer than a thousandth of the edges at them.
void check_near() {
  const NearNodes near = near_nodes(doubled_deck("1.000001"));
  check("nodes that nearly coincide", near.n_pairs == 4 && std::abs(near.distance - 1e-6) < 1e-12 &&
                                          near.examples == "2 and 12; 3 and 13; 6 and 16");
  check("nodes beyond a thousandth of an edge", near_nodes(doubled_deck("1.002")).n_pairs == 0);
  check("nodes that the scene keeps apart",
        near_nodes(doubled_deck("1.000001"), DoubledNodes::kept).n_pairs == 0);
  check("nodes that the scene joins",
        near_nodes(doubled_deck("1.000001"), DoubledNodes::merged, 2e-6).n_pairs == 0);
  check("nodes beyond the distance of the scene",
        near_nodes(doubled_deck("1.000001"), DoubledNodes::merged, 5e-7).n_pairs == 4);
  // A third cube, a thousand times as small, at a corner of the first: its own edges count there.
  const auto with_small = [](const std::string &gap) {
    std::string nodes;
    const std::string x[2] = {"-0.001", gap}, y[2] = {"-0.001", "0"}, order[4] = {"00", "10", "11", "01"};
    for (unsigned int i = 0; i < 8; ++i)
      nodes += std::to_string(31 + i) + "," + x[order[i % 4][0] - '0'] + "," + y[order[i % 4][1] - '0'] +
               "," + (i < 4 ? "-0.001" : "0") + "\n";
    return replaced(doubled_deck("1.000001"), "99,5,5,5\n", nodes) + "8,31,32,33,34,35,36,37,38\n";
  };
  check("small elements beside large ones", near_nodes(with_small("-0.0000002")).n_pairs == 5 &&
                                                near_nodes(with_small("-0.000002")).n_pairs == 4);
}

/// Nodes and elements in files of their own.
void check_input() {
  const std::string deck = doubled_deck("1");
  const std::size_t first = deck.find("1,0"), last = deck.find("*ELEMENT");
  const std::string nodes = deck.substr(first, last - first);
  const std::string elements = "1,1,2,3,4,5,6,7,8\n";
  const auto read = [&](const std::string &text) {
    return parse_mesh(text, [&](const std::string &name) {
      if (name == "nodes.txt")
        return nodes;
      if (name == "deck.txt")
        return std::string("*ELEMENT, TYPE=C3D8\n");
      return name == "elements.txt" ? elements : throw std::invalid_argument("no '" + name + "'");
    });
  };
  const MeshFile mesh = read("*NODE, NSET=N, INPUT=nodes.txt\n*ELEMENT, TYPE=C3D8, INPUT=elements.txt\n"
                             "7,12,22,23,13,16,26,27,17\n");
  check("nodes and elements of other files",
        mesh.positions.size() == 17 && mesh.hexahedra.size() == 2 && mesh.node_sets.size() == 1);
  const auto says = [&](const std::string &text, const std::string &words) {
    try {
      read(text);
    } catch (const std::invalid_argument &error) {
      return std::string(error.what()).find(words) != std::string::npos;
    }
    return false;
  };
  check("a file of nodes that is not there",
        says("*NODE, INPUT=no.txt\n", "line 1 of it, INPUT of *node fails: no 'no.txt'"));
  check("a keyword where data should be",
        says("*NODE, INPUT=deck.txt\n", "from 'deck.txt', and in line 1 of it, a keyword stands where"));
}

void check_elements(const std::string &deck) {
  const std::string first = "1, 1, 2, 5, 4,\n 7, 8, 11, 10";
  check_refusal("an inverted element", replaced(deck, first, "1, 7, 8, 11, 10, 1, 2, 5, 4"),
                {"element 1 is inverted"});
  check_refusal("a repeated node", replaced(deck, first, "1, 1, 2, 5, 1, 7, 8, 11, 10"),
                {"element 1 has node 1 twice"});
  check_refusal("a missing node", replaced(deck, first, "1, 1, 2, 5, 40, 7, 8, 11, 10"),
                {"element 1", "names node 40, which is missing"});
  check_refusal("an element given twice", replaced(deck, "4, 8, 9", "3, 8, 9"),
                {"element 3 of it is given twice"});
  check_refusal("the same corners twice",
                replaced(deck, "4, 8, 9, 12, 11, 14, 15, 18, 17", "4, 7, 8, 11, 10, 13, 14, 17, 16"),
                {"elements 3 and 4 of it have the same corners"});
  check_refusal("too few nodes", replaced(deck, "10\n2, 2, 3", "10\n2, 3"), {"element"});
  check_refusal("tetrahedra",
                replaced(deck, "type=C3D8R\n", "type=C3D4\n50, 1, 2, 5, 7\n*Element, type=C3D8R\n"),
                {"1 tetrahedra beside 4 hexahedra", "Mesh.SubdivisionAlgorithm = 2"});
  check_refusal("second order", replaced(deck, "type=C3D8R", "type=C3D20R"), {"its type C3D20R has 20"});
  check_refusal("an unknown type", replaced(deck, "type=C3D8R", "type=XYZ8"), {"'XYZ8'", "C3D8"});
}

void check_sets(const std::string &deck) {
  check_refusal("a set names a missing node", replaced(deck, "1, 6, 1", "1, 60, 1"),
                {"'bottom'", "60 nodes in a range"});
  check_refusal("a range of 1e12", replaced(deck, "1, 6, 1", "1, 1000000000000, 1"), {"'bottom'"});
  check_refusal("a side that is none", replaced(deck, "_top_S2, S2\n", "_top_S2, S7\n"),
                {"'top'", "S1 to S6"});
  check_refusal("a surface names a missing set", replaced(deck, "_top_S2, S2\n", "_tpo_S2, S2\n"),
                {"'_tpo_S2'"});
  check_refusal("a second part", replaced(deck, "*Assembly", "*Part, name=P2\n*Node\n*End Part\n*Assembly"),
                {"a second part", "Do not use parts"});
  check_refusal("a file that is not there", replaced(deck, "nodes.inc", "no.inc"), {"*INCLUDE", "no.inc"});
  check_refusal("nodes that are generated", replaced(deck, "*Material", "*NGEN\n1,2\n*Material"),
                {"*ngen", "write them out"});
}

void check_counts() {
  const std::string msh = read_text("msh2.msh"), vtk = read_text("legacy.vtk"), ucd = read_text("block.ucd");
  check_refusal("MSH: 1e12 nodes", replaced(msh, "$Nodes\n18", "$Nodes\n1000000000000"),
                {"1000000000000", "too few"});
  check_refusal("MSH: too few nodes", replaced(msh, "$Nodes\n18", "$Nodes\n17"), {"line 31", "$EndNodes"});
  check_refusal("MSH: a missing node", replaced(msh, "1 9 10 4 13 17 18 16", "1 9 10 4 13 17 18 160"),
                {"node 160, which is missing"});
  check_refusal("MSH: a section is missing", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n", {"no section $Nodes"});
  check_refusal("MSH: another version", replaced(msh, "2.2 0 8", "3 0 8"), {"version", "msh41"});
  check_refusal("VTK: 1e12 points", replaced(vtk, "POINTS 18", "POINTS 1000000000000"), {"1000000000000"});
  check_refusal("VTK: a missing point", replaced(vtk, "8 0 8 9 3", "8 0 8 9 30"), {"names point 30"});
  check_refusal("VTK: the size of the cells", replaced(vtk, "CELL_TYPES 1", "CELL_TYPES 0"), {"line"});
  check_refusal("UCD: 1e12 cells", replaced(ucd, "18 20 0", "18 1000000000000 0"), {"1000000000000"});
  check_refusal("UCD: too few cells", replaced(ucd, "18 20 0", "18 19 0"),
                {"the end of the file, by its counts,"});
  check_refusal("UCD: not a number", replaced(ucd, "2 1 0 0", "2 nan 0 0"), {"line 3", "finite coordinate"});
  check_refusal("no mesh at all", "no mesh", {"none of these formats", "(.msh)", "(.vtk)", "(.inp)", "UCD"});
  check_refusal("XML", "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\">", {"meshio convert"});
  check_refusal("nothing", "", {"none of these formats"});
  for (const std::string comment : {"", "$ a comment\n$# another\n"})
    check_refusal("LS-DYNA", comment + "*KEYWORD\n*NODE\n1, 0., 0., 0.\n*END\n",
                  {"a keyword file of LS-DYNA", "none of these formats", "(.inp)"});
}

} // namespace

BILLET_TEST(refusals) {
  check_doubled();
  check_near();
  check_input();
  check_elements(read_text("part.inp"));
  check_sets(read_text("part.inp"));
  check_counts();
  check("a byte-order mark", refusal("\xEF\xBB\xBF" + read_text("msh41.msh")).empty());
  check("all elements inside out",
        refusal("*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n"
                "8,0,1,1\n*ELEMENT,TYPE=C3D8I\n1,5,6,7,8,1,2,3,4\n")
            .empty());
}

} // namespace refusals_test
