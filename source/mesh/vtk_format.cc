// SPDX-License-Identifier: LGPL-2.1-or-later
// VTK's legacy format, ASCII or binary (big-endian), with the cells of versions before and after 5.
#include "billet/mesh/mesh_collector.h"
#include "billet/mesh/mesh_cursor.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <stdexcept>

namespace billet {

namespace {

bool is_vtk(const std::string &bytes) { return bytes.compare(0, 14, "# vtk DataFile") == 0; }

/// Types of cells by their numbers in VTK.
CellShape vtk_shape(const long long type) {
  static const std::map<long long, CellShape> shapes{
      {1, {CellKind::ignored, 1}},        {3, {CellKind::line, 2}},
      {5, {CellKind::triangle, 3}},       {8, {CellKind::quadrilateral, 4}},
      {9, {CellKind::quadrilateral, 4}},  {10, {CellKind::tetrahedron, 4}},
      {11, {CellKind::hexahedron, 8}},    {12, {CellKind::hexahedron, 8}},
      {13, {CellKind::wedge, 6}},         {14, {CellKind::pyramid, 5}},
      {21, {CellKind::ignored, 3}},       {22, {CellKind::ignored, 6}},
      {23, {CellKind::ignored, 8}},       {24, {CellKind::second_order, 10}},
      {25, {CellKind::second_order, 20}}, {26, {CellKind::second_order, 15}},
      {27, {CellKind::second_order, 13}}, {28, {CellKind::ignored, 9}},
      {29, {CellKind::second_order, 27}}};
  const auto found = shapes.find(type);
  return found == shapes.end() ? CellShape() : found->second;
}

enum class DataType { int8, int16, int32, int64, real32, real64 };

struct NamedType {
  DataType type;
  std::size_t size;
};

/// Reads one legacy file.
class VtkReader {
public:
  explicit VtkReader(const std::string &bytes) : cursor_(bytes), mesh_("point (counted from 0)") {}

  MeshFile read() {
    read_header();
    while (!cursor_.at_end()) {
      const std::string keyword = lower_case(cursor_.word());
      if (keyword == "points")
        read_points();
      else if (keyword == "cells")
        read_cells();
      else if (keyword == "cell_types")
        read_types();
      else if (keyword == "cell_data")
        start_data(types_.size(), true);
      else if (keyword == "point_data")
        start_data(n_points_, false);
      else if (keyword == "metadata")
        skip_metadata();
      else if (!read_data(keyword))
        cursor_.fail("a section of an unstructured grid");
    }
    return finish();
  }

private:
  void read_header() {
    cursor_.line();
    cursor_.line();
    const std::string mode = lower_case(cursor_.word());
    if (mode != "ascii" && mode != "binary")
      cursor_.fail("ASCII or BINARY");
    is_binary_ = mode == "binary";
    const std::uint16_t probe = 1;
    if (*reinterpret_cast<const unsigned char *>(&probe) == 1)
      cursor_.swap_bytes();
    if (lower_case(cursor_.word()) != "dataset")
      cursor_.fail("DATASET");
    if (lower_case(cursor_.word()) != "unstructured_grid")
      cursor_.fail("UNSTRUCTURED_GRID, the only kind of data with hexahedra that is read,");
  }

  NamedType type() {
    static const std::map<std::string, NamedType> types{
        {"char", {DataType::int8, 1}},          {"unsigned_char", {DataType::int8, 1}},
        {"short", {DataType::int16, 2}},        {"unsigned_short", {DataType::int16, 2}},
        {"int", {DataType::int32, 4}},          {"unsigned_int", {DataType::int32, 4}},
        {"long", {DataType::int64, 8}},         {"unsigned_long", {DataType::int64, 8}},
        {"float", {DataType::real32, 4}},       {"double", {DataType::real64, 8}},
        {"vtktypeint64", {DataType::int64, 8}}, {"vtktypeint32", {DataType::int32, 4}},
        {"vtkidtype", {DataType::int32, 4}}}; // VTK writes ids of 64 bits as int, too
    const auto found = types.find(lower_case(cursor_.word()));
    if (found == types.end())
      cursor_.fail("a type such as int, float or double");
    return found->second;
  }

