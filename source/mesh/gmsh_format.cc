// SPDX-License-Identifier: LGPL-2.1-or-later
// Gmsh's MSH formats 1, 2, 4.0 and 4.1; 2 and 4 ASCII or binary.
#include "billet/mesh/mesh_collector.h"
#include "billet/mesh/mesh_cursor.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>

namespace billet {

namespace {

bool is_gmsh(const std::string &bytes) {
  MeshCursor cursor(bytes);
  std::string_view first = cursor.word();
  if (first == "$Comments") {
    while (!cursor.at_end() && cursor.word() != "$EndComments") {
    }
    first = cursor.word();
  }
  return first == "$MeshFormat" || first == "$NOD";
}

/// Types of elements by their numbers in Gmsh.
CellShape gmsh_shape(const long long type) {
  static const std::map<long long, CellShape> shapes{
      {1, {CellKind::line, 2}},           {2, {CellKind::triangle, 3}},
      {3, {CellKind::quadrilateral, 4}},  {4, {CellKind::tetrahedron, 4}},
      {5, {CellKind::hexahedron, 8}},     {6, {CellKind::wedge, 6}},
      {7, {CellKind::pyramid, 5}},        {8, {CellKind::ignored, 3}},
      {9, {CellKind::ignored, 6}},        {10, {CellKind::ignored, 9}},
      {11, {CellKind::second_order, 10}}, {12, {CellKind::second_order, 27}},
      {13, {CellKind::second_order, 18}}, {14, {CellKind::second_order, 14}},
      {15, {CellKind::ignored, 1}},       {16, {CellKind::ignored, 8}},
      {17, {CellKind::second_order, 20}}, {18, {CellKind::second_order, 15}},
      {19, {CellKind::second_order, 13}}};
  const auto found = shapes.find(type);
  return found == shapes.end() ? CellShape() : found->second;
}

/// Returns the number of a physical group, whose sign says how it is turned.
long long magnitude(const long long number) {
  return number < -2147483647LL ? 2147483648LL : std::llabs(number);
}

constexpr std::size_t max_nodes = 27; // of one element

/// Reads one file. The functions `number`, `size` and `real` read from its ASCII or its binary
/// parts.
class GmshReader {
public:
  explicit GmshReader(const std::string &bytes) : cursor_(bytes) {}

  MeshFile read() {
    while (!cursor_.at_end()) {
      const std::string section(cursor_.word());
      if (section.front() != '$')
        cursor_.fail("a section, such as $Nodes,");
      read_section(section);
    }
    for (const char *const section : {"$Nodes", "$Elements"})
      if (sections_.count(section) == 0)
        throw std::invalid_argument(std::string("it has no section ") + section);
    add_hexahedra();
    return mesh_.finish();
  }

private:
  struct Hexahedron {
    std::array<long long, 8> nodes;
    long long physical, entity, number;
  };

  void read_section(const std::string &section) {
    const bool is_old = section == "$NOD" || section == "$ELM";
    const std::string name = section == "$NOD" ? "$Nodes" : section == "$ELM" ? "$Elements" : section;
    if (name == "$MeshFormat" || name == "$PhysicalNames" || name == "$Entities" || name == "$Nodes" ||
        name == "$Elements") {
      if (!sections_.insert(name).second)
        cursor_.refuse("the section " + name + " stands twice");
      if (name != "$MeshFormat" && version_ == 0 && !is_old)
        cursor_.refuse("the section " + name + " stands before $MeshFormat");
      version_ = is_old ? 1 : version_;
      if (version_ >= 40 && is_binary_ && name != "$PhysicalNames")
        cursor_.line(); // numbers begin behind the end of the line
      if (name == "$MeshFormat")
        read_format();
      else if (name == "$PhysicalNames")
        read_names();
      else if (name == "$Entities")
        read_entities();
      else if (name == "$Nodes")
        version_ < 4 ? read_nodes() : read_node_blocks();
      else
        version_ == 1 ? read_old_elements() : version_ < 4 ? read_elements() : read_element_blocks();
      cursor_.expect((is_old ? "$END" : "$End") + section.substr(1));
    } else if (name == "$PartitionedEntities")
      cursor_.refuse("the mesh is partitioned; save it without partitions (in Gmsh: UnpartitionMesh)");
    else
      cursor_.skip_behind("$End" + section.substr(1));
  }

