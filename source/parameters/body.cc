// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/body.h"

#include "billet/errors.h"
#include "billet/material/flow_rule.h"
#include "billet/material/hardening.h"
#include "billet/material/law_type.h"
#include "billet/material/rate_factor.h"
#include "billet/material/user_subroutine.h"
#include "billet/material/volumetric_law.h"
#include "billet/mechanics/thickness.h"
#include "billet/nearest_name.h"
#include "billet/parameters/named_values.h"
#include "billet/parameters/number_text.h"
#include "billet/parameters/primitives.h"
#include "billet/parameters/registered.h"
#include "billet/vector_text.h"

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <deal.II/physics/transformations.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

namespace billet::parameters {

using dealii::ParameterHandler;
namespace Patterns = dealii::Patterns;

namespace {

/// Adds a choice to a list "'key = a' or 'key = b'".
void add_choice(std::string &list, const std::string &key, const std::string &name) {
  list += (list.empty() ? "'" : " or '") + key + " = " + name + "'";
}

const NamedValues<Mesh::Source> mesh_sources = {{"primitive", Mesh::Source::primitive},
                                                {"extruded primitive", Mesh::Source::extruded},
                                                {"file", Mesh::Source::file}};

/// Whether the law has plasticity; nothing: if a parameter of plasticity is given.
const NamedValues<std::optional<bool>> laws = {
    {"automatic", std::nullopt}, {"elastic", false}, {"elastoplastic", true}};

const NamedValues<Mesh::Section> sections = {{"solid", Mesh::Section::solid},
                                             {"plane strain", Mesh::Section::plane_strain},
                                             {"axisymmetric", Mesh::Section::axisymmetric}};

/// Whether viscous forces stabilise the body until it is in contact.
const NamedValues<bool> stabilisations = {{"none", false}, {"until contact", true}};

} // namespace

void Mesh::declare(ParameterHandler &prm) {
  prm.declare_entry("Source", "primitive", Patterns::Selection(selection(mesh_sources)),
                    "Source of the mesh: a three-dimensional function of deal.II's GridGenerator, a "
                    "two-dimensional one extruded along z, or a mesh file.");
  prm.declare_entry(
      "Primitive", "hyper_rectangle", Patterns::Anything(),
      "Name of the GridGenerator function, such as hyper_rectangle, subdivided_hyper_rectangle, cylinder; "
      "for an extruded body a two-dimensional one, such as quarter_hyper_ball, hyper_shell. 'billet --list "
      "primitives' has all, with their arguments and boundary ids.");
  prm.declare_entry("Arguments", "", Patterns::Anything(),
                    "Arguments of that function, separated by ':' (points and lists inside by ','), in its "
                    "order or as 'name = value'. Arguments that are missing at the end or empty have their "
                    "defaults.");
  prm.declare_entry(
      "Refinements", "0", Patterns::Integer(0),
      "0 to 10. Number of uniform refinements of the primitive (of the section if it is extruded) or of "
      "the mesh file.");
  prm.declare_entry("Section area", "0", Patterns::Double(),
                    "Extruded primitives: area of the section after scaling about its origin, so that a "
                    "polygon has the volume of a circle. 0: no scaling. [length^2]");
  prm.declare_entry(
      "Section", "solid", Patterns::Selection(selection(sections)),
      "plane strain: one layer of the two-dimensional primitive, whose bottom z = 0 and top are "
      "symmetry planes (before rotation and translation). 'Source' then is extruded primitive, or file with "
      "quadrilaterals in a plane z = constant. "
      "Forces, moments and energies are those of the width 'Height', so per unit of width "
      "with its default, 1. axisymmetric: one layer of the two-dimensional primitive, turned about its axis "
      "of y by 'Wedge angle'. The radius is x, >= 0, and y becomes z. Both sides are symmetry planes through "
      "the axis of z. Forces, moments, loads and energies are those of the wedge; history and console have "
      "forces of the full circle. solid: no such planes.");
  prm.declare_entry(
      "Wedge angle", "5", Patterns::Double(),
      "Axisymmetric sections: angle of the wedge, > 0, at most 30. The section of the bricks is a "
      "polygon, which differs from the circle by a sixth of the square of the angle in rad. "
      "[degrees]");
  prm.declare_entry("Height", "1", Patterns::Double(),
                    "Extruded primitives: extent along z, from z = 0; the width in plane strain. [length]");
  prm.declare_entry("Layers", "1", Patterns::Integer(0),
                    "Extruded primitives: number of layers of elements along z.");
  prm.declare_entry("File", "", Patterns::Anything(),
                    "Mesh file of hexahedra, or of quadrilaterals for a 'Section', relative to the scene "
                    "file: Gmsh's .msh, .vtk, Abaqus's or "
                    "CalculiX's .inp, UCD. "
                    "The content tells the format. Groups of faces give boundary ids and names.");
  prm.declare_entry(
      "Volumes", "", Patterns::Anything(),
      "Mesh files: names or numbers of the volumes that are this body, separated by commas. They are "
      "physical "
      "volumes of Gmsh, sets of elements of a deck, numbers of materials in other formats; of a 'Section', "
      "physical surfaces. Faces beside other volumes are boundary faces of this body, with the names "
      "'interface' and 'interface NAME', where NAME is the other volume. Empty: the whole file is one body.");
  prm.declare_entry(
      "Merge nodes within", "", Patterns::Anything(),
      "Mesh files: nodes within this distance of each other become one, in the file's unit of length, before "
      "'Scale'. Empty: nodes at the same place are refused. 0: they stay apart, for parts that only touch. "
      "[length]");
  prm.declare_entry(
      "Positions", "", Patterns::Anything(),
      "Three muParser expressions of x, y, z, separated by commas or semicolons: new positions of the "
      "vertices, before scaling, rotation and translation. 'x*cos(y) ; x*sin(y) ; z' bends a "
      "box into a ring. Axisymmetric sections: two expressions, of x, the radius, and y, the height, "
      "which move the section before it is turned. Empty: no change. [length]");
  prm.declare_entry("Scale", "1", Patterns::Double(),
                    "> 0. Factor of all positions of the mesh, before rotation and translation.");
  prm.declare_entry("Rotation axis", "0, 0, 1", Patterns::Anything(),
                    "Axis through the origin for the rotation of the mesh.");
  prm.declare_entry("Rotation angle", "0", Patterns::Double(),
                    "Angle of the rotation of the mesh. [degrees]");
  prm.declare_entry("Translation", "0, 0, 0", Patterns::Anything(),
                    "Translation of the mesh after the rotation. [length]");
  prm.declare_entry(
      "Boundary ids", "", Patterns::Anything(),
      "New ids or names of boundary faces: 'id : condition ; name : condition ...'. A condition "
      "is a muParser expression of the face's centre x, y, z in the final position, such as "
      "'top : abs(z - 15) < 1e-6'. The "
      "last true condition applies; faces without a true one keep their id.");
}

namespace {

/// Returns all arguments of the primitive. Refuses unknown primitives and wrong arguments.
std::string read_arguments(const Reader &reader, const unsigned int dimension) {
  const std::string name = reader.text("Primitive");
  const Primitive *primitive = find_primitive(name, dimension);
  if (primitive == nullptr) {
    const std::string source = dimension == 2 ? "'Source = extruded primitive'" : "'Source = primitive'";
    if (find_primitive(name, 5 - dimension) != nullptr)
      reader.reject("Primitive", "a " + std::to_string(dimension) + "-dimensional primitive with " + source);
    std::string all;
    const auto names = primitive_names(dimension);
    for (const auto &known : names)
      all += (all.empty() ? "" : ", ") + known;
    reader.reject("Primitive", "one of: " + all + did_you_mean(name, names));
  }
  std::string all;
  try {
    all = complete_arguments(*primitive, reader.text("Arguments"));
  } catch (const std::invalid_argument &error) {
    reader.reject("Arguments", "'" + name + "' with " + error.what());
  }
  return all;
}

} // namespace

dealii::Tensor<1, 3> Mesh::rotated(const dealii::Tensor<1, 3> &vector) const {
  return rotation_angle == 0. // keeps planes exact
             ? vector
             : dealii::Tensor<1, 3>(dealii::Physics::Transformations::Rotations::rotation_matrix_3d(
                                        rotation_axis, rotation_angle) *
                                    vector);
}

void Mesh::parse_section(const Reader &reader) {
  section = reader.located("Section", chosen(sections, reader.text("Section")));
  const std::string why = "since 'Section = " + reader.text("Section") + "'";
  if (section.value != Section::solid) {
    if (reader.is_set("Source") && source == Source::primitive)
      reader.reject("Source", "extruded primitive or file, " + why);
    if (reader.is_set("Layers") && reader.text("Layers") != "1")
      reader.reject("Layers", "1, " + why + " makes one layer");
    if (source != Source::file)
      source = Source::extruded;
  }
  const bool is_wedge = section.value == Section::axisymmetric;
  if (is_wedge)
    for (const std::string key : {"Height", "Section area"})
      if (reader.is_set(key))
        reader.reject(key, "no value, " + why + ": 'Wedge angle' gives the wedge its width");
  if (!is_wedge && reader.is_set("Wedge angle"))
    reader.reject("Wedge angle", "no value: only 'Section = axisymmetric' uses it");
  const double degrees = reader.positive("Wedge angle");
  constexpr double largest = 30.;
  if (degrees > largest)
    reader.reject("Wedge angle", "a number > 0, at most 30");
  wedge_angle = degrees * dealii::numbers::PI / 180.;
}

void Mesh::parse(Reader &reader) {
  source = chosen(mesh_sources, reader.text("Source"));
  parse_section(reader);
  primitive = reader.located("Primitive", reader.text("Primitive"));
  refinements = reader.count("Refinements", 0, 10);
  section_area = reader.located("Section area", reader.not_negative("Section area"));
  height = reader.positive("Height");
  n_layers = reader.count("Layers", 1);
  file_name = reader.located("File", reader.text("File"));
  volumes = reader.located("Volumes", reader.parts("Volumes", ','));
  positions = reader.located("Positions", split_vector(reader.text("Positions")));
  const bool is_turned = section.value == Section::axisymmetric;
  if (is_turned && !positions.value.empty() && positions.value.size() != 2)
    reader.reject("Positions",
                  "two expressions, separated by a comma or semicolon, or nothing, since 'Section = "
                  "axisymmetric': the new x, the radius, and the new y, the height, of the "
                  "section before it is turned");
  if (!is_turned && !positions.value.empty() && positions.value.size() != 3)
    reader.reject("Positions", "three expressions, separated by commas or semicolons, or nothing");
  scale = reader.positive("Scale");
  rotation_axis = reader.direction("Rotation axis");
  rotation_angle = reader.number("Rotation angle") * dealii::numbers::PI / 180.;
  translation = reader.vector("Translation");
  boundary_ids = reader.located("Boundary ids", std::vector<std::pair<unsigned int, std::string>>());
  for (const auto &part : reader.parts("Boundary ids")) {
    const auto colon = part.find(':');
    try {
      if (colon == std::string::npos)
        throw std::invalid_argument("no condition");
      const std::string name = dealii::Utilities::trim(part.substr(0, colon));
      const bool is_name = is_boundary_name(name);
      if (name == "all") // in pairs these are all faces
        throw std::invalid_argument("reserved");
      boundary_ids.value.emplace_back(is_name ? 0 : parse_count(name),
                                      dealii::Utilities::trim(part.substr(colon + 1)));
      boundary_names.push_back(is_name ? name : "");
    } catch (const std::invalid_argument &) {
      reader.reject(
          "Boundary ids",
          "'id : condition', separated by semicolons, the id a whole number up to 999999999 or a name "
          "with a letter and without a comma, but 'all'");
    }
  }
  const bool is_extruded = source == Source::extruded || section.value != Section::solid;
  for (const std::string key : {"Section area", "Height", "Layers"})
    if (reader.is_set(key) && !is_extruded)
      reader.reject(key, "no value: only 'Source = extruded primitive' uses it");
  for (const std::string key : {"Primitive", "Arguments"})
    if (reader.is_set(key) && source == Source::file)
      reader.reject(key, "no value: the mesh comes from a file");
  if (source == Source::file) {
    if (file_name.value.empty())
      reader.reject("File", "the name of a mesh file, since 'Source = file'");
    file_name.value = reader.file("File");
  } else {
    for (const std::string key : {"File", "Volumes", "Merge nodes within"})
      if (reader.is_set(key))
        reader.reject(key, "no value: the mesh does not come from a file");
    arguments = read_arguments(reader, is_extruded ? 2 : 3);
  }
  merged_distance = reader.located("Merge nodes within", std::optional<double>());
  if (!reader.text("Merge nodes within").empty()) {
    const std::vector<double> distances = reader.numbers("Merge nodes within");
    if (distances.size() != 1 || !(distances[0] >= 0.))
      reader.reject("Merge nodes within", "a length >= 0, or nothing");
    merged_distance.value = distances[0];
  }
}

namespace {

/// Returns the elasticities that take flow rules: "'Elasticity = a' or 'Elasticity = b'".
std::string names_with_flow_rules() {
  std::string names;
  for (const ElasticityType &type : elasticity_types())
    if (type.has_flow_rules)
      add_choice(names, "Elasticity", type.name);
  return names;
}

/// Returns the parameters of flow rules that no type brings.
std::vector<TypeParameter> flow_rule_parameters() {
  std::vector<TypeParameter> all = FlowRule::backstress_parameters();
  for (const TypeParameter &parameter : FlowRule::heating_parameters())
    all.push_back(parameter);
  return all;
}

} // namespace

void Material::declare(ParameterHandler &prm) {
  std::string of_types;
  for (const auto &type : law_types())
    of_types += ". " + type.name + ": " + type.meaning;
  prm.declare_entry("Law", "automatic", Patterns::Selection(selection(laws) + "|" + law_types().names()),
                    "elastic: no plasticity. elastoplastic: plasticity (yield in Kirchhoff stress, exact "
                    "return map). automatic: elastoplastic if a parameter of hardening or rate factors is "
                    "set, such as 'Yield stress', and elastic otherwise" +
                        of_types + ".");
  join_parameters(law_types()).declare(prm);
  declare_selection(prm, "Elasticity", "Hencky", elasticity_types(),
                    "Elastic law, and how it combines with plasticity.");
  declare_selection(prm, volumetric_law_key, "logarithmic", volumetric_law_types(),
                    "Volumetric part of the stored energy of rubber, over J = det F. K is the bulk modulus.");
  prm.declare_entry("Density", "0", Patterns::Double(),
                    "Density of the undeformed body, > 0 in dynamic scenes and for loads on the mass. "
                    "[mass/length^3]");
  prm.declare_entry("Temperature", "", Patterns::Anything(),
                    "Temperature of the whole body, for laws that depend on it: a muParser expression of the "
                    "time t and the names of amplitudes. [temperature]");
  declare_selection(prm, "Hardening", "linear", hardening_types(),
                    "Law of the yield stress over equivalent plastic strain e.");
  declare_selection(prm, "Rate factor", "none", rate_factor_types(),
                    "Factor of the yield stress over the rate of plastic strain. In static scenes the time "
                    "of the scene is that of the process.");
  declare_selection(prm, "Thermal factor", "none", thermal_factor_types(),
                    "Factor of the yield stress over the temperature, 'Temperature' and what plastic work "
                    "adds to it. Needs " +
                        names_with_flow_rules() + ".");
  declare_selection(prm, "Anisotropy", "none", anisotropy_types(),
                    "Yield function. Others than von Mises' need " + names_with_flow_rules() + ".");
  for (const TypeParameter &parameter : flow_rule_parameters())
    declare_parameter(prm, parameter, parameter.meaning);
  for (const TypeParameter &parameter : FormingLimit::parameters())
    declare_parameter(prm, parameter, parameter.meaning);
}

namespace {

/// Calls visit(table, key) for each table of types that plasticity alone uses.
template <class Visit> void for_each_plastic_table(const Visit &visit) {
  visit(hardening_types(), "Hardening");
  visit(rate_factor_types(), "Rate factor");
  visit(thermal_factor_types(), "Thermal factor");
  visit(anisotropy_types(), "Anisotropy");
}

/// Whether the material has plasticity: as 'Law' says, or else if a parameter of plasticity is set.
bool wants_plasticity(const Reader &reader) {
  const auto is_set = [&](const std::string &key) { return reader.is_set(key); };
  bool is_any_set = false;
  for_each_plastic_table([&](const auto &table, const char *key) {
    is_any_set |= is_set(key) || join_parameters(table).is_any_set(is_set);
  });
  for (const TypeParameter &parameter : flow_rule_parameters())
    is_any_set |= is_set(parameter.key);
  return chosen(laws, reader.text("Law")).value_or(is_any_set);
}

/// Refuses parameters of plasticity. `reason` follows "no value: ".
void reject_plasticity(const Reader &reader, const std::string &reason) {
  for_each_plastic_table(
      [&](const auto &table, const char *key) { reject_selection(reader, key, table, reason); });
  for (const TypeParameter &parameter : flow_rule_parameters())
    if (reader.is_set(parameter.key))
      reader.reject(parameter.key, "no value: " + reason);
}

/// Returns the law that 'Law' selects as a whole, without elasticity and hardening.
SharedLaw read_whole_law(const Reader &reader) {
  const std::string reason = "'Law = " + reader.text("Law") + "' does not use it";
  reject_selection(reader, "Elasticity", elasticity_types(), reason);
  reject_selection(reader, volumetric_law_key, volumetric_law_types(), reason);
  reject_plasticity(reader, reason);
  return make_selected(reader, "Law", law_types());
}

std::shared_ptr<const Elasticity> read_elasticity(const Reader &reader) {
  const ElasticityType &type = find_selected(reader, "Elasticity", elasticity_types());
  if (type.has_volumetric_law)
    find_selected(reader, volumetric_law_key, volumetric_law_types());
  else
    reject_selection(reader, volumetric_law_key, volumetric_law_types(),
                     "'Elasticity = " + type.name + "' does not use it");
  return type.make(reader);
}

FlowRule read_flow_rule(const Reader &reader, const double density) {
  FlowRule rule;
  rule.backstress = FlowRule::read_backstress(reader);
  rule.anisotropy = make_selected(reader, "Anisotropy", anisotropy_types());
  rule.thermal = make_selected(reader, "Thermal factor", thermal_factor_types());
  if (rule.thermal != nullptr)
    rule.heating = FlowRule::read_heating(reader, density);
  else
    for (const TypeParameter &parameter : FlowRule::heating_parameters())
      if (reader.is_set(parameter.key))
        reader.reject(parameter.key, "no value: 'Thermal factor = none' does not use it");
  return rule;
}

/// Returns the plastic law. Refuses flow rules that the elasticity does not have.
SharedLaw read_plastic_law(const Reader &reader, const Elasticity &elasticity, const double density) {
  const SharedFlow flow = make_flow_stress(make_selected(reader, "Hardening", hardening_types()),
                                           make_selected(reader, "Rate factor", rate_factor_types()));
  const FlowRule rule = read_flow_rule(reader, density);
  SharedLaw law = make_plastic_law(elasticity, flow, rule);
  if (law == nullptr && !rule.is_plain() && elasticity.make_plastic_law(flow) != nullptr)
    reader.reject(!rule.backstress.empty()     ? "Backstress moduli"
                  : rule.anisotropy != nullptr ? "Anisotropy"
                                               : "Thermal factor",
                  "no value with 'Elasticity = " + reader.text("Elasticity") + "'; choose " +
                      names_with_flow_rules());
  return law;
}

} // namespace

void Material::parse(Reader &reader) {
  density = reader.located("Density", reader.not_negative("Density"));
  if (law_types().find(reader.text("Law")) != nullptr)
    law = read_whole_law(reader);
  else {
    join_parameters(law_types())
        .reject_unused(reader, {}, "'Law = " + reader.text("Law") + "' does not use it");
    elasticity = read_elasticity(reader);
    // A forgotten switch is the usual reason for parameters of plasticity with an elastic law.
    if (!wants_plasticity(reader)) {
      reject_plasticity(reader, "the law is elastic");
      law = elasticity->make_elastic_law();
    } else
      law = read_plastic_law(reader, *elasticity, density.value);
  }
  if (law == nullptr)
    reader.reject("Law", "elastic, since '" + reader.text("Elasticity") +
                             "' with these parameters has no plasticity");
  forming_limit = FormingLimit::read(reader);
  temperature = reader.located("Temperature", reader.text("Temperature"));
  if (law->depends_on_temperature() && temperature.value.empty())
    reader.reject("Temperature", "an expression of t, since the law '" + law->name() + "' depends on it");
  if (!law->depends_on_temperature() && !temperature.value.empty())
    reader.reject("Temperature", "no value: the law '" + law->name() + "' does not depend on it");
}

void Support::declare(ParameterHandler &prm) {
  prm.declare_entry(
      "Boundary ids", "", Patterns::Anything(),
      "Boundary ids or names of the faces whose nodes have prescribed displacements, separated by "
      "commas. Names are those of the mesh file's groups and of 'Boundary ids' in Mesh.");
  prm.declare_entry("Nodes", "", Patterns::Anything(),
                    std::string(node_selection_meaning) + " It takes the place of 'Boundary ids'.");
  prm.declare_entry("Components", "x, y, z", Patterns::Anything(),
                    "Components of the displacement that are prescribed: x, y and z are the first, second "
                    "and third of 'Axes'.");
  prm.declare_entry("Displacement", "0 ; 0 ; 0", Patterns::Anything(),
                    "Prescribed displacement: three muParser expressions, or one for each of 'Components', "
                    "in the order x, y, z. They depend on the reference position x, y, z, the time t and the "
                    "names of amplitudes. Components that are not prescribed allow only 0. In cylindrical "
                    "'Axes', components x and y held together "
                    "turn a node by its circumferential displacement over its radius. [length]");
  for (const TypeParameter &parameter : Axes::parameters())
    declare_parameter(prm, parameter, parameter.meaning);
  prm.declare_entry("From", "0", Patterns::Double(),
                    ">= 0. Time at which the support begins. A step ends there. From a later time than 0 on, "
                    "it holds the nodes where they are then, and moves them by the change of 'Displacement' "
                    "since. [time]");
  prm.declare_entry("Until", "", Patterns::Anything(),
                    "> 'From'. Time at which the support lets its nodes go. A step ends there. Empty: never. "
                    "[time]");
  prm.declare_entry(
      "Fade time", "", Patterns::Anything(),
      ">= 0. Time over which the force that the support exerted fades, linearly, after 'Until'. Empty: a "
      "hundredth of the end time in static scenes, where a jump has no equilibrium path; 0, at once, in "
      "dynamic ones. [time]");
}

namespace {

/// Reads 'Displacement' of a support: three expressions, or one for each component that it
/// prescribes.
std::array<std::string, 3> read_displacement(const Reader &reader, const std::array<bool, 3> &components) {
  const auto expressions = split_vector(reader.text("Displacement"));
  const auto n = static_cast<std::size_t>(std::count(components.begin(), components.end(), true));
  if (has_empty_component(expressions) || (expressions.size() != 3 && expressions.size() != n))
    reader.reject("Displacement", "three expressions for x, y and z, or one for each of 'Components' alone, "
                                  "separated by commas or semicolons, such as '0 ; 0 ; 0.5*t'");
  for (std::size_t i = 0; expressions.size() == 3 && i < 3; ++i)
    if (!components[i] && !is_zero(expressions[i]))
      reader.reject("Displacement", std::string("0 for the component ") + "xyz"[i] +
                                        ", which 'Components' does not have. Add it to 'Components', or set "
                                        "its displacement to 0");
  std::array<std::string, 3> displacement{"0", "0", "0"};
  std::size_t next = 0;
  for (std::size_t i = 0; i < 3; ++i)
    if (expressions.size() == 3 || components[i])
      displacement[i] = expressions[next++];
  return displacement;
}

/// Reads 'From', 'Until' and 'Fade time' of a support or a load. `never_fades`: reason if 'Until'
/// is not set.
template <class Timed> void parse_times(const Reader &reader, const std::string &never_fades, Timed &timed) {
  timed.from = reader.not_negative("From");
  if (!reader.text("Until").empty()) {
    const auto times = reader.numbers("Until");
    if (times.size() != 1 || !(times[0] > timed.from))
      reader.reject("Until", "a number > 'From', or nothing");
    timed.until = times[0];
  }
  if (reader.text("Fade time").empty())
    return;
  if (!std::isfinite(timed.until))
    reader.reject("Fade time", "no value: 'Until' is not set, so that " + never_fades);
  const auto times = reader.numbers("Fade time");
  if (times.size() != 1 || !(times[0] >= 0.))
    reader.reject("Fade time", "a number >= 0, or nothing");
  timed.fade_time = times[0];
}

} // namespace

void Support::parse(Reader &reader) {
  boundary_ids = reader.boundaries("Boundary ids");
  nodes = read_nodes(reader, "Nodes");
  if (boundary_ids.is_empty() && nodes.is_empty())
    reader.reject("Boundary ids", "at least one boundary id, or 'Nodes'");
  if (!boundary_ids.is_empty() && !nodes.is_empty())
    reader.reject("Nodes", "no value: 'Boundary ids' says which nodes the support holds");
  for (const auto &component : reader.parts("Components", ',')) {
    if (component.size() != 1 || component[0] < 'x' || component[0] > 'z')
      reader.reject("Components", "a list of x, y and z");
    components[static_cast<std::size_t>(component[0] - 'x')] = true;
  }
  if (!components[0] && !components[1] && !components[2])
    reader.reject("Components", "at least one of x, y and z");
  axes = Axes(reader);
  displacement = reader.located("Displacement", read_displacement(reader, components));
  parse_times(reader, "the support never lets go", *this);
}

void Load::declare(ParameterHandler &prm) {
  declare_selection(prm, "Type", "pressure", load_types(), "Kind of the load.");
  prm.declare_entry("From", "0", Patterns::Double(),
                    ">= 0. Time at which the load begins to act. A step ends there. [time]");
  prm.declare_entry("Until", "", Patterns::Anything(),
                    "> 'From'. Time at which the load is switched off. A step ends there. Empty: never. "
                    "[time]");
  prm.declare_entry(
      "Fade time", "", Patterns::Anything(),
      ">= 0. Time over which the load fades, linearly, from its value at 'Until'. Empty: a hundredth of the "
      "end time in static scenes, where a jump has no equilibrium path; 0, at once, in "
      "dynamic ones. [time]");
}

void Load::parse(Reader &reader) {
  type = reader.text("Type");
  const LoadType *chosen = load_types().find(type);
  if (chosen == nullptr) // the selection has refused all other names
    throw std::logic_error("unknown load '" + type + "'");
  join_parameters(load_types())
      .reject_unused(reader, chosen->parameters, "a load of type '" + type + "' does not use it", "Type");
  boundary_ids = reader.boundaries("Boundary ids");
  nodes = read_nodes(reader, "Nodes");
  load = chosen->make(reader);
  if (load.acts_on_faces() && boundary_ids.is_empty() && nodes.is_empty()) {
    const auto &keys = chosen->parameters;
    const bool takes_nodes = std::any_of(
        keys.begin(), keys.end(), [](const TypeParameter &parameter) { return parameter.key == "Nodes"; });
    reader.reject("Boundary ids",
                  std::string("at least one boundary id") + (takes_nodes ? ", or 'Nodes'" : ""));
  }
  if (!boundary_ids.is_empty() && !nodes.is_empty())
    reader.reject("Nodes", "no value: 'Boundary ids' says where the load acts");
  for (const LoadExpression &expression : load.expressions)
    if (!reader.is_set(expression.key))
      reader.reject(expression.key,
                    "a value that the scene sets: it is the size of a load of type '" + type + "'");
  origin = reader.origin();
  parse_times(reader, "the load never fades", *this);
  for (const LoadExpression &expression : load.expressions)
    origins.push_back(reader.origin(expression.key));
}

namespace {

/// Returns the elements for which `is_named` holds: "'Element = a' or 'Element = b'".
template <class Condition> std::string name_elements(const Condition &is_named) {
  std::string names;
  for (const BrickElement element : all_elements())
    if (is_named(element))
      add_choice(names, "Element", element.name());
  return names;
}

} // namespace

void Body::declare(ParameterHandler &prm, const std::vector<std::string> &support_names,
                   const std::vector<std::string> &load_names) {
  declare_selection(prm, "Element", BrickElement::assumed_strain.name(), element_types(),
                    "Formulation of the bricks.");
  prm.declare_entry(
      "Refinement times", "", Patterns::Anything(),
      "Times, ascending and separated by commas, at each of which every brick of this body is divided into "
      "eight. Steps end there. The run continues on the finer mesh, to which it carries displacements, "
      "velocities and the histories of the material. At most 5 times, and not with more than 2 'Points "
      "through thickness'. Empty: the mesh remains. [time]");
  prm.declare_entry(
      "Initial velocity", "0 ; 0 ; 0", Patterns::Anything(),
      "Dynamic scenes: initial velocity, three muParser expressions of the position x, y, z. [length/time]");
  prm.declare_entry("Symmetry planes", "", Patterns::Anything(),
                    "Symmetry planes, which boundary nodes on them cannot leave, separated by semicolons. A "
                    "plane is 'x = 0', or a normal and the distance along it, '1, 1, 0 = 3.5'. [length]");
  prm.declare_entry("Contact stabilisation", "none", Patterns::Selection("none|until contact"),
                    "Static scenes. until contact: a small viscous force acts on a body that is free at the "
                    "start, and fades once contact supports it.");
  prm.enter_subsection("Mesh");
  Mesh::declare(prm);
  prm.leave_subsection();
  prm.enter_subsection("Material");
  Material::declare(prm);
  prm.leave_subsection();
  prm.enter_subsection("Supports");
  for (const auto &name : support_names) {
    prm.enter_subsection(name);
    Support::declare(prm);
    prm.leave_subsection();
  }
  prm.leave_subsection();
  prm.enter_subsection("Loads");
  for (const auto &name : load_names) {
    prm.enter_subsection(name);
    Load::declare(prm);
    prm.leave_subsection();
  }
  prm.leave_subsection();
}

namespace {

SymmetryPlane parse_plane(const Reader &reader, const std::string &text) {
  const std::string allowed = "'x = 0', or 'nx, ny, nz = distance', separated by semicolons";
  const auto equals = text.find('=');
  if (equals == std::string::npos)
    reader.reject("Symmetry planes", allowed);
  SymmetryPlane plane;
  plane.text = text;
  try {
    const std::string left = dealii::Utilities::trim(text.substr(0, equals));
    plane.offset = parse_number(dealii::Utilities::trim(text.substr(equals + 1)));
    if (left == "x" || left == "y" || left == "z")
      plane.normal[static_cast<unsigned int>(left[0] - 'x')] = 1.;
    else {
      const auto components = dealii::Utilities::split_string_list(left, ',');
      if (components.size() != 3)
        throw std::invalid_argument("components");
      for (unsigned int i = 0; i < 3; ++i)
        plane.normal[i] = parse_number(components[i]);
    }
  } catch (const std::invalid_argument &) {
    reader.reject("Symmetry planes", allowed);
  }
  const double length = plane.normal.norm();
  if (!(length > 0.))
    reader.reject("Symmetry planes", "normals that are not zero");
  plane.normal /= length;
  return plane;
}

/// Returns the planes of both sides of a layer in plane strain or of a wedge, which moves with the
/// mesh.
std::vector<SymmetryPlane> sides_of_section(const Mesh &mesh) {
  if (mesh.section.value == Mesh::Section::solid)
    return {};
  if (mesh.section.value == Mesh::Section::axisymmetric) {
    const auto first = mesh.rotated(dealii::Tensor<1, 3>({0., 1., 0.}));
    const auto second =
        mesh.rotated(dealii::Tensor<1, 3>({-std::sin(mesh.wedge_angle), std::cos(mesh.wedge_angle), 0.}));
    return {SymmetryPlane{first, first * mesh.translation, "first side of the wedge"},
            SymmetryPlane{second, second * mesh.translation, "second side of the wedge"}};
  }
  const dealii::Tensor<1, 3> normal = mesh.rotated(dealii::Tensor<1, 3>({0., 0., 1.}));
  const double low = normal * mesh.translation;
  return {SymmetryPlane{normal, low, "bottom of the section"},
          SymmetryPlane{normal, low + mesh.scale * mesh.height, "top of the section"}};
}

/// Refuses planes that a section does not allow: an axisymmetric one would make a cone of them.
void check_plane_of_section(const Reader &reader, const Mesh &mesh, const SymmetryPlane &plane) {
  constexpr double rounding = 1e-6;
  if (mesh.section.value == Mesh::Section::solid)
    return;
  const double along = std::abs(plane.normal * mesh.rotated(dealii::Tensor<1, 3>({0., 0., 1.})));
  if (mesh.section.value == Mesh::Section::axisymmetric && along < 1. - rounding)
    reader.reject("Symmetry planes", "planes across the axis, such as z = 0: 'Section = axisymmetric' has "
                                     "those through the axis by default");
  if (mesh.section.value == Mesh::Section::plane_strain && along > rounding)
    reader.reject("Symmetry planes", "planes along the width, such as x = 0: 'Section = plane strain' has "
                                     "those across it by default");
}

} // namespace

void Body::parse(Reader &reader) {
  origin = reader.origin();
  reader.in("Mesh", [&] { mesh.parse(reader); });
  reader.in("Material", [&] { material.parse(reader); });
  reader.in("Supports", [&] {
    for (const auto &support_name : reader.names())
      reader.in(support_name, [&] {
        supports.emplace_back();
        supports.back().name = support_name;
        supports.back().parse(reader);
      });
  });
  reader.in("Loads", [&] {
    for (const auto &load_name : reader.names())
      reader.in(load_name, [&] {
        loads.emplace_back();
        loads.back().name = load_name;
        loads.back().parse(reader);
      });
  });
  element = reader.located("Element", make_selected(reader, "Element", element_types()));
  if (element.value.type.is_stabilised() && find_user_subroutine(*material.law) != nullptr)
    reader.reject("Element",
                  name_elements([](const BrickElement other) { return !other.is_stabilised(); }) +
                      ", since the law is a subroutine: '" + element.value.type.name() +
                      "' stabilises a body by its yield stress, which a subroutine does not tell, and "
                      "forces would be several times too large");
  refinement_times = reader.located("Refinement times", reader.numbers("Refinement times"));
  for (std::size_t i = 0; i < refinement_times.value.size(); ++i)
    if (!(refinement_times.value[i] > (i == 0 ? 0. : refinement_times.value[i - 1])))
      reader.reject("Refinement times", "numbers > 0, each above the one before");
  const auto velocity = read_expressions(reader, "Initial velocity");
  initial_velocity =
      reader.located("Initial velocity", std::array<std::string, 3>{velocity[0], velocity[1], velocity[2]});
  is_stabilised =
      reader.located("Contact stabilisation", chosen(stabilisations, reader.text("Contact stabilisation")));
  symmetry_planes = reader.located("Symmetry planes", std::vector<SymmetryPlane>());
  for (const auto &part : reader.parts("Symmetry planes")) {
    symmetry_planes.value.push_back(parse_plane(reader, part));
    check_plane_of_section(reader, mesh, symmetry_planes.value.back());
  }
  for (const SymmetryPlane &plane : sides_of_section(mesh)) {
    symmetry_planes.value.push_back(plane);
    symmetry_planes.value.back().is_of_section = true;
  }
}

} // namespace billet::parameters