  /// Returns the number of values; binary ones begin behind the end of the line.
  std::size_t begin_values(const unsigned long long n, const std::size_t size) {
    const std::size_t count = cursor_.checked_count("a number of values", n, is_binary_ ? size : 1);
    if (is_binary_)
      cursor_.line();
    return count;
  }

  double real(const DataType type, const char *const what) {
    if (!is_binary_)
      return cursor_.real(what);
    const double value = type == DataType::real32   ? static_cast<double>(cursor_.raw<float>(what))
                         : type == DataType::real64 ? cursor_.raw<double>(what)
                                                    : static_cast<double>(integer(type, what));
    if (!(std::abs(value) <= 1e60))
      cursor_.refuse_byte(std::string(what) + " should end");
    return value;
  }

  long long integer(const DataType type, const char *const what) {
    if (!is_binary_) {
      const double value = cursor_.real(what);
      if (std::abs(value) > 1e15 || value != std::floor(value))
        cursor_.fail(what);
      return static_cast<long long>(value);
    }
    switch (type) {
    case DataType::int8:
      return cursor_.raw<std::int8_t>(what);
    case DataType::int16:
      return cursor_.raw<std::int16_t>(what);
    case DataType::int32:
      return cursor_.raw<std::int32_t>(what);
    case DataType::int64:
      return cursor_.raw<std::int64_t>(what);
    case DataType::real32:
    case DataType::real64: {
      const double value = real(type, what);
      if (std::abs(value) > 1e15 || value != std::floor(value))
        cursor_.refuse_byte(std::string("a number that is not whole ends where ") + what + " should be");
      return static_cast<long long>(value);
    }
    }
    return 0;
  }

  void read_points() {
    if (n_points_ > 0)
      cursor_.refuse("POINTS stands twice");
    n_points_ = cursor_.count("the number of points", 3);
    const NamedType number = type();
    begin_values(3ULL * n_points_, number.size);
    for (std::size_t i = 0; i < n_points_; ++i) {
      std::array<double, 3> position{};
      for (double &x : position)
        x = real(number.type, "a finite coordinate of a point");
      mesh_.add_node(static_cast<long long>(i), position);
    }
  }

  void read_cells() {
    if (!first_.empty())
      cursor_.refuse("CELLS stands twice");
    const std::size_t n = cursor_.count("the number of cells", 1);
    const std::size_t size = cursor_.count("the size of the cells", 1);
    if (lower_case(cursor_.next_word()) == "offsets") {
      cursor_.word();
      read_offsets(n, size);
      return;
    }
    begin_values(size, 4);
    std::size_t n_read = 0;
    first_.push_back(0);
    for (std::size_t i = 0; i < n; ++i) {
      const long long n_nodes =
          n_read < size ? integer(DataType::int32, "the number of nodes of a cell") : -1;
      if (n_nodes < 0 || static_cast<unsigned long long>(n_nodes) >= size - n_read)
        throw std::invalid_argument("cell " + std::to_string(i) +
                                    " (counted from 0) of it exceeds the size " + std::to_string(size) +
                                    " of CELLS");
      for (long long node = 0; node < n_nodes; ++node)
        nodes_.push_back(integer(DataType::int32, "a point of a cell"));
      n_read += static_cast<std::size_t>(n_nodes) + 1;
      first_.push_back(nodes_.size());
    }
    if (n_read != size)
      throw std::invalid_argument("its " + std::to_string(n) + " cells have the size " +
                                  std::to_string(n_read) + ", not " + std::to_string(size) +
                                  " as CELLS says");
  }