  void read_format() {
    const double version = cursor_.real("the version of the format");
    const long long is_binary = cursor_.integer("0 (ASCII) or 1 (binary)");
    if (is_binary != 0 && is_binary != 1)
      cursor_.fail("0 (ASCII) or 1 (binary)");
    if (cursor_.integer("the size of a number, 8,") != 8)
      cursor_.fail("the size of a number, 8,");
    version_ = version >= 2. && version < 3. ? 2 : version == 4. ? 40 : version == 4.1 ? 41 : 0;
    if (version_ == 0)
      cursor_.refuse(
          "the version of the format is not one of 2, 2.1, 2.2, 4, 4.1; save the mesh anew (in Gmsh: "
          "Mesh.MshFileVersion = 4.1, or gmsh -format msh41)");
    is_binary_ = is_binary == 1;
    cursor_.line();
    if (!is_binary_)
      return;
    if (number("the order of bytes") == 1)
      return;
    cursor_.swap_bytes();
    constexpr std::int32_t swapped_one = 1 << 24;
    if (last_ != swapped_one)
      cursor_.refuse_byte("the mark of the order of bytes is not 1");
  }

  /// Returns a number of four bytes.
  long long number(const char *const what) {
    if (!is_binary_)
      return cursor_.integer(what);
    last_ = cursor_.raw<std::int32_t>(what);
    return last_;
  }
  /// Returns a number of eight bytes: a tag, or in format 4.1 also a count.
  long long tag(const char *const what) {
    return !is_binary_      ? cursor_.integer(what)
           : version_ == 41 ? static_cast<long long>(cursor_.raw<std::int64_t>(what))
                            : number(what);
  }
  double real(const char *const what) {
    if (!is_binary_)
      return cursor_.real(what);
    const double value = cursor_.raw<double>(what);
    if (!(std::abs(value) <= 1e60))
      cursor_.refuse_byte(std::string(what) + " should end");
    return value;
  }
  /// Returns a count, of entries with so many bytes at least in ASCII and in binary parts.
  std::size_t count(const char *const what, const std::size_t in_ascii, const std::size_t in_binary) {
    const long long n = !is_binary_      ? cursor_.integer(what)
                        : version_ >= 40 ? static_cast<long long>(cursor_.raw<std::int64_t>(what))
                                         : static_cast<long long>(cursor_.raw<std::int32_t>(what));
    if (n < 0)
      cursor_.refuse(std::string(what) + " is negative");
    return cursor_.checked_count(what, static_cast<unsigned long long>(n), is_binary_ ? in_binary : in_ascii);
  }

  /// Reads the section of names, which has lines of text in binary files, too.
  void read_names() {
    const std::size_t n = cursor_.count("the number of physical names", 6);
    cursor_.line();
    for (std::size_t i = 0; i < n; ++i) {
      const long long dimension = cursor_.integer("the dimension of a physical group");
      const long long group = cursor_.integer("the number of a physical group");
      const std::string_view rest = cursor_.line();
      if (rest.size() < 2 || rest.front() != '"' || rest.back() != '"')
        cursor_.refuse("the name of a physical group should stand in quotation marks");
      if (dimension > 0 && dimension < 4)
        names_[static_cast<std::size_t>(dimension)][magnitude(group)] =
            std::string(rest.substr(1, rest.size() - 2));
    }
  }

  void read_entities() {
    std::array<std::size_t, 4> n{};
    for (std::size_t &n_entities : n)
      n_entities = count("a number of entities", 10, 28);
    for (std::size_t dimension = 0; dimension < 4; ++dimension)
      for (std::size_t i = 0; i < n[dimension]; ++i) {
        const long long entity = number("the number of an entity");
        const unsigned int n_corners = dimension == 0 && version_ == 41 ? 3 : 6;
        for (unsigned int c = 0; c < n_corners; ++c)
          real("a coordinate of an entity");
        std::vector<long long> groups(count("a number of physical groups", 2, 4));
        for (long long &group : groups)
          group = magnitude(number("the number of a physical group"));
        if (dimension > 0)
          for (std::size_t b = count("a number of bounding entities", 2, 4); b > 0; --b)
            number("the number of an entity");
        physical_[dimension][entity] = groups;
      }
    has_entities_ = true;
  }

  /// Returns the name of a physical group; empty if it has none.
  std::string name_of(const std::size_t dimension, const long long group) const {
    const auto name = names_[dimension].find(group);
    return name == names_[dimension].end() ? "" : name->second;
  }

