// SPDX-License-Identifier: LGPL-2.1-or-later
// AVS's unstructured cell data: lines of comments, a line of five counts, nodes, cells, and data.
#include "billet/mesh/mesh_collector.h"
#include "billet/mesh/mesh_cursor.h"

#include <algorithm>
#include <map>
#include <stdexcept>

namespace billet {

namespace {

void skip_comments(MeshCursor &cursor) {
  while (!cursor.at_end() && cursor.next_word().front() == '#')
    cursor.line();
}

bool is_ucd(const std::string &bytes) {
  MeshCursor cursor(bytes);
  skip_comments(cursor);
  MeshCursor counts(cursor.line());
  long long value = 0;
  for (unsigned int i = 0; i < 5; ++i)
    if (!is_integer(counts.word(), value))
      return false;
  return counts.at_end();
}

CellShape ucd_shape(const std::string_view name) {
  static const std::map<std::string_view, CellShape> shapes{
      {"pt", {CellKind::ignored, 1}},      {"line", {CellKind::line, 2}},
      {"tri", {CellKind::triangle, 3}},    {"quad", {CellKind::quadrilateral, 4}},
      {"tet", {CellKind::tetrahedron, 4}}, {"pyr", {CellKind::pyramid, 5}},
      {"prism", {CellKind::wedge, 6}},     {"hex", {CellKind::hexahedron, 8}}};
  const auto found = shapes.find(name);
  return found == shapes.end() ? CellShape() : found->second;
}

MeshFile read_ucd(const std::string &bytes, const FileAccess & /*access*/) {
  // Minimum number of bytes of one: "1 0 0 0\n", "1 0 pt 1\n".
  constexpr std::size_t node_bytes = 8, cell_bytes = 9;
  MeshCursor cursor(bytes);
  MeshCollector mesh;
  skip_comments(cursor);
  const std::size_t n_nodes = cursor.count("the number of nodes", 1);
  const std::size_t n_cells = cursor.count("the number of cells", 1);
  bool has_data = false;
  for (unsigned int i = 0; i < 3; ++i)
    has_data = cursor.count("a number of data", 1) > 0 || has_data;
  cursor.checked_count("the number of nodes", n_nodes, node_bytes);
  for (std::size_t i = 0; i < n_nodes; ++i) {
    const long long number = cursor.integer("the number of a node");
    std::array<double, 3> position{};
    for (double &x : position)
      x = cursor.real("a finite coordinate of a node");
    mesh.add_node(number, position);
  }
  cursor.checked_count("the number of cells", n_cells, cell_bytes - 1);
  for (std::size_t i = 0; i < n_cells; ++i) {
    const long long number = cursor.integer("the number of a cell");
    const long long material = cursor.integer("the material of a cell");
    const CellShape shape = ucd_shape(cursor.word());
    if (shape.n_nodes == 0)
      cursor.fail("one of pt, line, tri, quad, tet, pyr, prism, hex");
    std::array<long long, 8> nodes{};
    for (unsigned int n = 0; n < shape.n_nodes; ++n)
      nodes[n] = cursor.integer("a node of a cell");
    mesh.add_cell(shape, number, nodes.data(),
                  shape.kind == CellKind::quadrilateral
                      ? std::vector<std::size_t>{mesh.numbered_group(material)}
                      : std::vector<std::size_t>());
    if (shape.kind == CellKind::hexahedron && material >= 0 && material < FaceGroup::no_number)
      mesh.add_to_volume(mesh.volume("", static_cast<unsigned int>(material), true), number);
    if (shape.kind == CellKind::line && material >= 0)
      mesh.add_edge({nodes[0], nodes[1]}, {"", static_cast<unsigned int>(std::min(material, 2147483648LL))});
  }
  if (!has_data && !cursor.at_end()) {
    cursor.word();
    cursor.fail("the end of the file, by its counts,");
  }
  return mesh.finish();
}

} // namespace

MeshFormat ucd_format() { return {"UCD", "AVS UCD (.ucd, .inp)", &is_ucd, &read_ucd}; }

} // namespace billet
