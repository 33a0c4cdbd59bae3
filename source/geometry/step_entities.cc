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
enum class EntityKind {
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

const char *name_of(const EntityKind kind) {
  switch (kind) {
  case EntityKind::unknown:
  case EntityKind::complex:
    break;
  case EntityKind::point:
    return "a point";
  case EntityKind::direction:
    return "a direction";
  case EntityKind::vector:
    return "a vector";
  case EntityKind::axes:
    return "axes";
  case EntityKind::curve:
  case EntityKind::parameter_curve:
    return "a curve";
  case EntityKind::surface:
    return "a surface";
  case EntityKind::representation:
    return "a representation";
  case EntityKind::vertex:
    return "a vertex";
  case EntityKind::edge:
    return "an edge";
  case EntityKind::oriented_edge:
    return "an oriented edge";
  case EntityKind::loop:
    return "a loop";
  case EntityKind::bound:
    return "a bound of a face";
  case EntityKind::face:
    return "a face";
  case EntityKind::shell:
    return "a shell";
  case EntityKind::solid:
    return "a solid";
  }
  return "another entity";
}

/// Entity of shapes. It has the number of its parameters and which of them, counted from 0, are
/// lengths > 0. It has the kinds of those that refer to entities, alone or in a list. Source: ISO
/// 10303-42, sections 4 and 5.
struct EntityRule {
  EntityKind kind;
  std::size_t n_parameters;
  std::vector<std::size_t> lengths = {};
  std::vector<std::pair<std::size_t, EntityKind>> references = {};
};

const std::unordered_map<std::string_view, EntityRule> &rules() {
  static const std::unordered_map<std::string_view, EntityRule> table{
      {"CARTESIAN_POINT", {EntityKind::point, 2}},
      {"DIRECTION", {EntityKind::direction, 2}},
      {"VECTOR", {EntityKind::vector, 3, {}, {{1, EntityKind::direction}}}},
      {"AXIS1_PLACEMENT", {EntityKind::axes, 3, {}, {{1, EntityKind::point}, {2, EntityKind::direction}}}},
      {"AXIS2_PLACEMENT_2D", {EntityKind::axes, 3, {}, {{1, EntityKind::point}, {2, EntityKind::direction}}}},
      {"AXIS2_PLACEMENT_3D",
       {EntityKind::axes,
        4,
        {},
        {{1, EntityKind::point}, {2, EntityKind::direction}, {3, EntityKind::direction}}}},
      {"LINE", {EntityKind::curve, 3, {}, {{1, EntityKind::point}, {2, EntityKind::vector}}}},
      {"CIRCLE", {EntityKind::curve, 3, {2}, {{1, EntityKind::axes}}}},
      {"ELLIPSE", {EntityKind::curve, 4, {2, 3}, {{1, EntityKind::axes}}}},
      {"HYPERBOLA", {EntityKind::curve, 4, {2, 3}, {{1, EntityKind::axes}}}},
      {"PARABOLA", {EntityKind::curve, 3, {}, {{1, EntityKind::axes}}}},
      {"POLYLINE", {EntityKind::curve, 2, {}, {{1, EntityKind::point}}}},
      {"TRIMMED_CURVE", {EntityKind::curve, 6, {}, {{1, EntityKind::curve}}}},
      {"B_SPLINE_CURVE_WITH_KNOTS", {EntityKind::curve, 9, {}, {{2, EntityKind::point}}}},
      {"SURFACE_CURVE", {EntityKind::curve, 4, {}, {{1, EntityKind::curve}}}},
      {"SEAM_CURVE", {EntityKind::curve, 4, {}, {{1, EntityKind::curve}}}},
      {"INTERSECTION_CURVE", {EntityKind::curve, 4, {}, {{1, EntityKind::curve}}}},
      {"PCURVE",
       {EntityKind::parameter_curve, 3, {}, {{1, EntityKind::surface}, {2, EntityKind::representation}}}},
      {"DEFINITIONAL_REPRESENTATION", {EntityKind::representation, 3}},
      {"PLANE", {EntityKind::surface, 2, {}, {{1, EntityKind::axes}}}},
      {"CYLINDRICAL_SURFACE", {EntityKind::surface, 3, {2}, {{1, EntityKind::axes}}}},
      {"CONICAL_SURFACE", {EntityKind::surface, 4, {}, {{1, EntityKind::axes}}}},
      {"SPHERICAL_SURFACE", {EntityKind::surface, 3, {2}, {{1, EntityKind::axes}}}},
      {"TOROIDAL_SURFACE", {EntityKind::surface, 4, {2, 3}, {{1, EntityKind::axes}}}},
      {"SURFACE_OF_LINEAR_EXTRUSION",
       {EntityKind::surface, 3, {}, {{1, EntityKind::curve}, {2, EntityKind::vector}}}},
      {"SURFACE_OF_REVOLUTION",
       {EntityKind::surface, 3, {}, {{1, EntityKind::curve}, {2, EntityKind::axes}}}},
      {"B_SPLINE_SURFACE_WITH_KNOTS", {EntityKind::surface, 13, {}, {{3, EntityKind::point}}}},
      {"RECTANGULAR_TRIMMED_SURFACE", {EntityKind::surface, 7, {}, {{1, EntityKind::surface}}}},
      {"VERTEX_POINT", {EntityKind::vertex, 2, {}, {{1, EntityKind::point}}}},
      {"EDGE_CURVE",
       {EntityKind::edge, 5, {}, {{1, EntityKind::vertex}, {2, EntityKind::vertex}, {3, EntityKind::curve}}}},
      {"ORIENTED_EDGE", {EntityKind::oriented_edge, 5, {}, {{3, EntityKind::edge}}}},
      {"EDGE_LOOP", {EntityKind::loop, 2, {}, {{1, EntityKind::oriented_edge}}}},
      {"VERTEX_LOOP", {EntityKind::loop, 2, {}, {{1, EntityKind::vertex}}}},
      {"POLY_LOOP", {EntityKind::loop, 2, {}, {{1, EntityKind::point}}}},
      {"FACE_BOUND", {EntityKind::bound, 3, {}, {{1, EntityKind::loop}}}},
      {"FACE_OUTER_BOUND", {EntityKind::bound, 3, {}, {{1, EntityKind::loop}}}},
      {"ADVANCED_FACE", {EntityKind::face, 4, {}, {{1, EntityKind::bound}, {2, EntityKind::surface}}}},
      {"FACE_SURFACE", {EntityKind::face, 4, {}, {{1, EntityKind::bound}, {2, EntityKind::surface}}}},
      {"CLOSED_SHELL", {EntityKind::shell, 2, {}, {{1, EntityKind::face}}}},
      {"OPEN_SHELL", {EntityKind::shell, 2, {}, {{1, EntityKind::face}}}},
      {"MANIFOLD_SOLID_BREP", {EntityKind::solid, 2, {}, {{1, EntityKind::shell}}}},
      {"SHELL_BASED_SURFACE_MODEL", {EntityKind::solid, 2, {}, {{1, EntityKind::shell}}}}};
  return table;
}

struct Entity {
  std::uint64_t name;
  EntityKind kind = EntityKind::unknown;
  std::string_view type = {}; ///< its keyword; empty if it is complex
  std::size_t n_coordinates = 0;
  /// Names of entities, and what these should be; unknown if no rule says that.
  std::vector<std::pair<std::uint64_t, EntityKind>> references = {};
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
      entities.back().kind = EntityKind::complex;
      while (next() != ')') {
        keyword();
        for (const Parameter &parameter : parameters(0))
          add_references(parameter, EntityKind::unknown, entities.back());
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

  static void add_references(const Parameter &parameter, const EntityKind kind, Entity &entity) {
    for (const std::uint64_t name : parameter.references)
      entity.references.emplace_back(name, kind);
  }

  void check(const std::string_view type, const std::vector<Parameter> &parameters, Entity &entity) const {
    const auto rule = rules().find(type);
    entity.type = type;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      EntityKind kind = EntityKind::unknown;
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
    if (entity.kind == EntityKind::point || entity.kind == EntityKind::direction) {
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
      if (entities_[i].kind == EntityKind::face)
        in_space.push_back(i);
      else if (entities_[i].kind == EntityKind::parameter_curve)
        for (const auto &[name, kind] : entities_[i].references)
          if (const auto found = index_.find(name);
              kind == EntityKind::representation && found != index_.end())
            in_parameters.push_back(found->second);
    check_coordinates(std::move(in_space), 3, "of a face");
    check_coordinates(std::move(in_parameters), 2, "in the parameters of a face");
  }

private:
  /// Whether an entity may stand where one of this kind should be. Other types of curves and
  /// surfaces than those of the rules have telling names.
  static bool can_be(const Entity &entity, const EntityKind kind) {
    const auto has = [&](const std::string_view word) {
      return entity.type.find(word) != std::string_view::npos;
    };
    if (kind == EntityKind::unknown || entity.kind == kind)
      return true;
    if (kind == EntityKind::curve)
      return entity.kind == EntityKind::parameter_curve || entity.kind == EntityKind::complex ||
             (entity.kind == EntityKind::unknown && has("CURVE"));
    if (kind == EntityKind::surface)
      return entity.kind == EntityKind::complex || (entity.kind == EntityKind::unknown && has("SURFACE"));
    if (kind == EntityKind::representation)
      return entity.kind == EntityKind::complex;
    return entity.kind == EntityKind::unknown &&
           ((kind == EntityKind::edge && has("EDGE")) || (kind == EntityKind::oriented_edge && has("EDGE")) ||
            (kind == EntityKind::face && has("FACE")) || (kind == EntityKind::shell && has("SHELL")) ||
            (kind == EntityKind::point && has("POINT")) || (kind == EntityKind::vertex && has("VERTEX")));
  }

  void check_coordinates(std::vector<std::size_t> open, const std::size_t n, const char *const where) const {
    std::vector<bool> is_seen(entities_.size(), false);
    while (!open.empty()) {
      const std::size_t current = open.back();
      const Entity &entity = entities_[current];
      open.pop_back();
      if (is_seen[current] || entity.kind == EntityKind::parameter_curve)
        continue;
      is_seen[current] = true;
      if ((entity.kind == EntityKind::point || entity.kind == EntityKind::direction) &&
          entity.n_coordinates != n)
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