  /// Returns the groups of a face with these physical groups on this surface of the geometry.
  std::vector<std::size_t> face_groups(const std::vector<long long> &physical, const long long entity) {
    std::vector<std::size_t> groups;
    for (const long long number : physical) {
      mesh_.numbered_group(number); // it has to be a boundary id
      groups.push_back(mesh_.group(name_of(2, number), static_cast<unsigned int>(number)));
    }
    if (groups.empty()) {
      groups.push_back(mesh_.numbered_group(0));
      if (entity > 0)
        groups.push_back(mesh_.group("surface " + std::to_string(entity), FaceGroup::no_number));
    }
    return groups;
  }

  /// Returns the groups of an edge, likewise.
  std::vector<FaceGroup> edge_groups(const std::vector<long long> &physical, const long long entity) const {
    std::vector<FaceGroup> groups;
    for (const long long number : physical)
      groups.push_back({name_of(1, number), group_number(number)});
    if (groups.empty()) {
      groups.push_back({"", 0});
      if (entity > 0)
        groups.push_back({"curve " + std::to_string(entity), FaceGroup::no_number});
    }
    return groups;
  }
  /// Returns the volumes of a hexahedron, likewise: those of the geometry if it has no physical
  /// ones.
  std::vector<std::size_t> volumes(const std::vector<long long> &physical, const long long entity) {
    std::vector<std::size_t> all;
    for (const long long number : physical)
      all.push_back(mesh_.volume(name_of(3, number), group_number(number), true));
    if (physical.empty() && entity > 0)
      all.push_back(mesh_.volume("volume " + std::to_string(entity), FaceGroup::no_number, false));
    return all;
  }

  /// Returns the number as MeshCollector takes it, which refuses those that are too large.
  static unsigned int group_number(const long long number) {
    return static_cast<unsigned int>(std::min(number, 2147483648LL));
  }

  /// Groups of a quadrilateral or of an edge, and volumes of a hexahedron.
  struct CellGroups {
    std::vector<std::size_t> of_face;
    std::vector<FaceGroup> of_edge;
    std::vector<std::size_t> of_volume;
    /// In formats before 4, which repeat an element for each of its physical groups.
    long long physical = 0, entity = 0;
  };

  void add_element(const long long type, const CellShape &shape, const long long element,
                   const CellGroups &groups) {
    if (shape.n_nodes == 0)
      refuse_type(type);
    std::array<long long, max_nodes> nodes{};
    for (unsigned int n = 0; n < shape.n_nodes; ++n)
      nodes[n] = tag("a node of an element");
    if (version_ < 4 && shape.kind == CellKind::hexahedron) {
      hexahedra_.push_back({{}, groups.physical, groups.entity, element});
      std::copy_n(nodes.begin(), 8, hexahedra_.back().nodes.begin());
    } else
      mesh_.add_cell(shape, element, nodes.data(), groups.of_face);
    for (const FaceGroup &group : groups.of_edge)
      mesh_.add_edge({nodes[0], nodes[1]}, group);
    for (const std::size_t volume : groups.of_volume)
      mesh_.add_to_volume(volume, element);
  }

  /// Adds each hexahedron of formats before 4 once, whatever the number of its physical groups.
  void add_hexahedra() {
    const CellShape shape{CellKind::hexahedron, 8};
    std::vector<std::size_t> order(hexahedra_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](const std::size_t a, const std::size_t b) {
      return hexahedra_[a].nodes < hexahedra_[b].nodes;
    });
    std::vector<bool> is_repeated(order.size(), false);
    long long number = 0; // of the hexahedron that a repeated one is
    for (std::size_t i = 0; i < order.size(); ++i) {
      const Hexahedron &before = hexahedra_[order[i > 0 ? i - 1 : 0]], &now = hexahedra_[order[i]];
      is_repeated[order[i]] = i > 0 && now.nodes == before.nodes && now.physical != before.physical;
      number = is_repeated[order[i]] ? number : now.number;
      for (const std::size_t volume : volumes(physical_groups(now.physical), now.entity))
        mesh_.add_to_volume(volume, number);
    }
    for (std::size_t i = 0; i < hexahedra_.size(); ++i)
      if (!is_repeated[i])
        mesh_.add_cell(shape, hexahedra_[i].number, hexahedra_[i].nodes.data(), {});
  }

