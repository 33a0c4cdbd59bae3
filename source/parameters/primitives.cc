// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/primitives.h"

#include "billet/nearest_name.h"
#include "billet/parameters/number_text.h"
#include "billet/registered_type.h"

#include <deal.II/base/utilities.h>

#include <cmath>
#include <stdexcept>

namespace billet::parameters {

namespace {

using Kind = PrimitiveArgument::Kind;
using Argument = PrimitiveArgument;
using Boundaries = std::vector<Primitive::Boundary>;

const Argument ids{"boundary ids", Kind::flag, "true",
                   "true: faces have the ids below; false: all faces have id 0."};
Boundaries box_faces(const unsigned int dimension) {
  const Boundaries all = {{0, "least x"},   {1, "largest x"}, {2, "least y"},
                          {3, "largest y"}, {4, "least z"},   {5, "largest z"}};
  return {all.begin(), all.begin() + 2 * dimension};
}

Argument centre(const unsigned int dimension) {
  return {"centre", Kind::point, dimension == 2 ? "0, 0" : "0, 0, 0", "Centre. [length]"};
}

std::string repeat(const std::string &text, const unsigned int n) {
  std::string result = text;
  for (unsigned int i = 1; i < n; ++i)
    result += ", " + text;
  return result;
}

Argument length(const std::string &name, const std::optional<std::string> &value, const std::string &what) {
  return {name, Kind::length, value, "> 0. " + what + " [length]"};
}

Argument number(const std::string &name, const std::optional<std::string> &value, const std::string &what) {
  return {name, Kind::number, value, what};
}

Argument count(const std::string &name, const std::optional<std::string> &value, const std::string &what) {
  return {name, Kind::count, value, what};
}

/// Adds boxes and bodies of boxes.
void add_boxes(std::vector<Primitive> &all, const unsigned int d) {
  const std::string box = d == 2 ? "rectangle" : "box", cube = d == 2 ? "square" : "cube";
  const Argument first{"first corner", Kind::point, repeat("0", d), "Corner. [length]"};
  const Argument second{"second corner", Kind::point, repeat("1", d), "Opposite corner. [length]"};
  const Argument low = number("low", "0", "Least coordinate in all directions. [length]");
  const Argument high = number("high", "1", "Largest coordinate in all directions. [length]");
  const Boundaries one = {{0, "all faces"}};
  all.push_back({"hyper_rectangle", d, "A " + box + " of one element.", {first, second, ids}, box_faces(d)});
  all.push_back({"subdivided_hyper_rectangle",
                 d,
                 "A " + box + " of several elements.",
                 {{"elements", Kind::sizes, std::nullopt,
                   "Number of elements along each axis; or their sizes from the first corner on, a list for "
                   "each axis, lists separated by semicolons.",
                   d},
                  first,
                  second,
                  ids},
                 box_faces(d)});
  all.push_back({"hyper_cube", d, "A " + cube + " of one element.", {low, high, ids}, box_faces(d)});
  all.push_back({"subdivided_hyper_cube",
                 d,
                 "A " + cube + " of several elements.",
                 {count("elements", std::nullopt, "Number of elements along each edge."), low, high, ids},
                 box_faces(d)});
  all.push_back({"general_cell",
                 d,
                 std::string("One ") + (d == 2 ? "quadrilateral." : "hexahedron."),
                 {{"corners", Kind::points, std::nullopt,
                   "Corners in lexicographic order, x fastest, separated by semicolons. [length]", 1U << d},
                  ids},
                 box_faces(d)});
  all.push_back(
      {"simplex",
       d,
       d == 2 ? "A triangle of three quadrilaterals." : "A tetrahedron of four hexahedra.",
       {{"corners", Kind::points, std::nullopt, "Corners, separated by semicolons. [length]", d + 1}},
       one});
  all.push_back({"enclosed_hyper_cube",
                 d,
                 "A " + cube + " within a layer of elements on all sides.",
                 {low,
                  high,
                  length("thickness", "1", "Thickness of the layer."),
                  {"material ids", Kind::flag, "false", "Has no effect: a body has one material."}},
                 one});
  all.push_back({"hyper_L",
                 d,
                 d == 2 ? "A square without its upper right quarter."
                        : "A cube without the eighth at largest x, y and z.",
                 {number("low", "-1", "Least coordinate in all directions. [length]"), high,
                  d == 2 ? ids : Argument{"boundary ids", Kind::flag, "false", "Allowed is false."}},
                 d == 2 ? Boundaries{{0, "least x"},
                                     {1, "least y"},
                                     {2, "largest x"},
                                     {3, "horizontal inner edge"},
                                     {4, "vertical inner edge"},
                                     {5, "largest y"}}
                        : one});
  all.push_back({"hyper_cube_slit",
                 d,
                 "A " + cube + " with a slit from least y to its middle, in the plane of the middle x.",
                 {low, high, ids},
                 {{0, "outer faces"}, {1, "one side of the slit"}, {2, "the other side"}}});
  all.push_back(
      {"hyper_cross",
       d,
       "A unit " + cube + " about the origin with arms of such " + cube + "s.",
       {{"arms", Kind::any_counts, std::nullopt,
         "Number of elements of the arms along -x, +x, -y, +y" + std::string(d == 3 ? ", -z, +z." : "."),
         2 * d},
        {"material ids", Kind::flag, "false", "Has no effect: a body has one material."}},
       one});
  all.push_back({"cheese",
                 d,
                 "A " + box + " of unit elements with holes of one element.",
                 {{"holes", Kind::counts, std::nullopt, "Number of holes along each axis.", d}},
                 one});
}

/// Returns the faces of a box and of a hole in it.
Boundaries with_hole(const unsigned int id, const unsigned int d) {
  Boundaries faces = box_faces(d);
  faces.push_back({id, "hole"});
  return faces;
}

/// Adds balls and shells and plates with holes.
void add_round(std::vector<Primitive> &all, const unsigned int d) {
  const std::string ball = d == 2 ? "disc" : "ball", shell = d == 2 ? "ring" : "spherical shell";
  const Argument radius = length("radius", "1", "Radius.");
  const Argument inner = length("inner radius", std::nullopt, "Inner radius.");
  const Argument outer = length("outer radius", std::nullopt, "Outer radius, above the inner one.");
  const Argument elements{"elements", Kind::any_count, "0",
                          d == 2 ? "Number of elements around; 0: by the radii."
                                 : "Number of elements, such as 6, 12, 24, 48, 96; 0: 6."};
  const Boundaries curved_and_cut = {{0, "curved face"}, {1, "plane faces"}};
  const Boundaries in_and_out = {{0, "inner face"}, {1, "outer face"}};
  all.push_back({"hyper_ball",
                 d,
                 "A " + ball + ".",
                 {centre(d),
                  radius,
                  {"round elements", Kind::flag, "false",
                   "true: refinement follows the sphere also inside the elements at the surface."}},
                 {{0, "curved face"}}});
  all.push_back({"hyper_ball_balanced",
                 d,
                 "A " + ball + " of more and better shaped elements.",
                 {centre(d), radius},
                 {{0, "curved face"}}});
  all.push_back({"half_hyper_ball",
                 d,
                 "The half of a " + ball + " at x above that of the centre.",
                 {centre(d), radius},
                 curved_and_cut});
  all.push_back({"quarter_hyper_ball",
                 d,
                 d == 2 ? "The quarter of a disc at x and y above those of the centre."
                        : "The eighth of a ball at x, y and z above those of the centre.",
                 {centre(d), radius},
                 curved_and_cut});
  all.push_back({"hyper_shell", d, "A " + shell + ".", {centre(d), inner, outer, elements, ids}, in_and_out});
  all.push_back({"half_hyper_shell",
                 d,
                 "The half of a " + shell + " at x above that of the centre.",
                 {centre(d), inner, outer,
                  d == 2 ? elements : Argument{"elements", Kind::any_count, "0", "0 or 5 elements."}, ids},
                 d == 2 ? Boundaries{{0, "inner face"},
                                     {1, "outer face"},
                                     {2, "plane face at largest y"},
                                     {3, "plane face at least y"}}
                        : Boundaries{{0, "inner face, and the outer one except its element at largest x"},
                                     {1, "element of the outer face at largest x"},
                                     {2, "plane face"}}});
  all.push_back(
      {"quarter_hyper_shell",
       d,
       d == 2 ? "The quarter of a ring at x and y above those of the centre."
              : "The eighth of a spherical shell at x, y and z above those of the centre.",
       {centre(d), inner, outer,
        d == 2 ? elements : Argument{"elements", Kind::any_count, "0", "0 or 3 elements."}, ids},
       d == 2 ? Boundaries{{0, "inner face"}, {1, "outer face"}, {2, "least x"}, {3, "least y"}}
              : Boundaries{
                    {0, "inner face"}, {1, "outer face"}, {2, "least x"}, {3, "least y"}, {4, "least z"}}});
  all.push_back({"eccentric_hyper_shell",
                 d,
                 "A " + shell + " of varying thickness.",
                 {{"inner centre", Kind::point, std::nullopt, "Centre of the inner face. [length]"},
                  {"outer centre", Kind::point, std::nullopt, "Centre of the outer face. [length]"},
                  inner,
                  outer,
                  count("elements", std::nullopt,
                        d == 2 ? "Number of elements around." : "Number of elements, 6 or 12 or more.")},
                 in_and_out});
  all.push_back({"concentric_hyper_shells",
                 d,
                 "A " + shell + " of several layers.",
                 {centre(d), length("inner radius", "0.125", "Inner radius."),
                  length("outer radius", "0.25", "Outer radius, above the inner one."),
                  count("layers", "1", "Number of layers."),
                  number("skewness", "0.1", ">= 0. Layers grow outwards; 0: all have the same thickness."),
                  elements, ids},
                 in_and_out});
}

/// Adds plates with a hole.
void add_plates(std::vector<Primitive> &all, const unsigned int d) {
  all.push_back(
      {"hyper_cube_with_cylindrical_hole",
       d,
       d == 2 ? "A square about the origin with a round hole."
              : "A square plate about the z axis with a round hole, from z = 0.",
       {length("hole radius", "0.25", "Radius of the hole."),
        length("half width", "0.5", "Half of the edge of the square, above the hole's radius."),
        length("thickness", "0.5", d == 2 ? "Has no effect in two dimensions." : "Extent along z."),
        count("layers", "1", d == 2 ? "Has no effect in two dimensions." : "Number of elements along z."),
        ids},
       with_hole(d == 2 ? 4 : 6, d)});
  all.push_back(
      {"plate_with_a_hole",
       d,
       d == 2 ? "A rectangle with a round hole and elements that follow it."
              : "A rectangular plate with a hole along z and elements that follow it. z = 0 is its middle.",
       {length("hole radius", "0.4", "Radius of the hole."),
        length("half width", "1", "Half of the edge of the square around the hole."),
        number("pad at least y", "2", ">= 0. Width of the plate below that square. [length]"),
        number("pad at largest y", "2", ">= 0. Width of the plate above that square. [length]"),
        number("pad at least x", "1", ">= 0. Width of the plate left of that square. [length]"),
        number("pad at largest x", "1", ">= 0. Width of the plate right of that square. [length]"),
        centre(d),
        {"polar manifold", Kind::any_count, "0", "Number of a manifold in deal.II, without effect here."},
        {"square manifold", Kind::any_count, "1", "Likewise; it must differ from the one before."},
        length("thickness", "1", d == 2 ? "Has no effect in two dimensions." : "Extent along z."),
        {"slices", Kind::count, "2",
         d == 2 ? "Has no effect in two dimensions." : ">= 2. Number of planes of nodes along z."},
        ids},
       d == 2 ? with_hole(4, 2)
              : Boundaries{{0, "least x"},
                           {1, "largest x"},
                           {2, "least y"},
                           {3, "largest y"},
                           {4, "hole"},
                           {5, "least z"},
                           {6, "largest z"}}});
  all.push_back({"channel_with_cylinder",
                 d,
                 "deal.II's channel of 2.2 x 0.41 with a round hole of diameter 0.1.",
                 {length("ring width", "0.03", "Width of the rings around the hole."),
                  {"rings", Kind::any_count, "2", "Number of these rings."},
                  number("skewness", "2", ">= 0. Rings grow outwards; 0: all have the same width."),
                  ids},
                 {{0, "least x"}, {1, "largest x"}, {2, "hole"}, {3, "walls"}}});
}

/// Adds bodies about the x axis, and rings.
void add_axial(std::vector<Primitive> &all, const unsigned int d) {
  const Argument half = length("half length", "1", "The body extends from minus this x to plus this x.");
  const Boundaries ends = {{0, d == 2 ? "long sides" : "curved face"}, {1, "least x"}, {2, "largest x"}};
  all.push_back({"cylinder",
                 d,
                 d == 2 ? "A rectangle about the x axis." : "A cylinder about the x axis.",
                 {length("radius", "1", d == 2 ? "Half of its height." : "Radius."), half},
                 ends});
  all.push_back({"truncated_cone",
                 d,
                 d == 2 ? "A trapezium about the x axis." : "A truncated cone about the x axis.",
                 {length("first radius", "1", "Radius at least x."),
                  length("second radius", "0.5", "Radius at largest x."), half},
                 ends});
  if (d == 2)
    return;
  all.push_back({"subdivided_cylinder",
                 3,
                 "A cylinder about the x axis, of several elements along it.",
                 {count("elements", std::nullopt, "Number of elements along x."),
                  length("radius", "1", "Radius."), half},
                 ends});
  all.push_back({"cylinder_shell",
                 3,
                 "A tube about the z axis, from z = 0.",
                 {length("length", std::nullopt, "Length."),
                  length("inner radius", std::nullopt, "Inner radius."),
                  length("outer radius", std::nullopt, "Outer radius, above the inner one."),
                  {"elements around", Kind::any_count, "0", "Number of elements around; 0: by the radii."},
                  {"elements along", Kind::any_count, "0", "Number of elements along z; 0: by the radii."}},
                 {{0, "all faces"}}});
  all.push_back({"torus",
                 3,
                 "A ring of round section about the y axis.",
                 {length("ring radius", std::nullopt, "Radius of the ring's middle line."),
                  length("section radius", std::nullopt, "Radius of its section, below that of the ring."),
                  count("elements around", "6", ">= 3. Number of elements around the ring."),
                  number("angle", "6.283185307179586", "> 0. Angle of the ring; 2 pi closes it. [radians]")},
                 {{0, "curved face"}}});
  all.push_back({"moebius",
                 3,
                 "A twisted closed ring of square section.",
                 {count("elements", std::nullopt, "> 4. Number of elements around the ring."),
                  {"quarter turns", Kind::any_count, std::nullopt, "Number of quarter turns of the section."},
                  length("ring radius", std::nullopt, "Radius of the ring's middle line."),
                  length("edge", std::nullopt, "Edge of the section.")},
                 {{0, "all faces"}}});
}

std::vector<Primitive> make_all() {
  std::vector<Primitive> all;
  for (const unsigned int dimension : {3U, 2U}) {
    add_boxes(all, dimension);
    add_axial(all, dimension);
    add_round(all, dimension);
    add_plates(all, dimension);
  }
  return all;
}

bool is_count(const std::string &text, const bool may_be_zero) {
  return !text.empty() && text.size() <= 9 && text.find_first_not_of("0123456789") == std::string::npos &&
         (may_be_zero || std::stoul(text) > 0);
}

/// Returns the number; throws std::invalid_argument with a remedy.
double read_number(const std::string &text) {
  try {
    return parse_number(text);
  } catch (const std::invalid_argument &) {
    throw std::invalid_argument(number_remedy(text));
  }
}

/// Whether the text is `n` whole numbers, separated by commas, with a product up to a billion.
bool are_counts(const std::string &text, const std::size_t n, const bool may_be_zero) {
  const auto parts = dealii::Utilities::split_string_list(text, ',');
  double product = 1.;
  for (const auto &part : parts) {
    if (!is_count(part, may_be_zero))
      return false;
    product *= std::max(1., std::stod(part));
  }
  return parts.size() == n && product <= 1e9;
}

/// Whether the text is `n` lists, separated by semicolons, of `n_each` numbers (0: any number of
/// them).
bool are_lists(const std::string &text, const std::size_t n, const std::size_t n_each, const bool positive) {
  const auto lists = dealii::Utilities::split_string_list(text, ';');
  for (const auto &list : lists) {
    const auto parts = dealii::Utilities::split_string_list(list, ',');
    if (n_each > 0 && parts.size() != n_each)
      return false;
    for (const auto &part : parts)
      if (const double value = read_number(part); positive && !(value > 0.))
        return false;
  }
  return lists.size() == n;
}

/// Returns what the argument may be: "three whole numbers > 0, separated by commas".
std::string allowed_values(const Argument &argument, const unsigned int dimension) {
  const std::string n = std::to_string(argument.n), d = std::to_string(dimension);
  switch (argument.kind) {
  case Kind::number:
    return "a number";
  case Kind::length:
    return "a number > 0";
  case Kind::count:
    return "a whole number > 0, at most 999999999";
  case Kind::any_count:
    return "a whole number >= 0, at most 999999999";
  case Kind::counts:
    return n + " whole numbers > 0, separated by commas, with a product of at most 1e9";
  case Kind::any_counts:
    return n + " whole numbers >= 0, separated by commas, with a product of at most 1e9";
  case Kind::sizes:
    return n + " whole numbers > 0, separated by commas, with a product of at most 1e9; or " + n +
           " lists of sizes > 0, separated by semicolons";
  case Kind::point:
    return d + " numbers, separated by commas";
  case Kind::points:
    return n + " points of " + d + " numbers each, separated by semicolons";
  case Kind::flag:
    return "true or false";
  }
  return "";
}

/// Whether the text is a value of the argument. Throws std::invalid_argument with a remedy.
bool is_valid(const Argument &argument, const std::string &text, const unsigned int dimension) {
  switch (argument.kind) {
  case Kind::number:
  case Kind::length: {
    const double value = read_number(text);
    return argument.kind == Kind::number || value > 0.;
  }
  case Kind::count:
  case Kind::any_count:
    return is_count(text, argument.kind == Kind::any_count);
  case Kind::counts:
  case Kind::any_counts:
    return are_counts(text, argument.n, argument.kind == Kind::any_counts);
  case Kind::sizes:
    return text.find(';') == std::string::npos ? are_counts(text, argument.n, false)
                                               : are_lists(text, argument.n, 0, true);
  case Kind::point:
    return are_lists(text, 1, dimension, false);
  case Kind::points:
    return are_lists(text, argument.n, dimension, false);
  case Kind::flag:
    return text == "true" || text == "false";
  }
  return false;
}

void check(const Primitive &primitive, const Argument &argument, const std::string &text) {
  std::string remedy;
  try {
    if (is_valid(argument, text, primitive.dimension))
      return;
  } catch (const std::invalid_argument &error) {
    remedy = error.what();
  }
  throw std::invalid_argument("'" + primitive.usage() + "', where '" + argument.name + "' is " +
                              allowed_values(argument, primitive.dimension) + ", not '" + text + "'" +
                              remedy);
}

/// Returns which argument 'name = value' sets, and removes the name.
std::size_t take_name(const Primitive &primitive, std::string &text) {
  const auto equals = text.find('=');
  const std::string name = dealii::Utilities::trim(text.substr(0, equals));
  std::vector<std::string> known;
  for (const Argument &argument : primitive.arguments) {
    if (argument.name == name) {
      text = dealii::Utilities::trim(text.substr(equals + 1));
      return known.size();
    }
    known.push_back(argument.name);
  }
  throw std::invalid_argument("'" + primitive.usage() + "', which has no argument '" + name + "'" +
                              did_you_mean(name, known));
}

} // namespace

std::string Primitive::usage() const {
  std::string text;
  for (const Argument &argument : arguments) {
    const std::string name = (text.empty() ? "" : " : ") + argument.name;
    text += argument.default_value ? (text.empty() ? "" : " ") + ("[" + dealii::Utilities::trim(name) + "]")
                                   : name;
  }
  return text;
}

const std::vector<Primitive> &primitives() {
  static const std::vector<Primitive> all = make_all();
  return all;
}

const Primitive *find_primitive(const std::string &name, const unsigned int dimension) {
  for (const Primitive &primitive : primitives())
    if (primitive.name == name && primitive.dimension == dimension)
      return &primitive;
  return nullptr;
}

std::vector<std::string> primitive_names(const unsigned int dimension) {
  std::vector<std::string> names;
  for (const Primitive &primitive : primitives())
    if (primitive.dimension == dimension)
      names.push_back(primitive.name);
  return names;
}

std::string complete_arguments(const Primitive &primitive, const std::string &text) {
  std::vector<std::string> values(primitive.arguments.size());
  std::size_t next = 0;
  bool has_names = false;
  for (std::string part : dealii::Utilities::split_string_list(text, ':')) {
    const bool is_named = part.find('=') != std::string::npos;
    if (has_names && !is_named)
      throw std::invalid_argument("'" + primitive.usage() +
                                  "', with names for all arguments after a named one");
    has_names = is_named;
    const std::size_t argument = is_named ? take_name(primitive, part) : next++;
    if (argument >= values.size())
      throw std::invalid_argument("'" + primitive.usage() + "', which are " + std::to_string(values.size()) +
                                  " arguments, separated by colons; '" + part + "' is one too many");
    if (!values[argument].empty())
      throw std::invalid_argument("'" + primitive.usage() + "', with one value for '" +
                                  primitive.arguments[argument].name + "'");
    values[argument] = part;
  }
  std::string result;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Argument &argument = primitive.arguments[i];
    if (values[i].empty() && !argument.default_value)
      throw std::invalid_argument("'" + primitive.usage() + "', with a value for '" + argument.name + "'");
    if (values[i].empty())
      values[i] = *argument.default_value;
    else
      check(primitive, argument, values[i]);
    result += (i == 0 ? "" : " : ") + values[i];
  }
  return result;
}

} // namespace billet::parameters
