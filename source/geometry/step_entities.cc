// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/geometry/step_entities.h"

#include "billet/printable.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace billet {

namespace {

/// Role of an entity for those that refer to it.
enum class Kind {
  unknown, ///< none of the rules
  complex, ///< with parts of several types, such as rational splines
  point,
  direction,
  vector,
  axes,
  curve,
  parameter_curve, ///< on a surface
  surface,
  representation,
  vertex,
  edge,
  oriented_edge,
  loop,
  bound,
  face,
  shell,
  solid
};

const char *name_of(const Kind kind) {
  switch (kind) {
  case Kind::unknown:
  case Kind::complex:
    break;
  case Kind::point:
    return "a point";
  case Kind::direction:
    return "a direction";
  case Kind::vector:
    return "a vector";
  case Kind::axes:
    return "axes";
  case Kind::curve:
  case Kind::parameter_curve:
    return "a curve";
  case Kind::surface:
    return "a surface";
  case Kind::representation:
    return "a representation";
  case Kind::vertex:
    return "a vertex";
  case Kind::edge:
    return "an edge";
  case Kind::oriented_edge:
    return "an oriented edge";
  case Kind::loop:
    return "a loop";
  case Kind::bound:
    return "a bound of a face";
  case Kind::face:
    return "a face";
  case Kind::shell:
    return "a shell";
  case Kind::solid:
    return "a solid";
  }
  return "another entity";
}

/// Entity of shapes. It has the number of its parameters and which of them, counted from 0, are
/// lengths > 0. It has the kinds of those that refer to entities, alone or in a list. Source: ISO
/// 10303-42, sections 4 and 5.
struct EntityRule {
  Kind kind;
  std::size_t n_parameters;
  std::vector<std::size_t> lengths = {};
  std::vector<std::pair<std::size_t, Kind>> references = {};
};

const std::unordered_map<std::string_view, EntityRule> &rules() {
  static const std::unordered_map<std::string_view, EntityRule> table{
      {"CARTESIAN_POINT", {Kind::point, 2}},
      {"DIRECTION", {Kind::direction, 2}},
      {"VECTOR", {Kind::vector, 3, {}, {{1, Kind::direction}}}},
      {"AXIS1_PLACEMENT", {Kind::axes, 3, {}, {{1, Kind::point}, {2, Kind::direction}}}},
      {"AXIS2_PLACEMENT_2D", {Kind::axes, 3, {}, {{1, Kind::point}, {2, Kind::direction}}}},
      {"AXIS2_PLACEMENT_3D",
       {Kind::axes, 4, {}, {{1, Kind::point}, {2, Kind::direction}, {3, Kind::direction}}}},
      {"LINE", {Kind::curve, 3, {}, {{1, Kind::point}, {2, Kind::vector}}}},
      {"CIRCLE", {Kind::curve, 3, {2}, {{1, Kind::axes}}}},
      {"ELLIPSE", {Kind::curve, 4, {2, 3}, {{1, Kind::axes}}}},
      {"HYPERBOLA", {Kind::curve, 4, {2, 3}, {{1, Kind::axes}}}},
      {"PARABOLA", {Kind::curve, 3, {}, {{1, Kind::axes}}}},
      {"POLYLINE", {Kind::curve, 2, {}, {{1, Kind::point}}}},
      {"TRIMMED_CURVE", {Kind::curve, 6, {}, {{1, Kind::curve}}}},
      {"B_SPLINE_CURVE_WITH_KNOTS", {Kind::curve, 9, {}, {{2, Kind::point}}}},
      {"SURFACE_CURVE", {Kind::curve, 4, {}, {{1, Kind::curve}}}},
      {"SEAM_CURVE", {Kind::curve, 4, {}, {{1, Kind::curve}}}},
      {"INTERSECTION_CURVE", {Kind::curve, 4, {}, {{1, Kind::curve}}}},
      {"PCURVE", {Kind::parameter_curve, 3, {}, {{1, Kind::surface}, {2, Kind::representation}}}},
      {"DEFINITIONAL_REPRESENTATION", {Kind::representation, 3}},
      {"PLANE", {Kind::surface, 2, {}, {{1, Kind::axes}}}},
      {"CYLINDRICAL_SURFACE", {Kind::surface, 3, {2}, {{1, Kind::axes}}}},
      {"CONICAL_SURFACE", {Kind::surface, 4, {}, {{1, Kind::axes}}}},
      {"SPHERICAL_SURFACE", {Kind::surface, 3, {2}, {{1, Kind::axes}}}},
      {"TOROIDAL_SURFACE", {Kind::surface, 4, {2, 3}, {{1, Kind::axes}}}},
      {"SURFACE_OF_LINEAR_EXTRUSION", {Kind::surface, 3, {}, {{1, Kind::curve}, {2, Kind::vector}}}},
      {"SURFACE_OF_REVOLUTION", {Kind::surface, 3, {}, {{1, Kind::curve}, {2, Kind::axes}}}},
      {"B_SPLINE_SURFACE_WITH_KNOTS", {Kind::surface, 13, {}, {{3, Kind::point}}}},
      {"RECTANGULAR_TRIMMED_SURFACE", {Kind::surface, 7, {}, {{1, Kind::surface}}}},
      {"VERTEX_POINT", {Kind::vertex, 2, {}, {{1, Kind::point}}}},
      {"EDGE_CURVE", {Kind::edge, 5, {}, {{1, Kind::vertex}, {2, Kind::vertex}, {3, Kind::curve}}}},
      {"ORIENTED_EDGE", {Kind::oriented_edge, 5, {}, {{3, Kind::edge}}}},
      {"EDGE_LOOP", {Kind::loop, 2, {}, {{1, Kind::oriented_edge}}}},
      {"VERTEX_LOOP", {Kind::loop, 2, {}, {{1, Kind::vertex}}}},
      {"POLY_LOOP", {Kind::loop, 2, {}, {{1, Kind::point}}}},
      {"FACE_BOUND", {Kind::bound, 3, {}, {{1, Kind::loop}}}},
      {"FACE_OUTER_BOUND", {Kind::bound, 3, {}, {{1, Kind::loop}}}},
      {"ADVANCED_FACE", {Kind::face, 4, {}, {{1, Kind::bound}, {2, Kind::surface}}}},
      {"FACE_SURFACE", {Kind::face, 4, {}, {{1, Kind::bound}, {2, Kind::surface}}}},
      {"CLOSED_SHELL", {Kind::shell, 2, {}, {{1, Kind::face}}}},
      {"OPEN_SHELL", {Kind::shell, 2, {}, {{1, Kind::face}}}},
      {"MANIFOLD_SOLID_BREP", {Kind::solid, 2, {}, {{1, Kind::shell}}}},
      {"SHELL_BASED_SURFACE_MODEL", {Kind::solid, 2, {}, {{1, Kind::shell}}}}};
  return table;
}

struct Entity {
  std::uint64_t name;
  Kind kind = Kind::unknown;
  std::string_view type = {}; ///< its keyword; empty if it is complex
  std::size_t n_coordinates = 0;
  /// Names of entities, and what these should be; unknown if no rule says that.
  std::vector<std::pair<std::uint64_t, Kind>> references = {};
};

constexpr auto blanks = " \t\r\n\f\v";

/// Reads the entities of a file. Throws std::invalid_argument at the first fault.
class EntityReader {
public:
  explicit EntityReader(const std::string &text) : text_(text) {}