  [[noreturn]] static void refuse_type(const long long type) {
    throw std::invalid_argument(
        "it has elements of Gmsh's type " + std::to_string(type) +
        "; allowed are hexahedra with eight nodes, type 5 (in Gmsh: Mesh.ElementOrder = 1)");
  }

  void read_nodes() {
    const std::size_t n =
        is_binary_ ? binary_count("the number of nodes", 28) : cursor_.count("the number of nodes", 8);
    for (std::size_t i = 0; i < n; ++i) {
      const long long node = number("the number of a node");
      add_node(node);
    }
  }

  void add_node(const long long node) {
    std::array<double, 3> position{};
    for (double &x : position)
      x = real("a finite coordinate of a node");
    mesh_.add_node(node, position);
  }

  void read_old_elements() {
    const std::size_t n = cursor_.count("the number of elements", 11);
    for (std::size_t i = 0; i < n; ++i) {
      const long long element = cursor_.integer("the number of an element"),
                      type = cursor_.integer("the type of an element");
      const long long physical = magnitude(cursor_.integer("the physical group of an element")),
                      entity = cursor_.integer("the entity of an element");
      const CellShape shape = gmsh_shape(type);
      if (cursor_.integer("the number of nodes of an element") != shape.n_nodes && shape.n_nodes > 0)
        cursor_.fail("the number of nodes of an element of type " + std::to_string(type) + ", " +
                     std::to_string(shape.n_nodes) + ",");
      add_element(type, shape, element, groups_of(shape, physical, entity));
    }
  }

  CellGroups groups_of(const CellShape &shape, const long long physical, const long long entity) {
    const std::vector<long long> all = physical_groups(physical);
    CellGroups groups{{}, {}, {}, physical, entity};
    if (shape.kind == CellKind::quadrilateral)
      groups.of_face = face_groups(all, entity);
    if (shape.kind == CellKind::line)
      groups.of_edge = edge_groups(all, entity);
    return groups;
  }
  /// Returns the physical groups of an element in formats before 4: one or none.
  static std::vector<long long> physical_groups(const long long number) {
    return number == 0 ? std::vector<long long>() : std::vector<long long>{number};
  }

  void read_elements() {
    const std::size_t n =
        is_binary_ ? binary_count("the number of elements", 8) : cursor_.count("the number of elements", 7);
    for (std::size_t i = 0; i < n;) {
      long long element = is_binary_ ? 0 : number("the number of an element");
      const long long type = number("the type of an element");
      const long long n_follow = is_binary_ ? number("the number of elements of one type") : 1;
      const long long n_tags = number("the number of tags of an element");
      constexpr long long max_tags = 1000000;
      if (n_follow < 1 || static_cast<unsigned long long>(n_follow) > n - i || n_tags < 0 ||
          n_tags > max_tags)
        throw std::invalid_argument("its elements from the " + std::to_string(i + 1) +
                                    ". on have counts that do not fit their number, " + std::to_string(n));
      const CellShape shape = gmsh_shape(type);
      for (long long follow = 0; follow < n_follow; ++follow, ++i) {
        if (is_binary_)
          element = number("the number of an element");
        std::array<long long, 2> tags{};
        for (long long t = 0; t < n_tags; ++t) {
          const long long value = number("a tag of an element");
          if (t < 2)
            tags[static_cast<std::size_t>(t)] = value;
        }
        const long long physical = magnitude(tags[0]);
        add_element(type, shape, element, groups_of(shape, physical, tags[1]));
      }
    }
  }

  /// Returns a count that stands as text in binary files of format 2.
  std::size_t binary_count(const char *const what, const std::size_t bytes_each) {
    const std::size_t n = cursor_.count(what, 1);
    cursor_.line();
    return cursor_.checked_count(what, n, bytes_each);
  }

  /// Numbers that a section announces, to be compared with what it has.
  struct Announced {
    std::size_t n_blocks = 0, n = 0;
    long long least = 0, most = 0;
  };
  Announced read_announced(const char *const what) {
    Announced announced;
    announced.n_blocks = count("the number of blocks", 6, 16);
    announced.n = count(what, 2, 8);
    if (version_ == 41) {
      announced.least = tag("the least number");
      announced.most = tag("the largest number");
    }
    return announced;
  }
  void check_number(const Announced &announced, const char *const what, const long long value) const {
    if (version_ == 41 && (value < announced.least || value > announced.most))
      throw std::invalid_argument(std::string(what) + " " + std::to_string(value) +
                                  " of it is outside the range from " + std::to_string(announced.least) +
                                  " to " + std::to_string(announced.most) + " that its section announces");
  }
  static void check_total(const std::size_t n, const std::size_t announced, const std::string &what) {
    if (n != announced)
      throw std::invalid_argument("its blocks have " + std::to_string(n) + " " + what + ", but " +
                                  std::to_string(announced) + " are announced");
  }