  /// Version 5: n offsets, of which the last is the number of entries that follow.
  void read_offsets(const std::size_t n, const std::size_t size) {
    const NamedType offset = type();
    begin_values(n, offset.size);
    for (std::size_t i = 0; i < n; ++i) {
      const long long value = integer(offset.type, "an offset of a cell");
      const long long least = i == 0 ? 0 : static_cast<long long>(first_.back());
      if (value < least || (i == 0 && value != 0) || static_cast<unsigned long long>(value) > size)
        throw std::invalid_argument("offset " + std::to_string(i) + " of its cells is " +
                                    std::to_string(value) + ", which does not fit the size " +
                                    std::to_string(size));
      first_.push_back(static_cast<std::size_t>(value));
    }
    if (first_.empty() || first_.back() != size)
      throw std::invalid_argument("the last offset of its cells is not the size " + std::to_string(size));
    if (lower_case(cursor_.word()) != "connectivity")
      cursor_.fail("CONNECTIVITY");
    const NamedType entry = type();
    begin_values(size, entry.size);
    for (std::size_t i = 0; i < size; ++i)
      nodes_.push_back(integer(entry.type, "a point of a cell"));
  }

  void read_types() {
    if (!types_.empty())
      cursor_.refuse("CELL_TYPES stands twice");
    const std::size_t n = cursor_.count("the number of types of cells", 1);
    begin_values(n, 4);
    for (std::size_t i = 0; i < n; ++i)
      types_.push_back(integer(DataType::int32, "the type of a cell"));
  }

  void start_data(const std::size_t n_expected, const bool of_cells) {
    n_data_ = cursor_.count("the number of data", 1);
    if (n_data_ != n_expected)
      cursor_.refuse("there are " + std::to_string(n_data_) + " data of " + std::to_string(n_expected) +
                     (of_cells ? " cells" : " points"));
    data_of_cells_ = of_cells;
  }

  /// Reads data, of which only numbers of groups matter. Whether the keyword is one of data.
  bool read_data(const std::string &keyword) {
    static const std::map<std::string, unsigned long long> n_components{
        {"vectors", 3}, {"normals", 3}, {"tensors", 9}, {"tensors6", 6}};
    if (keyword == "scalars") {
      const std::string name(cursor_.word());
      const NamedType number = type();
      const std::string_view rest = cursor_.line();
      long long components = 1;
      if (!rest.empty() && (!is_integer(rest, components) || components < 1 || components > 4))
        cursor_.refuse("SCALARS have 1 to 4 components, not '" + std::string(rest.substr(0, 9)) + "'");
      if (lower_case(cursor_.next_word()) == "lookup_table") {
        cursor_.word();
        cursor_.word();
      } else if (is_binary_)
        cursor_.refuse("LOOKUP_TABLE should follow SCALARS");
      read_array(name, static_cast<unsigned long long>(components), n_data_, number);
    } else if (const auto found = n_components.find(keyword); found != n_components.end()) {
      const std::string name(cursor_.word());
      read_array(name, found->second, n_data_, type());
    } else if (keyword == "texture_coordinates") {
      const std::string name(cursor_.word());
      const std::size_t components = cursor_.count("a number of components", 1);
      read_array(name, components, n_data_, type());
    } else if (keyword == "lookup_table") {
      cursor_.word();
      read_array("", 4, cursor_.count("the size of a table", 1), {DataType::int8, 1});
    } else if (keyword == "field")
      read_field();
    else
      return false;
    return true;
  }

  void read_field() {
    cursor_.word();
    const std::size_t n_arrays = cursor_.count("the number of arrays", 1);
    for (std::size_t i = 0; i < n_arrays; ++i) {
      if (lower_case(cursor_.next_word()) == "metadata") {
        cursor_.word();
        skip_metadata();
      }
      const std::string name(cursor_.word());
      const std::size_t components = cursor_.count("a number of components", 1);
      const std::size_t n = cursor_.count("a number of values", 1);
      read_array(name, components, n, type());
    }
  }

  void read_array(const std::string &name, const unsigned long long components, const std::size_t n,
                  const NamedType &number) {
    static const std::map<std::string, unsigned int> ranks{
        {"materialid", 4}, {"boundary_id", 3}, {"gmsh:physical", 2}, {"cellentityids", 1}};
    const auto found = ranks.find(lower_case(name));
    const bool is_wanted = data_of_cells_ && components == 1 && n == types_.size() && n == n_data_ &&
                           found != ranks.end() && found->second > rank_;
    if (is_wanted) {
      rank_ = found->second;
      groups_.clear();
    }
    if (components > 0 && n > cursor_.remaining() / components)
      cursor_.refuse("an array has " + std::to_string(n) + " values of " + std::to_string(components) +
                     " components, for which the file is too short");
    begin_values(components * n, number.size);
    for (std::size_t i = 0; i < components * n; ++i)
      if (is_wanted)
        groups_.push_back(integer(number.type, "the number of a group"));
      else if (is_binary_)
        cursor_.skip(number.size, "a value");
      else
        cursor_.real("a value");
  }