  std::vector<Entity> read() {
    std::vector<Entity> entities;
    while (at_ < text_.size())
      if (text_[at_] == '\'')
        skip_text();
      else if (text_.compare(at_, 2, "/*") == 0)
        skip_to("*/", 2);
      else if (text_[at_] == '#')
        read_entity(entities);
      else
        ++at_;
    return entities;
  }

private:
  /// Parameter, as far as it matters here.
  struct Parameter {
    bool is_number = false, is_list = false;
    double value = 0.;
    std::vector<double> numbers = {};           ///< of a list
    std::vector<std::uint64_t> references = {}; ///< of it, or of lists in it
  };

  void read_entity(std::vector<Entity> &entities) {
    ++at_;
    const std::uint64_t name = digits();
    if (next() != '=')
      return; // outside of the data
    ++at_;
    entity_ = name;
    entities.push_back({name});
    if (next() == '(') { // a complex entity, of which each part has some of the parameters
      ++at_;
      entities.back().kind = Kind::complex;
      while (next() != ')') {
        keyword();
        for (const Parameter &parameter : parameters(0))
          add_references(parameter, Kind::unknown, entities.back());
      }
      ++at_;
    } else if (next() == '<')
      return; // one of another file
    else {
      const std::string_view type = keyword();
      check(type, parameters(0), entities.back());
    }
    if (next() != ';')
      refuse("has no ';' at its end");
  }