  void read_node_blocks() {
    const Announced announced = read_announced("the number of nodes");
    std::size_t n_read = 0;
    for (std::size_t block = 0; block < announced.n_blocks; ++block) {
      const long long first = number("an entity"), second = number("an entity");
      const long long dimension = version_ == 41 ? first : second;
      const long long is_parametric = number("0 or 1");
      if (dimension < 0 || dimension > 3 || is_parametric < 0 || is_parametric > 1)
        throw std::invalid_argument("block " + std::to_string(block + 1) +
                                    " of its nodes has a dimension that is "
                                    "not 0 to 3, or is neither parametric nor not");
      const std::size_t n = count("the number of nodes of a block", 8, 28);
      const long long n_parameters = is_parametric == 1 ? dimension : 0;
      std::vector<long long> tags;
      for (std::size_t i = 0; i < n && version_ == 41; ++i)
        tags.push_back(tag("the number of a node"));
      for (std::size_t i = 0; i < n; ++i) {
        const long long node = version_ == 41 ? tags[i] : number("the number of a node");
        check_number(announced, "node", node);
        add_node(node);
        for (long long p = 0; p < n_parameters; ++p)
          real("a parameter of a node");
      }
      n_read += n;
    }
    check_total(n_read, announced.n, "nodes");
  }

  /// Returns the physical groups of an entity of the geometry.
  std::vector<long long> physical_of(const std::size_t dimension, const long long entity) const {
    const auto found = physical_[dimension].find(entity);
    return found == physical_[dimension].end() ? std::vector<long long>() : found->second;
  }

  void read_element_blocks() {
    const Announced announced = read_announced("the number of elements");
    std::size_t n_read = 0;
    for (std::size_t block = 0; block < announced.n_blocks; ++block) {
      const long long first = number("an entity"), second = number("an entity");
      const long long dimension = version_ == 41 ? first : second, entity = version_ == 41 ? second : first;
      const long long type = number("the type of elements");
      const CellShape shape = gmsh_shape(type);
      if (shape.n_nodes == 0)
        refuse_type(type);
      const std::size_t n = count("the number of elements of a block", 4, 8);
      CellGroups groups;
      if (shape.kind == CellKind::line)
        groups.of_edge = edge_groups(physical_of(1, entity), entity);
      else if (shape.kind == CellKind::quadrilateral) {
        if (has_entities_ && (physical_[2].count(entity) == 0 || dimension != 2))
          throw std::invalid_argument("block " + std::to_string(block + 1) +
                                      " of its elements is on surface " + std::to_string(entity) +
                                      ", which $Entities does not have");
        groups.of_face = face_groups(physical_of(2, entity), entity);
      } else if (shape.kind == CellKind::hexahedron)
        groups.of_volume = volumes(physical_of(3, entity), entity);
      for (std::size_t i = 0; i < n; ++i) {
        const long long element = tag("the number of an element");
        check_number(announced, "element", element);
        add_element(type, shape, element, groups);
      }
      n_read += n;
    }
    check_total(n_read, announced.n, "elements");
  }

  MeshCursor cursor_;
  MeshCollector mesh_;
  std::set<std::string> sections_;
  int version_ = 0; ///< 1, 2, 40 or 41; 0: unknown
  bool is_binary_ = false, has_entities_ = false;
  std::int32_t last_ = 0; ///< the last number of four bytes
  /// Names of physical groups, by their dimension.
  std::array<std::map<long long, std::string>, 4> names_;
  /// Physical groups of the geometry's points, curves, surfaces and volumes.
  std::array<std::map<long long, std::vector<long long>>, 4> physical_;
  std::vector<Hexahedron> hexahedra_; ///< of formats before 4
};

} // namespace

MeshFormat gmsh_format() {
  return {"Gmsh", "Gmsh's MSH 1, 2, 4 (.msh)", &is_gmsh,
          [](const std::string &bytes, const FileAccess &) { return GmshReader(bytes).read(); }};
}

} // namespace billet
