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
#include <vector>

namespace billet {

namespace {

/// Entity of shapes: how many parameters it has, and which of them, counted from 0, are lengths > 0.
struct EntityRule {
  std::size_t n_parameters;
  std::vector<std::size_t> lengths = {};
};

const std::unordered_map<std::string_view, EntityRule> &rules() {
  static const std::unordered_map<std::string_view, EntityRule> table{{"CARTESIAN_POINT", {2}},
                                                                      {"DIRECTION", {2}},
                                                                      {"VECTOR", {3}},
                                                                      {"AXIS1_PLACEMENT", {3}},
                                                                      {"AXIS2_PLACEMENT_2D", {3}},
                                                                      {"AXIS2_PLACEMENT_3D", {4}},
                                                                      {"LINE", {3}},
                                                                      {"CIRCLE", {3, {2}}},
                                                                      {"ELLIPSE", {4, {2, 3}}},
                                                                      {"HYPERBOLA", {4, {2, 3}}},
                                                                      {"PARABOLA", {3}},
                                                                      {"POLYLINE", {2}},
                                                                      {"TRIMMED_CURVE", {6}},
                                                                      {"B_SPLINE_CURVE_WITH_KNOTS", {9}},
                                                                      {"SURFACE_CURVE", {4}},
                                                                      {"SEAM_CURVE", {4}},
                                                                      {"INTERSECTION_CURVE", {4}},
                                                                      {"PCURVE", {3}},
                                                                      {"PLANE", {2}},
                                                                      {"CYLINDRICAL_SURFACE", {3, {2}}},
                                                                      {"CONICAL_SURFACE", {4}},
                                                                      {"SPHERICAL_SURFACE", {3, {2}}},
                                                                      {"TOROIDAL_SURFACE", {4, {2, 3}}},
                                                                      {"SURFACE_OF_LINEAR_EXTRUSION", {3}},
                                                                      {"SURFACE_OF_REVOLUTION", {3}},
                                                                      {"B_SPLINE_SURFACE_WITH_KNOTS", {13}},
                                                                      {"RECTANGULAR_TRIMMED_SURFACE", {7}},
                                                                      {"VERTEX_POINT", {2}},
                                                                      {"EDGE_CURVE", {5}},
                                                                      {"ORIENTED_EDGE", {5}},
                                                                      {"EDGE_LOOP", {2}},
                                                                      {"VERTEX_LOOP", {2}},
                                                                      {"FACE_BOUND", {3}},
                                                                      {"FACE_OUTER_BOUND", {3}},
                                                                      {"ADVANCED_FACE", {4}},
                                                                      {"FACE_SURFACE", {4}},
                                                                      {"CLOSED_SHELL", {2}},
                                                                      {"OPEN_SHELL", {2}},
                                                                      {"MANIFOLD_SOLID_BREP", {2}},
                                                                      {"SHELL_BASED_SURFACE_MODEL", {2}}};
  return table;
}

/// What an entity is to the check of coordinates.
enum class Role { other, face, in_parameters, coordinates };

struct Entity {
  std::uint64_t name;
  Role role = Role::other;
  std::size_t n_coordinates = 0;
  std::vector<std::uint64_t> references = {};
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
    std::vector<double> numbers = {}; ///< of a list
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
      while (next() != ')') {
        keyword();
        parameters(entities.back(), 0);
      }
      ++at_;
    } else if (next() == '<')
      return; // one of another file
    else {
      const std::string_view type = keyword();
      check(type, parameters(entities.back(), 0), entities.back());
    }
    if (next() != ';')
      refuse("has no ';' at its end");
  }

  void check(const std::string_view type, const std::vector<Parameter> &parameters, Entity &entity) const {
    const auto rule = rules().find(type);
    if (rule == rules().end())
      return;
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
    if (type == "ADVANCED_FACE" || type == "FACE_SURFACE")
      entity.role = Role::face;
    else if (type == "PCURVE")
      entity.role = Role::in_parameters;
    else if (type == "CARTESIAN_POINT" || type == "DIRECTION") {
      entity.role = Role::coordinates;
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

  /// Reads a list of parameters in brackets. Adds the entities that it names.
  std::vector<Parameter> parameters(Entity &entity, const unsigned int depth) {
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
      all.push_back(parameter(entity, depth));
      const char c = next();
      if (c != ',' && c != ')')
        refuse("has '" + excerpt() + "' where ',' or ')' should be");
      ++at_;
      if (c == ')')
        return all;
    }
  }

  Parameter parameter(Entity &entity, const unsigned int depth) {
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
      entity.references.push_back(digits());
    } else if (c == '(') {
      result.is_list = true;
      for (const Parameter &member : parameters(entity, depth + 1))
        if (member.is_number)
          result.numbers.push_back(member.value);
    } else if (is_number(result.value))
      result.is_number = true;
    else { // a value with its type
      const std::size_t begin = at_;
      if (keyword().empty() || next() != '(') {
        at_ = begin;
        refuse("has '" + excerpt() + "' where a number, a text or a reference should be");
      }
      const std::vector<Parameter> typed = parameters(entity, depth + 1);
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

  /// Returns the next character that is neither blank nor in a comment; nothing at the end of the file.
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

/// Refuses points and directions of faces that have not three coordinates. Those in the parameters of a
/// surface have two.
void check_coordinates(const std::vector<Entity> &entities) {
  std::unordered_map<std::uint64_t, std::size_t> index;
  for (std::size_t i = 0; i < entities.size(); ++i)
    index.emplace(entities[i].name, i);
  std::vector<bool> is_seen(entities.size(), false);
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < entities.size(); ++i)
    if (entities[i].role == Role::face)
      open.push_back(i);
  while (!open.empty()) {
    const Entity &entity = entities[open.back()];
    const std::size_t current = open.back();
    open.pop_back();
    if (is_seen[current] || entity.role == Role::in_parameters)
      continue;
    is_seen[current] = true;
    if (entity.role == Role::coordinates && entity.n_coordinates != 3)
      throw std::invalid_argument("its entity #" + std::to_string(entity.name) + ", of a face, has " +
                                  std::to_string(entity.n_coordinates) + " coordinates, where 3 should be");
    for (const std::uint64_t name : entity.references)
      if (const auto found = index.find(name); found != index.end())
        open.push_back(found->second);
  }
}

} // namespace

std::string find_faulty_entity(const std::string &text) {
  try {
    check_coordinates(EntityReader(text).read());
  } catch (const std::invalid_argument &error) {
    return error.what();
  }
  return "";
}

} // namespace billet