  static void add_references(const Parameter &parameter, const Kind kind, Entity &entity) {
    for (const std::uint64_t name : parameter.references)
      entity.references.emplace_back(name, kind);
  }

  void check(const std::string_view type, const std::vector<Parameter> &parameters, Entity &entity) const {
    const auto rule = rules().find(type);
    entity.type = type;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      Kind kind = Kind::unknown;
      if (rule != rules().end())
        for (const auto &[place, expected] : rule->second.references)
          kind = place == i ? expected : kind;
      add_references(parameters[i], kind, entity);
    }
    if (rule == rules().end())
      return;
    entity.kind = rule->second.kind;
    const std::string word(type);
    if (parameters.size() != rule->second.n_parameters)
      refuse("has " + std::to_string(parameters.size()) + " parameters, where " + word + " has " +
             std::to_string(rule->second.n_parameters));
    for (const std::size_t i : rule->second.lengths)
      if (!(parameters[i].is_number && parameters[i].value > 0.))
        refuse("is a " + word + " whose radius is no number > 0");
    for (const Parameter &parameter : parameters) {
      check_size(parameter.value);
      for (const double value : parameter.numbers)
        check_size(value);
    }
    if (entity.kind == Kind::point || entity.kind == Kind::direction) {
      entity.n_coordinates = parameters[1].numbers.size();
      if (!parameters[1].is_list || entity.n_coordinates < 1 || entity.n_coordinates > 3)
        refuse("is a " + word + " with " + std::to_string(entity.n_coordinates) + " coordinates");
      const auto is_zero = [](const double x) { return x == 0.; };
      if (type == "DIRECTION" &&
          std::all_of(parameters[1].numbers.begin(), parameters[1].numbers.end(), is_zero))
        refuse("is a DIRECTION whose components are all zero");
    }
  }

  void check_size(const double value) const {
    constexpr double max_value = 1e60; // as in scenes
    if (!(std::abs(value) <= max_value))
      refuse("has a number beyond 1e60");
  }

  /// Reads a list of parameters in brackets.
  std::vector<Parameter> parameters(const unsigned int depth) {
    constexpr unsigned int max_depth = 50;
    if (next() != '(' || depth > max_depth)
      refuse("has no list of parameters, or too many lists in lists");
    ++at_;
    std::vector<Parameter> all;
    if (next() == ')') {
      ++at_;
      return all;
    }
    while (true) {
      all.push_back(parameter(depth));
      const char c = next();
      if (c != ',' && c != ')')
        refuse("has '" + excerpt() + "' where ',' or ')' should be");
      ++at_;
      if (c == ')')
        return all;
    }
  }

