// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/tool.h"

#include "billet/errors.h"
#include "billet/geometry/surface_type.h"
#include "billet/parameters/registered.h"
#include "billet/vector_text.h"

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace billet::parameters {

using dealii::ParameterHandler;
namespace Patterns = dealii::Patterns;

void Motion::declare(ParameterHandler &prm) {
  prm.declare_entry("Translation", "0 ; 0 ; 0", Patterns::Anything(),
                    "Translation of the tool: three muParser expressions of the time t and the names of "
                    "amplitudes. [length]");
  prm.declare_entry("Rotation angle", "0", Patterns::Anything(),
                    "Rotation of the tool, right-handed about the axis: expression of t and the names of "
                    "amplitudes. [radians]");
  prm.declare_entry("Rotation axis", "0, 0, 1", Patterns::Anything(), "Direction of the axis of rotation.");
  prm.declare_entry(
      "Centre", "0, 0, 0", Patterns::Anything(),
      "Point on the axis before the motion. Moments on the tool refer to its current position. [length]");
  prm.declare_entry(
      "Force", "", Patterns::Anything(),
      "Expression of t and the names of amplitudes. The tool moves beyond its translation, along the force "
      "direction, until it presses on the bodies with this force. Empty: no force. [force]");
  prm.declare_entry("Force direction", "", Patterns::Anything(),
                    "Direction in which a tool with a force, or a stop force, presses.");
  prm.declare_entry("Moment", "", Patterns::Anything(),
                    "Expression of t and the names of amplitudes. The tool turns beyond its rotation until "
                    "it acts on the bodies with this moment. Empty: no moment. [force length]");
  prm.declare_entry("Stop force", "", Patterns::Anything(),
                    "Expression of t and the names of amplitudes. The tool stops permanently once it presses "
                    "along the force direction with this force. Empty: no stop. [force]");
  prm.declare_entry("Mass", "0", Patterns::Double(),
                    "> 0. Mass of a tool with a force, in dynamic scenes. With 'Force = 0' the tool moves by "
                    "its inertia and contact alone. [mass]");
  prm.declare_entry(
      "Moment of inertia", "0", Patterns::Double(),
      "> 0. Moment of inertia of a tool with a moment about its axis, in dynamic scenes. [mass length^2]");
  prm.declare_entry(
      "Initial speed", "0", Patterns::Double(),
      "Dynamic scenes: initial speed of a tool with a force or moment, along that direction or about that "
      "axis. Its translation and rotation are added. [length/time, or radians/time]");
  prm.declare_entry(
      "Removal time", "", Patterns::Anything(),
      "Time of the removal of the tool, after which the bodies spring back. Empty: never. [time]");
  prm.declare_entry("Release time", "0", Patterns::Double(),
                    ">= 0. Time over which the forces of a removed tool fade. [time]");
}

void Motion::parse(Reader &reader) {
  const auto expressions = read_expressions(reader, "Translation");
  translation = reader.located("Translation",
                               std::array<std::string, 3>{expressions[0], expressions[1], expressions[2]});
  rotation_angle = reader.located("Rotation angle", reader.text("Rotation angle"));
  rotation_axis = reader.direction("Rotation axis");
  centre = reader.vector("Centre");
  parse_control(reader);
}

void Motion::parse_control(Reader &reader) {
  const std::vector<std::pair<std::string, Control>> controls = {
      {"Force", Control::force}, {"Moment", Control::moment}, {"Stop force", Control::stop}};
  for (const auto &[key, kind] : controls) {
    if (reader.text(key).empty())
      continue;
    if (control != Control::motion)
      reader.reject(key, "no value: a tool has one of 'Force', 'Moment' and 'Stop force'");
    control = kind;
    load = reader.located(key, reader.text(key));
  }
  if (control == Control::force || control == Control::stop)
    direction = reader.direction("Force direction");
  else if (reader.is_set("Force direction"))
    reader.reject("Force direction", "no value: the tool has no force");

  const bool turns = control == Control::moment;
  if (control == Control::force || turns) {
    inertia = reader.not_negative(turns ? "Moment of inertia" : "Mass");
    initial_rate = reader.number("Initial speed");
  }
  for (const auto &[key, used] : {std::pair<std::string, bool>{"Mass", control == Control::force},
                                  {"Moment of inertia", turns},
                                  {"Initial speed", control == Control::force || turns}})
    if (!used && reader.is_set(key))
      reader.reject(key, "no value: the tool's motion is not free");

  removal_time = reader.located("Removal time", std::numeric_limits<double>::infinity());
  release_time = reader.not_negative("Release time");
  if (!reader.text("Removal time").empty()) {
    const auto times = reader.numbers("Removal time");
    if (times.size() != 1 || !(times[0] > 0.))
      reader.reject("Removal time", "a number > 0, or nothing");
    removal_time.value = times[0];
  } else if (reader.is_set("Release time"))
    reader.reject("Release time", "no value: the tool is not removed");
}

namespace {

void declare_surface(ParameterHandler &prm, const std::string &shape) {
  const SurfaceType *type = surface_types().find(shape);
  // An unknown shape is refused when the entry is set.
  prm.declare_entry(
      "Shape", type != nullptr ? shape : default_shape, Patterns::Selection(surface_types().names()),
      (type != nullptr ? type->meaning + " " : "") + "The other parameters are those of the shape.");
  if (type != nullptr)
    for (const auto &parameter : type->parameters)
      declare_parameter(prm, parameter, parameter.meaning);
}

} // namespace

void Tool::declare(ParameterHandler &prm, const std::vector<std::pair<std::string, std::string>> &shapes) {
  prm.enter_subsection("Surfaces");
  for (const auto &[name, shape] : shapes) {
    prm.enter_subsection(name);
    declare_surface(prm, shape);
    prm.leave_subsection();
  }
  prm.leave_subsection();
  prm.enter_subsection("Motion");
  Motion::declare(prm);
  prm.leave_subsection();
}

void Tool::parse(Reader &reader) {
  origin = reader.origin();
  SurfacePatches patches;
  reader.in("Surfaces", [&] {
    if (reader.names().empty())
      throw InputError(origin +
                       ": the tool has no surface; allowed is at least one subsection in 'Surfaces'");
    for (const auto &part : reader.names())
      reader.in(part, [&] {
        const SurfaceType *type = surface_types().find(reader.text("Shape"));
        shapes += (shapes.empty() ? "" : ", ") + type->name;
        for (auto &patch : type->make(reader))
          patches.push_back(std::move(patch));
      });
  });
  if (!patches.empty()) // otherwise their errors are noted
    surface = std::make_shared<const RigidSurface>(std::move(patches));
  reader.in("Motion", [&] { motion.parse(reader); });
}

namespace {

const NamedValues<ContactPair::PenaltyUnit> penalty_units = {
    {"factor", ContactPair::PenaltyUnit::factor}, {"absolute", ContactPair::PenaltyUnit::absolute}};

const NamedValues<ContactPair::Passes> numbers_of_passes = {{"automatic", ContactPair::Passes::automatic},
                                                            {"one", ContactPair::Passes::one},
                                                            {"two", ContactPair::Passes::two}};

const NamedValues<ContactPair::Edges> edge_contacts = {{"automatic", ContactPair::Edges::automatic},
                                                       {"true", ContactPair::Edges::held},
                                                       {"false", ContactPair::Edges::free},
                                                       {"yes", ContactPair::Edges::held},
                                                       {"no", ContactPair::Edges::free}};

const NamedValues<ContactPair::PenaltyOf> reference_stiffnesses = {
    {"automatic", ContactPair::PenaltyOf::automatic},
    {"stiffer", ContactPair::PenaltyOf::stiffer},
    {"series", ContactPair::PenaltyOf::series}};

/// Treatment of an initial penetration above the allowed one.
enum class Overlap { refused, shifted, ramped };

const NamedValues<Overlap> overlaps = {
    {"error", Overlap::refused}, {"shift", Overlap::shifted}, {"ramp", Overlap::ramped}};

} // namespace

const NamedValues<std::optional<FacetMethod>> &facet_methods() {
  static const NamedValues<std::optional<FacetMethod>> methods = {{"automatic", std::nullopt},
                                                                  {"planed", FacetMethod::planed},
                                                                  {"mean gap", FacetMethod::mean_gap},
                                                                  {"bilinear", FacetMethod::bilinear},
                                                                  {"overlap", FacetMethod::overlap}};
  return methods;
}

void ContactPair::declare(ParameterHandler &prm) {
  prm.declare_entry("Body", "", Patterns::Anything(), "Name of the body.");
  prm.declare_entry("Boundary ids", "", Patterns::Anything(),
                    "Boundary ids or names of the body's faces that may touch the tool or the second body, "
                    "separated by commas. all: all exterior faces, except those on symmetry planes.");
  prm.declare_entry("Tool", "", Patterns::Anything(),
                    "Name of the tool. A pair has a tool or a second body.");
  prm.declare_entry("Second body", "", Patterns::Anything(),
                    "Name of another body, or of the same body for self-contact.");
  prm.declare_entry("Second boundary ids", "", Patterns::Anything(),
                    "Boundary ids or names of the second body's faces, or all. Empty: the faces of 'Boundary "
                    "ids' among themselves, if both bodies are the same.");
  declare_values(prm);
  prm.declare_entry(
      "Surface correction", "none", Patterns::Anything(),
      "True surface of the faces of two bodies, on which the nodes of both lie. Gaps are those of the true "
      "surfaces instead of the chords of facets. cylinder : x, y, z ; a, b, c: a point and the direction of "
      "the axis, also of cones. sphere : x, y, z: the centre. none: no correction.");
}

void ContactPair::declare_values_of_bodies(ParameterHandler &prm) {
  prm.declare_entry(
      "Facets", "automatic", Patterns::Selection(selection(facet_methods())),
      "Contact formulation of pairs of bodies. planed: planed contact element without iterations "
      "(Bittencourt & Creus 1998), with the gap to the warped face. mean gap, for comparison: gap to its "
      "mean "
      "plane, as published, which can create energy. bilinear: closest point on the bilinear face, by "
      "iteration. "
      "overlap: contact over the common polygon of two faces on the planed face, which is exact for uniform "
      "pressure and detects edges. automatic: planed in explicit scenes, overlap in implicit ones.");
  prm.declare_entry("Passes", "automatic", Patterns::Selection(selection(numbers_of_passes)),
                    "Passes of pairs of bodies. two: the nodes of each body are slaves to the facets of the "
                    "other, with half the penalty each. one: the nodes of 'Body' only. automatic: one with "
                    "'Facets = overlap', otherwise two.");
  prm.declare_entry("Edge contact", "automatic", Patterns::Selection(selection(edge_contacts)),
                    "Pairs of bodies, nodes against facets. true: contact of edges with edges, which nodes "
                    "against facets do not detect. automatic: true in explicit scenes.");
  prm.declare_entry("Smoothing", "0.1", Patterns::Double(),
                    "> 0 and <= 0.5. Pairs of bodies, nodes against facets: part of a facet, at its edges, "
                    "over which normal and gap blend into those of its neighbour. "
                    "0.5: over the whole facet, a smooth surface of mean normals.");
  prm.declare_entry(
      "Search margin", "0.5", Patterns::Double(),
      "> 0. Pairs of bodies: maximum distance of candidate facets from a node. The search is repeated when "
      "nodes approach by more. The margin affects the cost, not the result. [minimum facet size]");
  prm.declare_entry(
      "Reference stiffness", "automatic", Patterns::Selection(selection(reference_stiffnesses)),
      "Pairs of bodies, penalty as a factor: E/h for this factor. stiffer: that of the stiffer body. series: "
      "both in series. automatic: stiffer in explicit scenes, series in implicit ones.");
}

void ContactPair::declare_values(ParameterHandler &prm) {
  declare_values_of_bodies(prm);
  declare_selection(prm, "Friction law", default_friction_law, friction_law_types(),
                    "Shear stress at which nodes slide under a pressure p.");
  prm.declare_entry("Penalty unit", "factor", Patterns::Selection(selection(penalty_units)),
                    "factor: penalties are multiples of E/h, Young's modulus over the facet's size. "
                    "absolute: they are pressures per penetration.");
  prm.declare_entry("Normal penalty", "10", Patterns::Double(),
                    "k_n > 0: pressure = k_n times penetration. By default, h is the thickness of the "
                    "elements in dynamics, if that is less. In statics, the default of a thin sheet on a "
                    "tool falls where nodes chatter. See also Penetration tolerance. "
                    "[1 or stress/length, see Penalty unit]");
  prm.declare_entry("Tangential penalty", "", Patterns::Anything(),
                    "k_t > 0: stiffness while sticking. Empty: the normal penalty. [1 or stress/length]");
  prm.declare_entry(
      "Penetration tolerance", "", Patterns::Anything(),
      ">= 0. A value > 0 is that of the augmented Lagrangian (Uzawa) in implicit scenes. Each step augments "
      "until penetration and elastic slip of all nodes are below it. If augmentation is slow or fails, "
      "the penalty changes. 0: pure penalty method. automatic: in statics, augmentation until penetration "
      "takes at most 0.2 % of the force of the pair. In dynamics, penalties rise while it takes more than "
      "0.4 % of the deformation. Empty: 0 with a Normal penalty, otherwise automatic. [facet sizes]");
  prm.declare_entry("Allowed initial penetration", "1e-3", Patterns::Double(),
                    ">= 0. Maximum initial penetration of a body into the tool or another body; above it the "
                    "scene is refused. [facet sizes]");
  prm.declare_entry(
      "Initial penetration", "error", Patterns::Selection(selection(overlaps)),
      "Treatment of an initial penetration above the allowed one. error: the scene is refused. shift, in "
      "implicit scenes: gaps count from the initial positions, without stress. ramp, in implicit scenes: the "
      "same at the start, but the shift vanishes until the 'Ramp time', as in a press fit.");
  prm.declare_entry("Ramp time", "0", Patterns::Double(),
                    "> 0. Time at which an initial penetration is resolved. [time]");
  prm.declare_entry("Initial gap", "open", Patterns::Anything(),
                    "Treatment of initial gaps, for assemblies with small clearances. open: they remain. "
                    "close within D, D > 0: faces with an initial gap of up to D are in contact without "
                    "stress, and gaps count from there. [length]");
}

namespace {

FrictionPointer read_friction(const Reader &reader) {
  const FrictionLawType *type = friction_law_types().find(reader.text("Friction law"));
  if (type == nullptr) // the selection has refused all other names
    throw std::logic_error("unknown friction law '" + reader.text("Friction law") + "'");
  join_parameters(friction_law_types())
      .reject_unused(reader, type->parameters, "'" + type->name + "' friction does not use it",
                     "Friction law");
  return type->make(reader);
}

/// Returns ids and names of boundaries, or 'all'.
BoundaryIds read_boundaries(const Reader &reader, const std::string &key) {
  BoundaryIds boundaries = reader.boundaries(key);
  auto &names = boundaries.names;
  boundaries.are_all = std::find(names.begin(), names.end(), "all") != names.end();
  if (boundaries.are_all && names.size() + boundaries.value.size() > 1)
    reader.reject(key, "'all' alone, or ids and names");
  if (boundaries.are_all)
    names.clear();
  return boundaries;
}

void refuse_twice(const Reader &reader, const std::string &key, const BoundaryIds &boundaries) {
  std::vector<std::string> parts = boundaries.names;
  for (const unsigned int id : boundaries.value)
    parts.push_back(std::to_string(id));
  for (auto part = parts.begin(); part != parts.end(); ++part)
    if (std::find(parts.begin(), part, *part) != part)
      reader.reject(key, "each boundary id once; " + *part + " is there twice");
}

} // namespace

void ContactPair::parse_penetration_tolerance(Reader &reader) {
  const std::string key = "Penetration tolerance";
  penetration_tolerance.reset();
  if (reader.text(key).empty()) {
    if (penalty.is_given)
      penetration_tolerance = 0.;
    return;
  }
  if (reader.text(key) == "automatic")
    return;
  const auto values = reader.numbers(key);
  if (values.size() != 1 || !(values[0] >= 0.))
    reader.reject(key, "a number >= 0, or automatic");
  penetration_tolerance = values[0];
}

void ContactPair::parse(Reader &reader) {
  origin = reader.origin();
  body = reader.located("Body", reader.text("Body"));
  parse_bodies(reader);
  boundary_ids = read_boundaries(reader, "Boundary ids");
  if (boundary_ids.is_empty())
    reader.reject("Boundary ids", "at least one boundary id");
  refuse_twice(reader, "Boundary ids", boundary_ids);
  friction = read_friction(reader);
  penalty.unit = chosen(penalty_units, reader.text("Penalty unit"));
  penalty.normal = reader.positive("Normal penalty");
  penalty.is_given = reader.is_set("Normal penalty");
  if (penalty.unit == PenaltyUnit::absolute && !penalty.is_given)
    reader.reject("Penalty unit", "factor, as long as there is no 'Normal penalty'");
  penalty.is_tangential_given = !reader.text("Tangential penalty").empty();
  if (!penalty.is_tangential_given)
    penalty.tangential = penalty.normal;
  else {
    const auto values = reader.numbers("Tangential penalty");
    if (values.size() != 1 || !(values[0] > 0.))
      reader.reject("Tangential penalty", "a number > 0, or nothing");
    if (friction == nullptr)
      reader.reject("Tangential penalty", "no value: the pair has no friction");
    penalty.tangential = values[0];
  }
  parse_initial_state(reader);
  parse_penetration_tolerance(reader);
  initial.allowed_penetration =
      reader.located("Allowed initial penetration", reader.not_negative("Allowed initial penetration"));
}

void ContactPair::parse_initial_state(Reader &reader) {
  const Overlap overlap = chosen(overlaps, reader.text("Initial penetration"));
  initial.may_overlap = overlap != Overlap::refused;
  initial.ramp_time = reader.not_negative("Ramp time");
  if ((overlap == Overlap::ramped) != (initial.ramp_time > 0.))
    reader.reject("Ramp time", overlap == Overlap::ramped ? "a number > 0" : "no value: nothing is ramped");

  initial.closed_gap = 0.;
  const std::string gap = reader.text("Initial gap"), close = "close within ";
  if (gap != "open") {
    char *end = nullptr;
    if (gap.rfind(close, 0) == 0)
      initial.closed_gap = std::strtod(gap.c_str() + close.size(), &end);
    if (end == nullptr || *end != '\0' || !(initial.closed_gap > 0.) || !std::isfinite(initial.closed_gap))
      reader.reject("Initial gap", "'open' or 'close within D' with a number D > 0");
  }

  const std::string text = reader.text("Surface correction");
  const auto colon = text.find(':');
  const std::string kind = dealii::Utilities::trim(text.substr(0, colon));
  if (text == "none")
    return;
  const std::string allowed = "'none', 'cylinder : x, y, z ; a, b, c' or 'sphere : x, y, z'";
  correction.kind = kind == "cylinder" ? Correction::Kind::cylinder : Correction::Kind::sphere;
  const bool is_cylinder = correction.kind == Correction::Kind::cylinder;
  if (colon == std::string::npos || (!is_cylinder && kind != "sphere"))
    reader.reject("Surface correction", allowed);
  if (!is_between_bodies() || second_body.value == body.value)
    reader.reject("Surface correction", "'none': the pair is not of two bodies");
  if (facets.method.value == FacetMethod::mean_gap)
    reader.reject("Surface correction", "'none': 'Facets = mean gap' has no position on a facet");
  const auto vectors = dealii::Utilities::split_string_list(text.substr(colon + 1), ';');
  std::array<dealii::Tensor<1, 3>, 2> values;
  bool is_sound = vectors.size() == (is_cylinder ? 2 : 1);
  for (std::size_t v = 0; v < vectors.size() && is_sound; ++v) {
    const auto numbers = dealii::Utilities::split_string_list(vectors[v], ',');
    is_sound = numbers.size() == 3;
    for (unsigned int i = 0; i < 3 && is_sound; ++i) {
      char *end = nullptr;
      values[v][i] = std::strtod(numbers[i].c_str(), &end);
      is_sound = !numbers[i].empty() && *end == '\0' && std::isfinite(values[v][i]);
    }
  }
  if (!is_sound || (is_cylinder && !(values[1].norm() > 0.)))
    reader.reject("Surface correction", allowed);
  correction.point = values[0];
  if (is_cylinder)
    correction.axis = values[1] / values[1].norm();
}

void ContactPair::parse_bodies(Reader &reader) {
  tool = reader.located("Tool", reader.text("Tool"));
  second_body = reader.located("Second body", reader.text("Second body"));
  if (tool.value.empty() == second_body.value.empty())
    reader.reject(tool.value.empty() ? "Tool" : "Second body",
                  "either a 'Tool' or a 'Second body' for each pair");
  second_boundary_ids = read_boundaries(reader, "Second boundary ids");
  refuse_twice(reader, "Second boundary ids", second_boundary_ids);
  if (!is_between_bodies())
    for (const std::string key : {"Second boundary ids", "Facets", "Passes", "Edge contact",
                                  "Reference stiffness", "Smoothing", "Search margin"})
      if (reader.is_set(key))
        reader.reject(key, "no value: the pair is of a body and a tool");
  if (is_between_bodies() && second_body.value != body.value && second_boundary_ids.is_empty())
    reader.reject("Second boundary ids", "at least one boundary id");
  facets.method = reader.located("Facets", chosen(facet_methods(), reader.text("Facets")));
  facets.passes = chosen(numbers_of_passes, reader.text("Passes"));
  if (facets.passes == Passes::one && second_body.value == body.value)
    reader.reject("Passes", "two: in self-contact every node is a slave");
  facets.edges = chosen(edge_contacts, reader.text("Edge contact"));
  if (facets.edges == Edges::held && facets.method.value == FacetMethod::overlap)
    reader.reject("Edge contact", "no value: 'Facets = overlap' detects edges");
  facets.smoothing = reader.positive("Smoothing");
  if (facets.smoothing > 0.5)
    reader.reject("Smoothing", "a number > 0 and <= 0.5");
  if (facets.method.value == FacetMethod::overlap && reader.is_set("Smoothing"))
    reader.reject("Smoothing", "no value: 'Facets = overlap' blends facets by their areas");
  facets.search_margin = reader.positive("Search margin");
  penalty.of = chosen(reference_stiffnesses, reader.text("Reference stiffness"));
}

} // namespace billet::parameters