  /// Metadata end with an empty line.
  void skip_metadata() {
    cursor_.line();
    while (cursor_.remaining() > 0 && !cursor_.line().empty()) {
    }
  }

  MeshFile finish() {
    const std::size_t n = first_.empty() ? 0 : first_.size() - 1;
    if (types_.size() != n)
      throw std::invalid_argument("it has " + std::to_string(types_.size()) + " types of " +
                                  std::to_string(n) + " cells");
    for (std::size_t i = 0; i < n; ++i) {
      const CellShape shape = vtk_shape(types_[i]);
      std::vector<long long> nodes(nodes_.begin() + static_cast<std::ptrdiff_t>(first_[i]),
                                   nodes_.begin() + static_cast<std::ptrdiff_t>(first_[i + 1]));
      const std::string cell = "cell " + std::to_string(i) + " (counted from 0) of it ";
      for (const long long node : nodes)
        if (!mesh_.has_node(node))
          throw std::invalid_argument(cell + "names point " + std::to_string(node) + ", but there are " +
                                      std::to_string(n_points_) + ", counted from 0");
      if (shape.n_nodes == 0 && types_[i] != 2 && types_[i] != 4 && types_[i] != 7)
        throw std::invalid_argument(cell + "has the type " + std::to_string(types_[i]) +
                                    "; allowed are hexahedra (12) and their faces (9)");
      if (shape.n_nodes != 0 && nodes.size() != shape.n_nodes)
        throw std::invalid_argument(cell + "has " + std::to_string(nodes.size()) +
                                    " points, where its type " + std::to_string(types_[i]) + " has " +
                                    std::to_string(shape.n_nodes));
      if (types_[i] == 8 || types_[i] == 11) // pixels and voxels count along the axes
        for (std::size_t first = 2; first < nodes.size(); first += 4)
          std::swap(nodes[first], nodes[first + 1]);
      // deal.II writes -1 for cells that are in no group.
      const bool is_grouped = shape.kind == CellKind::quadrilateral && !groups_.empty() && groups_[i] != -1;
      mesh_.add_cell(shape, static_cast<long long>(i), nodes.data(),
                     is_grouped ? std::vector<std::size_t>{mesh_.numbered_group(groups_[i])}
                                : std::vector<std::size_t>());
      if (shape.kind == CellKind::hexahedron && !groups_.empty() && groups_[i] >= 0 &&
          groups_[i] < FaceGroup::no_number)
        mesh_.add_to_volume(mesh_.volume("", static_cast<unsigned int>(groups_[i]), true),
                            static_cast<long long>(i));
      if (shape.kind == CellKind::line && !groups_.empty() && groups_[i] >= 0)
        mesh_.add_edge({nodes[0], nodes[1]},
                       {"", static_cast<unsigned int>(std::min(groups_[i], 2147483648LL))});
    }
    mesh_.mesh().corners = {0, 1, 3, 2, 4, 5, 7, 6};
    return mesh_.finish();
  }

  MeshCursor cursor_;
  MeshCollector mesh_;
  bool is_binary_ = false, data_of_cells_ = false;
  std::size_t n_points_ = 0, n_data_ = 0;
  std::vector<std::size_t> first_; ///< of each cell in `nodes_`, and their end
  std::vector<long long> nodes_, types_, groups_;
  unsigned int rank_ = 0; ///< of the array that `groups_` are from: the largest is used
};

} // namespace

MeshFormat vtk_format() {
  return {"VTK", "VTK's legacy format (.vtk)", &is_vtk,
          [](const std::string &bytes, const FileAccess &) { return VtkReader(bytes).read(); }};
}

} // namespace billet