  Parameter parameter(const unsigned int depth) {
    Parameter result;
    const char c = next();
    if (c == '\'')
      skip_text();
    else if (c == '"')
      skip_to("\"", 1);
    else if (c == '.' && at_ + 1 < text_.size() && std::isalpha(static_cast<unsigned char>(text_[at_ + 1])))
      skip_to(".", 1);
    else if (c == '$' || c == '*')
      ++at_;
    else if (c == '#') {
      ++at_;
      result.references.push_back(digits());
    } else if (c == '(') {
      result.is_list = true;
      for (const Parameter &member : parameters(depth + 1)) {
        if (member.is_number)
          result.numbers.push_back(member.value);
        result.references.insert(result.references.end(), member.references.begin(), member.references.end());
      }
    } else if (is_number(result.value))
      result.is_number = true;
    else { // a value with its type
      const std::size_t begin = at_;
      if (keyword().empty() || next() != '(') {
        at_ = begin;
        refuse("has '" + excerpt() + "' where a number, a text or a reference should be");
      }
      const std::vector<Parameter> typed = parameters(depth + 1);
      if (typed.size() == 1)
        result = typed[0];
    }
    return result;
  }

  /// Whether a number follows, which is taken then.
  bool is_number(double &value) {
    std::size_t end = at_;
    const auto skip_digits = [&] {
      const std::size_t begin = end;
      while (end < text_.size() && std::isdigit(static_cast<unsigned char>(text_[end])) != 0)
        ++end;
      return end > begin;
    };
    const auto skip_any_of = [&](const char *const characters) {
      const bool is_there =
          end < text_.size() && std::string_view(characters).find(text_[end]) != std::string_view::npos;
      end += is_there ? 1 : 0;
      return is_there;
    };
    skip_any_of("+-");
    bool has_digits = skip_digits();
    if (skip_any_of("."))
      has_digits = skip_digits() || has_digits;
    if (!has_digits)
      return false;
    if (skip_any_of("Ee")) {
      skip_any_of("+-");
      if (!skip_digits())
        return false;
    }
    value = std::strtod(text_.substr(at_, end - at_).c_str(), nullptr);
    at_ = end;
    return true;
  }

  std::string_view keyword() {
    next();
    const std::size_t begin = at_;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 ||
                                  text_[at_] == '_' || text_[at_] == '!'))
      ++at_;
    return std::string_view(text_).substr(begin, at_ - begin);
  }

  /// Returns the next character that is neither blank nor in a comment; nothing at the end of the
  /// file.
  char next() {
    while (true) {
      at_ = std::min(text_.find_first_not_of(blanks, at_), text_.size());
      if (text_.compare(at_, 2, "/*") != 0)
        return at_ < text_.size() ? text_[at_] : '\0';
      skip_to("*/", 2);
    }
  }
  std::uint64_t digits() {
    std::uint64_t value = 0;
    for (; at_ < text_.size() && std::isdigit(static_cast<unsigned char>(text_[at_])) != 0; ++at_)
      value = 10 * value + static_cast<std::uint64_t>(text_[at_] - '0');
    return value;
  }
  /// Skips an opening mark of this length and all up to the closing one.
  void skip_to(const char *const mark, const std::size_t n_opening) {
    const std::size_t place = text_.find(mark, at_ + n_opening);
    at_ = place == std::string::npos ? text_.size() : place + std::char_traits<char>::length(mark);
  }
  /// Skips a text, in which a quote is written twice.
  void skip_text() {
    do
      skip_to("'", 1);
    while (at_ < text_.size() && text_[at_] == '\'');
  }
  std::string excerpt() const {
    constexpr std::size_t max_excerpt = 20;
    const std::size_t end = std::min(text_.find_first_of(",();", at_ + 1), text_.size());
    return printable(text_.substr(at_, std::min(end - at_, max_excerpt)), max_excerpt);
  }
  [[noreturn]] void refuse(const std::string &fault) const {
    throw std::invalid_argument("its entity #" + std::to_string(entity_) + " " + fault);
  }

  const std::string &text_;
  std::size_t at_ = 0;
  std::uint64_t entity_ = 0;
};

/// Entities by their names.
class EntityGraph {
public:
  explicit EntityGraph(const std::vector<Entity> &entities) : entities_(entities) {
    for (std::size_t i = 0; i < entities.size(); ++i)
      index_.emplace(entities[i].name, i);
  }

