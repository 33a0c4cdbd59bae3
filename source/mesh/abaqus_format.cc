// SPDX-License-Identifier: LGPL-2.1-or-later
// Decks of Abaqus and CalculiX: nodes, elements, sets and surfaces; what concerns the analysis is
// skipped.
#include "billet/mesh/abaqus_sets.h"
#include "billet/mesh/boundary_groups.h"
#include "billet/mesh/mesh_collector.h"
#include "billet/mesh/mesh_cursor.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <unordered_map>

namespace billet {

namespace {

bool is_abaqus(const std::string &bytes) {
  MeshCursor cursor(bytes);
  // LS-DYNA.
  return cursor.next_word().substr(0, 1) == "*" && lower_case(cursor.next_word()) != "*keyword";
}

constexpr auto flat_remedy =
    "; write the mesh of one part without an assembly (Abaqus/CAE: 'Do not use parts and "
    "assemblies in input files' in Edit Model Attributes)";

/// Returns the shape of a type of elements.
CellShape abaqus_shape(const std::string &type) {
  struct Family {
    const char *beginning;
    CellShape shape;
  };
  // The first that fits counts. Letters that follow a name say how it is integrated.
  static const std::vector<Family> families{{"c3d8", {CellKind::hexahedron, 8}},
                                            {"dc3d8", {CellKind::hexahedron, 8}},
                                            {"sc8r", {CellKind::hexahedron, 8}},
                                            {"css8", {CellKind::hexahedron, 8}},
                                            {"c3d20", {CellKind::second_order, 20}},
                                            {"c3d27", {CellKind::second_order, 27}},
                                            {"c3d10", {CellKind::second_order, 10}},
                                            {"c3d15", {CellKind::second_order, 15}},
                                            {"c3d4", {CellKind::tetrahedron, 4}},
                                            {"c3d6", {CellKind::wedge, 6}},
                                            {"sc6r", {CellKind::wedge, 6}},
                                            {"c3d5", {CellKind::pyramid, 5}},
                                            {"s4", {CellKind::quadrilateral, 4}},
                                            {"ds4", {CellKind::quadrilateral, 4}},
                                            {"m3d4", {CellKind::quadrilateral, 4}},
                                            {"r3d4", {CellKind::quadrilateral, 4}},
                                            {"sfm3d4", {CellKind::quadrilateral, 4}},
                                            {"cps4", {CellKind::quadrilateral, 4}},
                                            {"cpe4", {CellKind::quadrilateral, 4}},
                                            {"cax4", {CellKind::quadrilateral, 4}},
                                            {"s3", {CellKind::triangle, 3}},
                                            {"ds3", {CellKind::triangle, 3}},
                                            {"m3d3", {CellKind::triangle, 3}},
                                            {"r3d3", {CellKind::triangle, 3}},
                                            {"sfm3d3", {CellKind::triangle, 3}},
                                            {"cps3", {CellKind::triangle, 3}},
                                            {"cpe3", {CellKind::triangle, 3}},
                                            {"cax3", {CellKind::triangle, 3}},
                                            {"stri3", {CellKind::triangle, 3}},
                                            {"t3d2", {CellKind::line, 2}},
                                            {"t2d2", {CellKind::line, 2}},
                                            {"b31", {CellKind::line, 2}},
                                            {"b33", {CellKind::line, 2}},
                                            {"t3d3", {CellKind::ignored, 3}},
                                            {"b32", {CellKind::ignored, 3}},
                                            {"s6", {CellKind::ignored, 6}},
                                            {"stri65", {CellKind::ignored, 6}},
                                            {"m3d6", {CellKind::ignored, 6}},
                                            {"cps6", {CellKind::ignored, 6}},
                                            {"cpe6", {CellKind::ignored, 6}},
                                            {"s8r", {CellKind::ignored, 8}},
                                            {"m3d8", {CellKind::ignored, 8}},
                                            {"cps8", {CellKind::ignored, 8}},
                                            {"cpe8", {CellKind::ignored, 8}},
                                            {"mass", {CellKind::ignored, 1}},
                                            {"rotaryi", {CellKind::ignored, 1}},
                                            {"dcoup3d", {CellKind::ignored, 1}},
                                            {"spring1", {CellKind::ignored, 1}},
                                            {"spring", {CellKind::ignored, 2}},
                                            {"dashpot1", {CellKind::ignored, 1}},
                                            {"dashpot", {CellKind::ignored, 2}},
                                            {"gapuni", {CellKind::ignored, 2}},
                                            {"conn3d2", {CellKind::ignored, 2}}};
  for (const Family &family : families) {
    const std::string beginning = family.beginning;
    if (type.compare(0, beginning.size(), beginning) == 0 &&
        type.find_first_of("012346789", beginning.size()) == std::string::npos)
      return family.shape;
  }
  return {};
}

/// Nodes of the faces S1 to S6 of a hexahedron.
constexpr unsigned int face_nodes[6][4] = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                                           {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};

std::string without_quotes(const std::string_view text) {
  return std::string(
      text.size() > 1 && text.front() == '"' && text.back() == '"' ? text.substr(1, text.size() - 2) : text);
}

std::vector<std::string_view> split(const std::string_view text) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    parts.push_back(trimmed(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  while (!parts.empty() && parts.back().empty())
    parts.pop_back();
  return parts;
}

/// Keyword with its parameters, names in lower case.
struct Keyword {
  std::string name;
  std::map<std::string, std::string> parameters;

  explicit Keyword(const std::string_view line) {
    for (const std::string_view part : split(line)) {
      if (name.empty()) {
        for (const char c : lower_case(part))
          if (c != ' ' || name.back() != ' ')
            name += c;
        continue;
      }
      const std::size_t equals = std::min(part.find('='), part.size());
      parameters[lower_case(trimmed(part.substr(0, equals)))] =
          equals == part.size() ? "" : without_quotes(trimmed(part.substr(equals + 1)));
    }
  }
  bool has(const std::string &parameter) const { return parameters.count(parameter) > 0; }
  std::string get(const std::string &parameter) const {
    return has(parameter) ? parameters.at(parameter) : "";
  }
};

/// Part of a surface: a set of elements or one element, and the label of its face.
struct SurfaceItem {
  std::string elements, label;
};

struct Surface {
  std::string name;
  bool of_nodes;
  std::vector<SurfaceItem> items;
};

/// Lines of one file of a deck.
class DeckLines {
public:
  explicit DeckLines(const std::string &bytes) : cursor_(bytes) {}

  /// Returns the next line that is no comment and not empty. Whether there is one.
  bool peek(std::string_view &line) {
    while (!has_line_ && cursor_.remaining() > 0) {
      line_ = cursor_.line();
      has_line_ = !line_.empty() && line_.substr(0, 2) != "**";
    }
    line = line_;
    return has_line_;
  }
  void take() { has_line_ = false; }
  /// Takes the next line with data. Whether one stands before the next keyword.
  bool data(std::string_view &line) {
    if (!peek(line) || line.front() == '*')
      return false;
    take();
    return true;
  }
  [[noreturn]] void refuse(const std::string &fault) const { cursor_.refuse(fault); }

private:
  MeshCursor cursor_;
  std::string_view line_;
  bool has_line_ = false;
};

/// Numbers of groups: a name that is a number has this one, the others count from 1 beside these.
class GroupNumbers {
public:
  /// Keeps the number for this name if it is one. All names are reserved before the first number is
  /// asked for.
  void reserve(const std::string &name) {
    if (const std::optional<unsigned int> id = id_of_name(name))
      reserved_.insert(*id);
  }
  unsigned int number(const std::string &name) {
    if (const std::optional<unsigned int> id = id_of_name(name))
      return *id;
    while (reserved_.count(++last_) > 0) {
    }
    return last_;
  }

private:
  std::set<unsigned int> reserved_;
  unsigned int last_ = 0;
};

/// Reads a deck with the files that it includes.
class AbaqusReader {
public:
  explicit AbaqusReader(const FileAccess &access)
      : access_(access), node_sets_("node"), element_sets_("element") {}

  MeshFile read(const std::string &bytes) {
    read_file(bytes);
    reserve_numbers();
    add_surfaces();
    add_shells();
    add_volumes();
    add_node_sets();
    return mesh_.finish();
  }

private:
  struct Element {
    CellKind kind;
    unsigned int hexahedron; ///< index, of hexahedra only
    std::array<long long, 8> nodes;
  };

  /// Place in an assembly that the reader has reached.
  struct Assembly {
    unsigned int n_parts = 0, n_instances = 0;
    bool is_open = false, is_in_instance = false;
    std::array<double, 3> translation{};
  };

  void read_file(const std::string &bytes) {
    constexpr std::size_t max_files = 10000, max_depth = 20;
    if (++n_files_ > max_files || depth_ > max_depth)
      throw std::invalid_argument("it includes too many files, or itself");
    n_bytes_ += bytes.size();
    ++depth_;
    DeckLines lines(bytes);
    std::string_view line;
    while (lines.peek(line)) {
      if (line.front() != '*')
        lines.refuse("data stand where a keyword should be");
      lines.take();
      std::string words(line);
      while (words.back() == ',' && lines.peek(line) && line.front() != '*') {
        words += line;
        lines.take();
      }
      const Keyword keyword(std::string_view(words).substr(1));
      read_section(keyword, lines);
      while (lines.data(line)) {
      }
    }
    --depth_;
  }

  void read_section(const Keyword &keyword, DeckLines &lines) {
    const std::string &name = keyword.name;
    const bool is_outside = assembly_.is_open && !assembly_.is_in_instance;
    static const std::set<std::string> without_content{"heading",  "preprint", "part",
                                                       "end part", "end step", "end instance"};
    if (name == "include")
      include(keyword, lines);
    else if (name == "node" && !is_outside)
      read_nodes(keyword, lines);
    else if (name == "element" && !is_outside)
      read_elements(keyword, lines);
    else if (name == "nset" || name == "elset")
      read_set(keyword, lines, name == "nset" ? node_sets_ : element_sets_);
    else if (name == "surface")
      read_surface(keyword, lines);
    else if (name == "part")
      ++assembly_.n_parts;
    else if (name == "assembly" || name == "end assembly")
      assembly_.is_open = name == "assembly";
    else if (name == "instance")
      read_instance(lines);
    else if (name == "end instance")
      assembly_.is_in_instance = false;
    else if (name == "ngen" || name == "nfill" || name == "elgen" || name == "ncopy" || name == "elcopy" ||
             name == "system" || name == "nmap")
      lines.refuse("*" + name +
                   " makes or moves nodes or elements, which is not read; write them out (*NODE, "
                   "*ELEMENT)");
    else if (without_content.count(name) == 0 && name != "node" && name != "element")
      leave_out(keyword);
  }

  void leave_out(const Keyword &keyword) {
    if (keyword.name == "solid section" || keyword.name == "shell section")
      sections_.insert(lower_case(keyword.get("elset")));
    mesh_.leave_unread(keyword.name);
  }

  void include(const Keyword &keyword, DeckLines &lines) {
    const std::string name = keyword.get("input");
    if (name.empty())
      lines.refuse("*INCLUDE should have INPUT=, the name of a file");
    std::string bytes;
    try {
      bytes = access_(name);
    } catch (const std::invalid_argument &error) {
      lines.refuse("*INCLUDE fails: " + std::string(error.what()));
    }
    try {
      read_file(bytes);
    } catch (const std::invalid_argument &error) {
      throw std::invalid_argument("it includes '" + name + "', and " + error.what());
    }
  }

  static long long integer(const std::string_view text, const char *const what, const DeckLines &lines) {
    long long value = 0;
    if (!is_integer(text, value))
      lines.refuse("'" + std::string(text.substr(0, 20)) + "' stands where " + what + " should be");
    return value;
  }
  static double real(const std::string_view text, const char *const what, const DeckLines &lines) {
    double value = 0.;
    if (!text.empty() && !is_real(text, value))
      lines.refuse("'" + std::string(text.substr(0, 20)) + "' stands where " + what + " should be");
    return value;
  }

  /// Refuses a second part: its numbers begin anew.
  void check_parts(const DeckLines &lines) const {
    if (assembly_.n_parts > 1 || assembly_.n_instances > 1)
      lines.refuse("a second part or instance begins" + std::string(flat_remedy));
  }

  /// Reads the lines of a keyword: those of the file that its INPUT names, and those below it.
  template <class ReadLines>
  void read_lines(const Keyword &keyword, DeckLines &lines, const ReadLines &read_from) {
    const std::string name = keyword.get("input");
    if (!name.empty()) {
      std::string bytes;
      try {
        bytes = access_(name);
      } catch (const std::invalid_argument &error) {
        lines.refuse("INPUT of *" + keyword.name + " fails: " + std::string(error.what()));
      }
      n_bytes_ += bytes.size();
      DeckLines data(bytes);
      try {
        read_from(data);
        std::string_view rest;
        if (data.peek(rest))
          data.refuse("a keyword stands where the data of *" + keyword.name + " should be");
      } catch (const std::invalid_argument &error) {
        throw std::invalid_argument("it takes data from '" + name + "', and " + error.what());
      }
    }
    read_from(lines);
  }

  void read_nodes(const Keyword &keyword, DeckLines &lines) {
    check_parts(lines);
    if (keyword.has("system") && lower_case(keyword.get("system")) != "r")
      lines.refuse("*NODE has the system of coordinates " + keyword.get("system") +
                   "; allowed are Cartesian ones, R");
    const std::string set = keyword.get("nset");
    if (!set.empty())
      node_sets_.open(set);
    read_lines(keyword, lines, [&](DeckLines &from) { read_node_lines(set, from); });
  }

  void read_node_lines(const std::string &set, DeckLines &lines) {
    std::string_view line;
    while (lines.data(line)) {
      const auto parts = split(line);
      if (parts.empty())
        lines.refuse("a node should be given");
      const long long number = integer(parts[0], "the number of a node", lines);
      std::array<double, 3> position{};
      for (std::size_t i = 1; i < parts.size() && i <= 3; ++i)
        position[i - 1] =
            real(parts[i], "a finite coordinate of a node", lines) + assembly_.translation[i - 1];
      for (std::size_t i = std::max<std::size_t>(parts.size(), 1); i <= 3; ++i)
        position[i - 1] = assembly_.translation[i - 1];
      mesh_.add_node(number, position);
      ++n_nodes_;
      if (!set.empty())
        node_sets_.add(set, number);
    }
  }

  void read_elements(const Keyword &keyword, DeckLines &lines) {
    check_parts(lines);
    const std::string type = keyword.get("type"), set = keyword.get("elset");
    const CellShape shape = abaqus_shape(lower_case(type));
    if (shape.n_nodes == 0)
      lines.refuse(
          "elements have the type '" + type.substr(0, 20) +
          "'; allowed are hexahedra with eight nodes, such as C3D8 and C3D8R, and shells such as S4 on "
          "their faces");
    if (!set.empty())
      element_sets_.open(set);
    read_lines(keyword, lines, [&](DeckLines &from) { read_element_lines(type, shape, set, from); });
  }

  void read_element_lines(const std::string &type, const CellShape &shape, const std::string &set,
                          DeckLines &lines) {
    std::string_view line;
    while (lines.data(line)) {
      std::vector<long long> numbers;
      while (true) {
        for (const std::string_view part : split(line))
          numbers.push_back(integer(part, "a number of an element or its node", lines));
        if (numbers.size() > shape.n_nodes)
          break;
        if (!lines.data(line))
          lines.refuse("an element of type " + type + " has fewer than " + std::to_string(shape.n_nodes) +
                       " nodes");
      }
      if (numbers.size() != shape.n_nodes + 1)
        lines.refuse("element " + std::to_string(numbers[0]) + " has " + std::to_string(numbers.size() - 1) +
                     " nodes, where its type " + type + " has " + std::to_string(shape.n_nodes));
      add_element(shape, lower_case(type), numbers);
      if (!set.empty())
        element_sets_.add(set, numbers[0]);
    }
  }

  void add_element(const CellShape &shape, const std::string &type, const std::vector<long long> &numbers) {
    Element element{shape.kind, 0, {}};
    std::copy_n(numbers.begin() + 1, std::min<std::size_t>(8, shape.n_nodes), element.nodes.begin());
    if (shape.kind == CellKind::hexahedron)
      element.hexahedron = n_hexahedra_++;
    if (shape.kind == CellKind::ignored)
      mesh_.leave_unread("element, type=" + type);
    if (!elements_.emplace(numbers[0], element).second)
      throw std::invalid_argument("element " + std::to_string(numbers[0]) + " of it is given twice");
    mesh_.add_cell(shape, numbers[0], numbers.data() + 1, {});
  }

  void read_instance(DeckLines &lines) {
    assembly_.is_in_instance = true;
    ++assembly_.n_instances;
    std::string_view line;
    for (unsigned int i = 0; lines.data(line); ++i) {
      if (i > 0)
        lines.refuse("the instance of a part is rotated" + std::string(flat_remedy));
      const auto parts = split(line);
      std::array<double, 3> translation{};
      for (std::size_t c = 0; c < std::min<std::size_t>(3, parts.size()); ++c)
        translation[c] = real(parts[c], "a translation", lines);
      for (auto &position : mesh_.mesh().positions)
        for (std::size_t c = 0; c < 3; ++c)
          position[c] += translation[c];
      assembly_.translation = translation;
    }
    if (assembly_.n_instances > 1)
      check_parts(lines);
  }

  /// Returns the name of a set without the instance in front of it.
  static std::string set_name(const std::string_view text) {
    const std::string name = without_quotes(text);
    const std::size_t dot = name.find('.');
    return dot == std::string::npos ? name : name.substr(dot + 1);
  }

  void read_set(const Keyword &keyword, DeckLines &lines, AbaqusSets &sets) {
    const std::string name = keyword.get(keyword.name);
    if (name.empty())
      lines.refuse("*" + keyword.name + " should have a name, " + keyword.name + "=...");
    // Points of an assembly itself, such as reference points, have numbers of their own.
    if (assembly_.is_open && !assembly_.is_in_instance && !keyword.has("instance")) {
      sets.leave_out(name);
      return;
    }
    sets.open(name);
    if (keyword.name == "nset" && keyword.has("elset"))
      nodes_of_elements_.emplace_back(name, keyword.get("elset"));
    std::string_view line;
    while (lines.data(line)) {
      const auto parts = split(line);
      if (keyword.has("generate")) {
        if (parts.size() < 2 || parts.size() > 3)
          lines.refuse("a range should be: first, last, step");
        sets.add_range(name, integer(parts[0], "the first of a range", lines),
                       integer(parts[1], "the last of a range", lines),
                       parts.size() == 3 ? integer(parts[2], "the step of a range", lines) : 1);
        continue;
      }
      for (const std::string_view part : parts) {
        long long member = 0;
        if (part.empty())
          continue;
        if (is_integer(part, member))
          sets.add(name, member);
        else
          sets.add_set(name, set_name(part));
      }
    }
  }

  void read_surface(const Keyword &keyword, DeckLines &lines) {
    const std::string type = keyword.has("type") ? lower_case(keyword.get("type")) : "element";
    if (type != "element" && type != "node") { // rigid surfaces and cuts are no faces of elements
      mesh_.leave_unread("surface, type=" + type);
      return;
    }
    Surface surface{keyword.get("name"), type == "node", {}};
    if (surface.name.empty())
      lines.refuse("*SURFACE should have NAME=...");
    if (keyword.has("combine") || keyword.has("crop"))
      lines.refuse("surface '" + surface.name + "' is made of others, which is not read; list its elements");
    std::string_view line;
    while (lines.data(line)) {
      const auto parts = split(line);
      if (!parts.empty())
        surface.items.push_back(
            {set_name(parts[0]), parts.size() > 1 && !surface.of_nodes ? lower_case(parts[1]) : ""});
    }
    surfaces_.push_back(surface);
  }

  std::size_t max_members() const { return 1000 + 16 * n_bytes_; }
  /// Counts members of surfaces: those of a damaged file may be many times its size.
  void count_member() {
    if (++n_members_ > max_members())
      throw std::invalid_argument("its surfaces have more than " + std::to_string(max_members()) +
                                  " faces in all, too many for a file of this size");
  }
  const std::vector<long long> &elements_of(const std::string &set) {
    return element_sets_.members(
        set, [this](const long long number) { return elements_.count(number) > 0; }, elements_.size(),
        max_members());
  }
  const std::vector<long long> &nodes_of(const std::string &set) {
    return node_sets_.members(
        set, [this](const long long number) { return mesh_.has_node(number); }, n_nodes_, max_members());
  }
  /// Returns what an item of a surface names: one number, or the members of a set.
  template <class Members>
  std::vector<long long> resolve(const std::string &item, const Members &members) const {
    long long number = 0;
    return is_integer(item, number) ? std::vector<long long>{number} : members(item);
  }
  void reserve_numbers() {
    for (const Surface &surface : surfaces_)
      numbers_.reserve(surface.name);
    for (const AbaqusSets *const sets : {&element_sets_, &node_sets_})
      for (const std::string &name : sets->names())
        numbers_.reserve(name);
  }
  /// Returns the index of a group; adds it if there is none.
  std::size_t group(const std::string &kind, const std::string &name) {
    const auto [known, is_new] = groups_.emplace(std::pair(kind, lower_case(name)), 0);
    if (is_new)
      known->second = mesh_.group(name, numbers_.number(name), kind);
    return known->second;
  }

  void add_surfaces() {
    for (const Surface &surface : surfaces_) {
      const std::size_t index = group("surface", surface.name);
      if (surface.of_nodes) {
        GroupedSet nodes{{}, index};
        for (const SurfaceItem &item : surface.items)
          for (const long long node :
               resolve(item.elements, [&](const auto &set) { return nodes_of(set); })) {
            count_member();
            nodes.members.push_back(mesh_.node_index(node, "a surface with node", node));
          }
        mesh_.mesh().node_sets.push_back(nodes);
        continue;
      }
      GroupedSet whole{{}, index};
      for (const SurfaceItem &item : surface.items)
        for (const long long number :
             resolve(item.elements, [&](const auto &set) { return elements_of(set); }))
          add_item(surface, item.label, number, whole);
      if (!whole.members.empty())
        mesh_.mesh().element_sets.push_back(whole);
    }
  }

  /// Adds the face of an element; without a label all its exterior faces, by `whole`.
  void add_item(const Surface &surface, const std::string &label, const long long number, GroupedSet &whole) {
    const auto found = elements_.find(number);
    if (found == elements_.end())
      throw std::invalid_argument("its surface '" + surface.name + "' names element " +
                                  std::to_string(number) + ", which is missing");
    count_member();
    const Element &element = found->second;
    if (element.kind == CellKind::quadrilateral && n_hexahedra_ == 0)
      return add_edges(surface, label, number, element, whole.group);
    const bool is_side =
        label.empty() || label == "spos" || label == "sneg" || label == "s1" || label == "s2";
    if (element.kind == CellKind::quadrilateral && is_side)
      mesh_.add_face({element.nodes[0], element.nodes[1], element.nodes[2], element.nodes[3]}, whole.group);
    else if (element.kind == CellKind::hexahedron && label.empty())
      whole.members.push_back(element.hexahedron);
    else if (element.kind == CellKind::hexahedron && label.size() == 2 && label[0] == 's' &&
             label[1] >= '1' && label[1] <= '6') {
      std::array<long long, 4> nodes{};
      for (unsigned int i = 0; i < 4; ++i)
        nodes[i] = element.nodes[face_nodes[label[1] - '1'][i]];
      mesh_.add_face(nodes, whole.group);
    } else if (element.kind == CellKind::hexahedron || element.kind == CellKind::quadrilateral)
      throw std::invalid_argument("its surface '" + surface.name + "' names the side '" + label.substr(0, 9) +
                                  "' of element " + std::to_string(number) +
                                  "; allowed are S1 to S6 of hexahedra, SPOS and SNEG of shells");
  }

  /// Adds an edge of an element of a two-dimensional mesh; without a label all of them.
  void add_edges(const Surface &surface, const std::string &label, const long long number,
                 const Element &element, const std::size_t group) {
    const bool has_side =
        label.size() == 2 && (label[0] == 's' || label[0] == 'e') && label[1] >= '1' && label[1] <= '4';
    if (!has_side && !label.empty())
      throw std::invalid_argument("its surface '" + surface.name + "' names the side '" + label.substr(0, 9) +
                                  "' of element " + std::to_string(number) +
                                  "; allowed are S1 to S4 of two-dimensional elements");
    const FaceGroup of_edge = mesh_.mesh().groups[group];
    for (std::size_t side = 0; side < 4; ++side)
      if (!has_side || label[1] == static_cast<char>('1' + side))
        mesh_.add_edge({element.nodes[side], element.nodes[(side + 1) % 4]}, of_edge);
  }

  /// Sets with shells are groups of faces; in a two-dimensional mesh sets with trusses or beams are
  /// groups of edges.
  void add_shells() {
    for (const std::string &name : element_sets_.names()) {
      std::vector<const Element *> shells, lines;
      for (const long long number : elements_of(name)) {
        const Element &element = elements_.at(number);
        if (element.kind == CellKind::quadrilateral)
          shells.push_back(&element);
        if (element.kind == CellKind::line && n_hexahedra_ == 0)
          lines.push_back(&element);
      }
      if (shells.empty() && lines.empty())
        continue;
      const std::size_t index = group("elset", name);
      for (const Element *const shell : shells)
        mesh_.add_face({shell->nodes[0], shell->nodes[1], shell->nodes[2], shell->nodes[3]}, index);
      const FaceGroup of_edge = mesh_.mesh().groups[index];
      for (const Element *const line : lines)
        mesh_.add_edge({line->nodes[0], line->nodes[1]}, of_edge);
    }
  }

  /// Sets with hexahedra are volumes.
  void add_volumes() {
    for (const std::string &name : element_sets_.names()) {
      const bool is_part = sections_.count(lower_case(name)) > 0;
      for (const long long number : elements_of(name))
        if (elements_.at(number).kind == CellKind::hexahedron)
          mesh_.add_to_volume(mesh_.volume(name, FaceGroup::no_number, is_part), number);
    }
  }

  void add_node_sets() {
    for (const auto &[name, elements] : nodes_of_elements_)
      for (const long long number : elements_of(elements)) {
        const Element &element = elements_.at(number);
        const std::size_t n = element.kind == CellKind::hexahedron      ? 8
                              : element.kind == CellKind::quadrilateral ? 4
                                                                        : 0;
        for (std::size_t i = 0; i < n; ++i) {
          count_member();
          node_sets_.add(name, element.nodes[i]);
        }
      }
    for (const std::string &name : node_sets_.names()) {
      GroupedSet nodes{{}, group("nset", name)};
      for (const long long node : nodes_of(name))
        nodes.members.push_back(mesh_.node_index(node, "a set with node", node));
      mesh_.mesh().node_sets.push_back(nodes);
    }
  }

  const FileAccess &access_;
  MeshCollector mesh_;
  AbaqusSets node_sets_, element_sets_;
  std::unordered_map<long long, Element> elements_;
  std::vector<Surface> surfaces_;
  /// Pairs of a set of nodes and a set of elements.
  std::vector<std::pair<std::string, std::string>> nodes_of_elements_;
  /// Index by kind and by name in lower case.
  std::map<std::pair<std::string, std::string>, std::size_t> groups_;
  std::set<std::string> sections_; ///< sets of elements with a section, in lower case
  GroupNumbers numbers_;
  std::size_t n_bytes_ = 0, n_files_ = 0, n_nodes_ = 0, n_members_ = 0, depth_ = 0;
  unsigned int n_hexahedra_ = 0;
  Assembly assembly_;
};

} // namespace

MeshFormat abaqus_format() {
  return {
      "Abaqus", "decks of Abaqus and CalculiX (.inp)", &is_abaqus,
      [](const std::string &bytes, const FileAccess &access) { return AbaqusReader(access).read(bytes); }};
}

} // namespace billet