  /// Refuses an entity that refers to one of the wrong kind, such as a loop of points.
  void check_references() const {
    for (const Entity &entity : entities_)
      for (const auto &[name, kind] : entity.references) {
        const auto found = index_.find(name);
        if (found == index_.end() || can_be(entities_[found->second], kind))
          continue;
        const Entity &other = entities_[found->second];
        throw std::invalid_argument(
            "its entity #" + std::to_string(entity.name) + ", of type " + std::string(entity.type) +
            ", names #" + std::to_string(name) +
            (other.type.empty() ? "" : ", of type " + printable(std::string(other.type), 40)) + ", where " +
            name_of(kind) + " should be");
      }
  }

  /// Refuses points and directions of faces that have not three coordinates, and those in the
  /// parameters of a surface that have not two.
  void check_coordinates() const {
    std::vector<std::size_t> in_space, in_parameters;
    for (std::size_t i = 0; i < entities_.size(); ++i)
      if (entities_[i].kind == Kind::face)
        in_space.push_back(i);
      else if (entities_[i].kind == Kind::parameter_curve)
        for (const auto &[name, kind] : entities_[i].references)
          if (const auto found = index_.find(name); kind == Kind::representation && found != index_.end())
            in_parameters.push_back(found->second);
    check_coordinates(std::move(in_space), 3, "of a face");
    check_coordinates(std::move(in_parameters), 2, "in the parameters of a face");
  }

private:
  /// Whether an entity may stand where one of this kind should be. Other types of curves and
  /// surfaces than those of the rules have telling names.
  static bool can_be(const Entity &entity, const Kind kind) {
    const auto has = [&](const std::string_view word) {
      return entity.type.find(word) != std::string_view::npos;
    };
    if (kind == Kind::unknown || entity.kind == kind)
      return true;
    if (kind == Kind::curve)
      return entity.kind == Kind::parameter_curve || entity.kind == Kind::complex ||
             (entity.kind == Kind::unknown && has("CURVE"));
    if (kind == Kind::surface)
      return entity.kind == Kind::complex || (entity.kind == Kind::unknown && has("SURFACE"));
    if (kind == Kind::representation)
      return entity.kind == Kind::complex;
    return entity.kind == Kind::unknown &&
           ((kind == Kind::edge && has("EDGE")) || (kind == Kind::oriented_edge && has("EDGE")) ||
            (kind == Kind::face && has("FACE")) || (kind == Kind::shell && has("SHELL")) ||
            (kind == Kind::point && has("POINT")) || (kind == Kind::vertex && has("VERTEX")));
  }

  void check_coordinates(std::vector<std::size_t> open, const std::size_t n, const char *const where) const {
    std::vector<bool> is_seen(entities_.size(), false);
    while (!open.empty()) {
      const std::size_t current = open.back();
      const Entity &entity = entities_[current];
      open.pop_back();
      if (is_seen[current] || entity.kind == Kind::parameter_curve)
        continue;
      is_seen[current] = true;
      if ((entity.kind == Kind::point || entity.kind == Kind::direction) && entity.n_coordinates != n)
        throw std::invalid_argument("its entity #" + std::to_string(entity.name) + ", " + where + ", has " +
                                    std::to_string(entity.n_coordinates) + " coordinates, where " +
                                    std::to_string(n) + " should be");
      for (const auto &reference : entity.references)
        if (const auto found = index_.find(reference.first); found != index_.end())
          open.push_back(found->second);
    }
  }

  const std::vector<Entity> &entities_;
  std::unordered_map<std::uint64_t, std::size_t> index_;
};

} // namespace

std::string find_faulty_entity(const std::string &text) {
  try {
    const std::vector<Entity> entities = EntityReader(text).read();
    const EntityGraph graph(entities);
    graph.check_references();
    graph.check_coordinates();
  } catch (const std::invalid_argument &error) {
    return error.what();
  }
  return "";
}

} // namespace billet
