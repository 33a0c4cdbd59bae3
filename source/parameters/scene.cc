// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/scene.h"

#include "billet/diagnostic_kinds.h"
#include "billet/errors.h"
#include "billet/geometry/surface_type.h"
#include "billet/material/law_type.h"
#include "billet/mechanics/explicit_block.h"
#include "billet/nearest_name.h"
#include "billet/parameters/declaration.h"
#include "billet/parameters/expression_check.h"
#include "billet/parameters/general_contact.h"
#include "billet/parameters/libraries.h"
#include "billet/parameters/scene_update.h"
#include "billet/scene_fault.h"

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <functional>
#include <ostream>
#include <sstream>
#include <utility>

namespace billet::parameters {

using dealii::ParameterHandler;

namespace {

void declare_named(ParameterHandler &prm, const std::string &list, const std::vector<std::string> &names,
                   const std::function<void(const std::string &)> &declare) {
  prm.enter_subsection(list);
  for (const auto &name : names) {
    prm.enter_subsection(name);
    declare(name);
    prm.leave_subsection();
  }
  prm.leave_subsection();
}

/// Names and shapes that are needed before the parameters can be declared.
struct Outline {
  /// Returns the names in a list of subsections.
  std::function<std::vector<std::string>(const SceneFile::Path &)> names_below;
  /// Returns the shape of the surface in this subsection.
  std::function<std::string(const SceneFile::Path &)> shape;
};

/// Declares all parameters.
void declare_all(ParameterHandler &prm, const Outline &outline) {
  const auto &names_below = outline.names_below;
  prm.declare_entry("Title", "", dealii::Patterns::Anything(),
                    "Title of the scene, for the console and --check.");
  prm.declare_entry(
      "Warnings", "report", dealii::Patterns::Selection("report|errors"),
      "Effect of warnings. report: none on the exit code. errors: a run that ends with warnings completes, "
      "but exits with code 6. The warning 'old-name' leaves the exit code as it is.");
  prm.declare_entry(
      libraries_key, "", dealii::Patterns::Anything(),
      "Shared libraries with types of your own, such as laws, separated by ';': names of files, "
      "relative to the scene file. They are loaded before the scene is read, and run with your "
      "rights. See the chapter on materials.");
  declare_presets(prm);
  declare_named(prm, "Amplitudes", names_below({"Amplitudes"}),
                [&](const std::string &) { Amplitude::declare(prm); });
  declare_named(prm, "Bodies", names_below({"Bodies"}), [&](const std::string &name) {
    Body::declare(prm, names_below({"Bodies", name, "Supports"}), names_below({"Bodies", name, "Loads"}));
  });
  declare_named(prm, "Tools", names_below({"Tools"}), [&](const std::string &name) {
    std::vector<std::pair<std::string, std::string>> shapes;
    for (const auto &part : names_below({"Tools", name, "Surfaces"}))
      shapes.emplace_back(part, outline.shape({"Tools", name, "Surfaces", part}));
    Tool::declare(prm, shapes);
  });
  declare_general_contact(prm);
  declare_named(prm, "Contact pairs", names_below({"Contact pairs"}),
                [&](const std::string &) { ContactPair::declare(prm); });
  declare_named(prm, "Probes", names_below({"Probes"}), [&](const std::string &) { Probe::declare(prm); });
  prm.enter_subsection("Time stepping");
  TimeStepping::declare(prm);
  prm.leave_subsection();
  prm.enter_subsection("Explicit dynamics");
  ExplicitDynamics::declare(prm);
  prm.leave_subsection();
  prm.enter_subsection("Implicit dynamics");
  ImplicitDynamics::declare(prm);
  prm.leave_subsection();
  prm.enter_subsection("Solver");
  Solver::declare(prm);
  prm.leave_subsection();
  prm.enter_subsection("Output");
  Output::declare(prm);
  prm.leave_subsection();
  prm.enter_subsection("Restart");
  Restart::declare(prm);
  prm.leave_subsection();
}

template <class T> std::vector<T> parse_named(Reader &reader, const std::string &list) {
  std::vector<T> result;
  reader.in(list, [&] {
    for (const auto &name : reader.names())
      reader.note_errors([&] {
        reader.in(name, [&] {
          result.emplace_back();
          result.back().name = name;
          result.back().parse(reader);
        });
      });
  });
  return result;
}

template <class T> std::size_t index_of(const std::vector<T> &list, const Located<std::string> &name) {
  std::string known;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (list[i].name == name.value)
      return i;
    known += (i == 0 ? "" : ", ") + list[i].name;
    names.push_back(list[i].name);
  }
  const std::string advice = did_you_mean(name.value, names);
  throw InputError(scene_error(
      name.origin + " is '" + name.value + "'" + (advice.empty() ? "; allowed" : advice + " Allowed") +
          " is one of: " + (known.empty() ? "(none is defined)" : known),
      {SceneFault::Kind::wrong_value, nearest_name(name.value, names), {name.value}}));
}

void check_amplitude_name(const std::string &name, const std::string &file_name) {
  const auto is_word = [](const char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
  };
  if (!std::all_of(name.begin(), name.end(), is_word) ||
      std::isalpha(static_cast<unsigned char>(name[0])) == 0 || name == "x" || name == "y" || name == "z" ||
      name == "t" || name == "pi")
    throw InputError(file_name + ": amplitude '" + name +
                     "' has a name that expressions cannot use; allowed are letters, digits and '_', first a "
                     "letter, but not x, y, z, t, pi");
}

/// Checks all expressions that could be read, and notes the errors.
class ExpressionChecks {
public:
  ExpressionChecks(Reader &reader, const std::vector<Amplitude> &amplitudes)
      : reader_(reader), amplitudes_(amplitudes) {}

  void check(const Body &body) {
    using Variables = ExpressionVariables;
    if (!body.material.temperature.value.empty())
      check(body.material.temperature.value, Variables::time, amplitudes_, body.material.temperature.origin);
    check_all(body.initial_velocity, amplitudes_);
    for (const std::string &component : body.element.value.thickness_direction)
      check(component, Variables::time_and_position, {}, body.element.value.direction_origin);
    check_all(body.mesh.positions, {});
    for (const auto &[id, condition] : body.mesh.boundary_ids.value)
      check(condition, Variables::time_and_position, {}, body.mesh.boundary_ids.origin);
    for (const Support &support : body.supports)
      for (std::size_t i = 0; i < 3; ++i)
        if (support.components[i] && !support.displacement.origin.empty())
          check(support.displacement.value[i], Variables::time_and_position, amplitudes_,
                support.displacement.origin);
    for (const Load &load : body.loads)
      for (std::size_t i = 0; i < load.origins.size(); ++i) // none of loads with other errors
        check(load.load.expressions[i].text,
              load.load.expressions[i].uses_position ? Variables::time_and_position : Variables::time,
              amplitudes_, load.origins[i]);
  }
  void check(const Tool &tool) {
    using Variables = ExpressionVariables;
    if (!tool.motion.translation.origin.empty())
      for (const std::string &text : tool.motion.translation.value)
        check(text, Variables::time, amplitudes_, tool.motion.translation.origin);
    for (const auto *expression : {&tool.motion.rotation_angle, &tool.motion.load})
      if (!expression->origin.empty())
        check(expression->value, Variables::time, amplitudes_, expression->origin);
  }

private:
  template <class Texts>
  void check_all(const Located<Texts> &texts, const std::vector<Amplitude> &amplitudes) {
    if (!texts.origin.empty())
      for (const std::string &text : texts.value)
        check(text, ExpressionVariables::time_and_position, amplitudes, texts.origin);
  }
  void check(const std::string &text, const ExpressionVariables variables,
             const std::vector<Amplitude> &amplitudes, const std::string &origin) {
    reader_.note_errors([&] { check_expression(text, variables, amplitudes, origin); });
  }

  Reader &reader_;
  const std::vector<Amplitude> &amplitudes_;
};

/// Notes names of bodies and tools that the scene does not have.
void check_names(const Scene &scene, Reader &reader) {
  const auto check_name = [&reader](const auto &list, const Located<std::string> &name) {
    // Otherwise the entry has other errors, or none.
    if (!name.origin.empty() && !name.value.empty())
      reader.note_errors([&] { index_of(list, name); });
  };
  for (const ContactPair &pair : scene.pairs) {
    if (!pair.body.origin.empty())
      reader.note_errors([&] { scene.body_index(pair); });
    check_name(scene.bodies, pair.second_body);
    check_name(scene.tools, pair.tool);
  }
  for (const Probe &probe : scene.probes)
    check_name(scene.bodies, probe.body);
}

/// Notes expressions that make no sense.
void check_expressions(const Scene &scene, Reader &reader) {
  ExpressionChecks expressions(reader, scene.amplitudes);
  for (const Body &body : scene.bodies)
    expressions.check(body);
  for (const Tool &tool : scene.tools)
    expressions.check(tool);
}

/// One side of a contact pair: faces of a body.
struct Side {
  const std::string &body;
  const std::vector<unsigned int> &ids;

  /// Returns an id that both sides have; no_id if there is none.
  unsigned int common_id(const Side &other) const {
    if (body == other.body)
      for (const unsigned int id : ids)
        if (std::count(other.ids.begin(), other.ids.end(), id) > 0)
          return id;
    return no_id;
  }
  static constexpr unsigned int no_id = static_cast<unsigned int>(-1);
};

/// Returns both sides of a pair of bodies, which are equal for self-contact.
std::array<Side, 2> sides_of(const ContactPair &pair) {
  const Side first{pair.body.value, pair.boundary_ids.value};
  return {first, pair.second_boundary_ids.value.empty()
                     ? first
                     : Side{pair.second_body.value, pair.second_boundary_ids.value}};
}

/// Returns a boundary id of faces that both pairs bring into contact with the same faces or tool;
/// no_id if there is none.
unsigned int repeated_id(const ContactPair &first, const ContactPair &second) {
  if (first.is_between_bodies() != second.is_between_bodies())
    return Side::no_id;
  const std::array<Side, 2> those = sides_of(first), these = sides_of(second);
  if (!first.is_between_bodies())
    return first.tool.value == second.tool.value ? these[0].common_id(those[0]) : Side::no_id;
  for (const unsigned int turned : {0U, 1U})
    if (these[1].common_id(those[1 - turned]) != Side::no_id) {
      const unsigned int id = these[0].common_id(those[turned]);
      if (id != Side::no_id)
        return id;
    }
  return Side::no_id;
}

/// Returns the name of the scene file without folder and extension, for the results of a scene that
/// names no folder. If that is the file itself or its folder, ".results" follows.
std::string default_folder(const std::string &file_name) {
  namespace fs = std::filesystem;
  const std::string name = fs::path(file_name).stem().string();
  std::error_code error;
  const fs::path scene_folder = fs::path(file_name).parent_path();
  const bool holds_scene = fs::equivalent(name, file_name, error) ||
                           fs::equivalent(name, scene_folder.empty() ? fs::path(".") : scene_folder, error);
  return holds_scene ? name + ".results" : name;
}

/// Returns the error of a parameter that the scheme excludes.
InputError excluded_by_scheme(const std::string &text) {
  return InputError(scene_error(text, {SceneFault::Kind::excluded, "", {"Scheme"}}));
}

/// Refuses what the scene does not have, or a body that it does not name.
void check_probe(const Scene &scene, const Probe &probe) {
  if (probe.probe.has_body() && probe.body.value.empty() && scene.bodies.size() > 1)
    throw InputError(probe.body.origin + " is ''; allowed is the name of a body, since there are several");
  const std::size_t body = scene.body_index(probe);
  const std::string is_static = "'Scheme' in 'Time stepping' is " + name_of(scene.time_stepping.scheme);
  if (!scene.scheme().has_inertia && probe.probe.reads(ProbeQuantity::Kind::velocity))
    throw excluded_by_scheme(probe.origin_of_quantities +
                             " names 'velocity'; allowed are other quantities, since " + is_static +
                             ", without velocities");
  const auto *energies = std::get_if<ProbedEnergies>(&probe.probe.where);
  if (!scene.scheme().has_inertia && energies != nullptr &&
      energies->numerator == ProbedEnergies::Numerator::kinetic)
    throw excluded_by_scheme(probe.origin_of_energy + " is 'kinetic'; allowed are other energies, since " +
                             is_static + ", without kinetic energy");
  const bool has_pair = std::any_of(scene.pairs.begin(), scene.pairs.end(), [&](const ContactPair &pair) {
    return scene.body_index(pair) == body ||
           (pair.is_between_bodies() && scene.second_body_index(pair) == body);
  });
  if (probe.probe.reads(ProbeQuantity::Kind::contact_pressure) && !has_pair)
    throw InputError(probe.origin_of_quantities +
                     " names 'contact pressure'; allowed are other quantities, " +
                     "since no contact pair has faces of body '" + scene.bodies[body].name + "'");
}

/// Refuses parameters of one scheme in scenes of another: a forgotten switch is the usual reason.
class SchemeCheck {
public:
  /// `notes`: gets a note for each subsection that is left out since the command line sets the
  /// scheme.
  SchemeCheck(const Scene &scene, const SceneFile &file, DiagnosticList &notes)
      : scene_(scene), file_(file), notes_(notes),
        sets_scheme_(file.where(scheme_path, "Scheme").rfind("--set ", 0) == 0) {}

  void check() const {
    refuse_subsection({scene_.scheme().has_matrix ? "Explicit dynamics" : "Solver"});
    if (!scene_.scheme().has_matrix || !scene_.scheme().has_inertia)
      refuse_subsection({"Implicit dynamics"});
    if (scene_.scheme().has_matrix)
      refuse({"Output"}, "History interval");
    if (scene_.scheme().has_inertia)
      refuse({"Restart"}, "Release time");
    constexpr double max_times = 1e7; // maximum number of outputs; more would fill a disk
    for (const std::string key : {"Interval", "History interval"}) {
      const double interval = key == "Interval" ? scene_.output.interval : scene_.output.history_interval;
      if (interval > 0. && interval * max_times < scene_.time_stepping.end_time)
        throw InputError(file_.where({"Output"}, key) + ": '" + key + "'" + in({"Output"}) + " is '" +
                         file_.value({"Output"}, key, "0") +
                         "'; allowed is 0, or at least 1e-7 of the end time");
    }
    for (const auto &body : scene_.bodies)
      check(body, {"Bodies", body.name});
    for (const auto &tool : scene_.tools) {
      const SceneFile::Path path{"Tools", tool.name, "Motion"};
      if (!scene_.scheme().has_inertia)
        for (const std::string key : {"Mass", "Moment of inertia", "Initial speed"})
          refuse(path, key);
      else if (tool.motion.control == Motion::Control::force ||
               tool.motion.control == Motion::Control::moment)
        require(tool.motion.inertia > 0., path,
                tool.motion.control == Motion::Control::force ? "Mass" : "Moment of inertia");
    }
    for (const auto &pair : scene_.pairs)
      if (pair.facets.edges == ContactPair::Edges::held && scene_.scheme().has_matrix)
        refuse_entry({"Contact pairs", pair.name}, "Edge contact");
      else if (!scene_.scheme().has_matrix) {
        refuse({"Contact pairs", pair.name}, "Initial penetration");
        if (pair.penetration_tolerance.value_or(0.) > 0.)
          refuse_entry({"Contact pairs", pair.name}, "Penetration tolerance");
      }
  }

private:
  void check(const Body &body, const SceneFile::Path &path) const {
    if (scene_.scheme().has_inertia)
      require(body.material.density.value > 0., {path[0], path[1], "Material"}, "Density");
    if (scene_.scheme().has_inertia && body.is_stabilised.value)
      throw excluded_by_scheme(body.is_stabilised.origin +
                               " is 'until contact'; allowed is 'none', since 'Scheme' is " +
                               name_of_scheme() + ": the mass of a body resists its motion");
    if (!scene_.scheme().has_matrix && body.element.value.points_through > 2)
      throw excluded_by_scheme(body.element.value.points_origin + " is '" +
                               std::to_string(body.element.value.points_through) +
                               "'; allowed is 2, since 'Scheme' in 'Time stepping' is explicit");
    const bool in_float = scene_.explicit_dynamics.number_type == NumberType::float_precision;
    if (!scene_.scheme().has_matrix && in_float && !has_kernel(body.element.value.type, *body.material.law))
      throw InputError(
          file_.where({"Explicit dynamics"}, "Number type") +
          ": 'Number type' in 'Explicit dynamics' is 'float'; allowed is double, since no kernel "
          "computes body '" +
          body.name + "' in float: " + body.element.value.type.name() + ", " +
          describe_law(*body.material.law));
    if (!scene_.scheme().has_matrix)
      return;
    if (!scene_.scheme().has_inertia)
      refuse(path, "Initial velocity");
    for (const Load &load : body.loads)
      if (load.load.acts_on_mass() && !(body.material.density.value > 0.))
        throw InputError(file_.where({path[0], path[1], "Material"}, "Density") + ": 'Density' of body '" +
                         body.name + "' is 0; allowed is a number > 0, since load '" + load.name +
                         "' acts on the mass. 'Type = body force' gives a force per volume instead");
  }
  void refuse(const SceneFile::Path &path, const std::string &key) const {
    if (file_.is_set(path, key))
      refuse_entry(path, key);
  }
  void refuse_subsection(const SceneFile::Path &path) const {
    const SceneFile::Entry *entry = file_.first_entry(path);
    if (entry == nullptr)
      return;
    if (!sets_scheme_ || entry->files.empty())
      refuse_entry(path, entry->key);
    notes_.push_back(Diagnostic(diagnostic::parameters_left_out,
                                "The command line sets 'Scheme = " + name_of_scheme() +
                                    "', so that the parameters of '" + path.back() + "' do not count")
                         .origin(entry->where));
  }
  [[noreturn]] void refuse_entry(const SceneFile::Path &path, const std::string &key) const {
    throw excluded_by_scheme(file_.where(path, key) + ": '" + key + "'" + in(file_.written_path(path, key)) +
                             " is '" + file_.value(path, key, "") +
                             "'; allowed is no value: 'Scheme' in 'Time stepping' is " + name_of_scheme() +
                             (sets_scheme_ ? " (" + file_.where(scheme_path, "Scheme") + "). --set '" +
                                                 join(path, "/") + "/" + key + "=' takes the value away"
                                           : ""));
  }
  static std::string join(const SceneFile::Path &path, const std::string &separator) {
    std::string names;
    for (const auto &name : path)
      names += (names.empty() ? "" : separator) + name;
    return names;
  }
  const std::string &name_of_scheme() const { return name_of(scene_.time_stepping.scheme); }
  static std::string in(const SceneFile::Path &path) {
    std::string names;
    for (const auto &name : path)
      names += (names.empty() ? " in '" : " / ") + name;
    return names + "'";
  }
  void require(const bool is_there, const SceneFile::Path &path, const std::string &key) const {
    if (!is_there)
      throw InputError(scene_error(file_.where(path, key) + ": '" + key + "'" + in(path) + " is '" +
                                       file_.value(path, key, "0") +
                                       "'; allowed is a number > 0, since the scheme is " + name_of_scheme(),
                                   {SceneFault::Kind::wrong_number, "", {"Scheme"}}));
  }

  static const SceneFile::Path scheme_path;
  const Scene &scene_;
  const SceneFile &file_;
  DiagnosticList &notes_;
  bool sets_scheme_; ///< whether the command line does
};

const SceneFile::Path SchemeCheck::scheme_path{"Time stepping"};

/// Sets the field output of an explicit scene without a step interval. Enough for an animation,
/// unless the scene has an interval of its own.
void set_explicit_intervals(Scene &scene, const bool has_interval) {
  constexpr double n_intervals = 20.;
  scene.output.every_steps = 0;
  if (!has_interval)
    scene.output.interval = scene.time_stepping.end_time / n_intervals;
}

} // namespace

std::string Scene::print_target() const {
  std::ostringstream text;
  text << 100. * (target_error + mesh_target.error) << " %";
  if (mesh_target.is_wanted()) {
    text.precision(2);
    text << " (" << 100. * mesh_target.error << " % for the mesh)";
  }
  return text.str();
}

double Scene::automatic_fade_time() const {
  constexpr double part_of_time = 0.01;
  return scheme().has_inertia ? 0. : part_of_time * time_stepping.end_time;
}

std::size_t Scene::body_index(const ContactPair &pair) const { return index_of(bodies, pair.body); }

std::size_t Scene::second_body_index(const ContactPair &pair) const {
  return index_of(bodies, pair.second_body);
}

std::size_t Scene::tool_index(const ContactPair &pair) const { return index_of(tools, pair.tool); }

std::size_t Scene::body_index(const Probe &probe) const {
  return probe.body.value.empty() ? 0 : index_of(bodies, probe.body);
}

void check_repeated_pairs(const std::vector<ContactPair> &pairs, const bool names_are_known) {
  const auto is_known = [&](const ContactPair &pair) {
    const auto has_ids = [](const BoundaryIds &ids) { return ids.names.empty() && !ids.are_all; };
    return names_are_known || (has_ids(pair.boundary_ids) && has_ids(pair.second_boundary_ids));
  };
  for (auto second = pairs.begin(); second != pairs.end(); ++second)
    for (auto first = pairs.begin(); first != second; ++first) {
      const unsigned int id =
          is_known(*first) && is_known(*second) ? repeated_id(*first, *second) : Side::no_id;
      if (id == Side::no_id)
        continue;
      std::string names;
      for (const std::string &name : second->boundary_ids.names)
        names += (names.empty() ? " (in " : ", ") + name;
      throw InputError(second->boundary_ids.origin + " names boundary id " + std::to_string(id) + names +
                       (names.empty() ? "" : ")") + "; allowed are other ids, since pair '" + first->name +
                       "' already names it against the same " +
                       (first->is_between_bodies() ? "faces" : "tool"));
    }
}

Scene::Scene() = default;
Scene::Scene(const Scene &) = default;
Scene::Scene(Scene &&) noexcept = default;
Scene &Scene::operator=(const Scene &) = default;
Scene &Scene::operator=(Scene &&) noexcept = default;
Scene::~Scene() = default;

Scene Scene::read(const std::string &file_name, const std::string &restart_file,
                  const std::vector<SceneFile::Setting> &settings) {
  return read(SceneFile::read(file_name, settings), restart_file);
}

Scene Scene::read(SceneFile file, const std::string &restart_file) {
  const std::string file_name = file.file_name();
  load_libraries(file);
  const std::vector<std::string> generated = add_general_contact(file);
  ParameterHandler prm;
  declare_all(prm,
              {[&file](const SceneFile::Path &path) { return file.names_below(path); },
               [&file](const SceneFile::Path &path) { return file.value(path, "Shape", default_shape); }});
  file.set_all(prm);

  Scene scene{};
  scene.warnings = describe_old_names(file);
  scene.presets = apply_presets(prm, file, generated);
  scene.target_error = read_target_error(file);
  scene.mesh_target = read_mesh_target(file);
  Reader reader(prm, file);
  reader.collect_errors();
  scene.profile = reader.text("Profile");
  scene.title = reader.text("Title");
  scene.warnings_are_errors = reader.text("Warnings") == "errors";
  scene.file_name = file_name;
  scene.text = file.text();
  scene.amplitudes = parse_named<Amplitude>(reader, "Amplitudes");
  scene.bodies = parse_named<Body>(reader, "Bodies");
  scene.tools = parse_named<Tool>(reader, "Tools");
  check_general_contact(reader, file);
  scene.pairs = parse_named<ContactPair>(reader, "Contact pairs");
  for (auto &pair : scene.pairs)
    pair.is_generated = std::count(generated.begin(), generated.end(), pair.name) > 0;
  scene.probes = parse_named<Probe>(reader, "Probes");
  reader.in("Time stepping", [&] { scene.time_stepping.parse(reader); });
  reader.in("Explicit dynamics", [&] { scene.explicit_dynamics.parse(reader); });
  reader.in("Implicit dynamics", [&] {
    scene.implicit_dynamics.parse(reader, scene.time_stepping.control == TimeStepping::Control::fixed);
  });
  reader.in("Solver", [&] { scene.solver.parse(reader); });
  reader.in("Output", [&] { scene.output.parse(reader); });
  reader.in("Restart", [&] { scene.restart.parse(reader); });
  bool has_amplitudes = true; // names that expressions can use
  for (const auto &amplitude : scene.amplitudes)
    reader.note_errors([&] {
      const bool had_all = std::exchange(has_amplitudes, false);
      check_amplitude_name(amplitude.name, file.where({"Amplitudes", amplitude.name}));
      has_amplitudes = had_all;
    });
  check_names(scene, reader);
  if (has_amplitudes)
    check_expressions(scene, reader);
  reader.require_sound();
  if (scene.output.folder.value.empty())
    scene.output.folder.value = default_folder(file_name);
  if (!restart_file.empty())
    scene.restart.file = {restart_file, "command line: --restart"};

  if (scene.bodies.empty())
    throw InputError(file_name + ": the scene has no body; allowed is at least one subsection in 'Bodies'");
  reader.note_errors([&] { check_repeated_pairs(scene.pairs, false); });
  for (const auto &probe : scene.probes)
    reader.note_errors([&] { check_probe(scene, probe); });
  reader.note_errors([&] { SchemeCheck(scene, file, scene.warnings).check(); });
  reader.require_sound();
  if (!scene.scheme().has_matrix && !file.is_set({"Output"}, "Step interval"))
    set_explicit_intervals(scene, file.is_set({"Output"}, "Interval"));
  for (const auto &tool : scene.tools)
    if (std::isfinite(tool.motion.removal_time.value) &&
        tool.motion.removal_time.value >= scene.time_stepping.end_time)
      throw InputError(tool.motion.removal_time.origin + " is " +
                       dealii::Utilities::to_string(tool.motion.removal_time.value) +
                       "; allowed is a time before the end time");
  return scene;
}

void declare_every_parameter(ParameterHandler &prm) {
  const std::string prefix = name_of_surface;
  const auto names_below = [&prefix](const SceneFile::Path &path) -> std::vector<std::string> {
    if (path.back() == "Surfaces") {
      std::vector<std::string> names;
      for (const auto &type : surface_types())
        names.push_back(prefix + type.name + ")");
      return names;
    }
    return {path.back() == "Amplitudes" ? "(name of an amplitude)"
            : path.back() == "Bodies"   ? "(name of a body)"
            : path.back() == "Supports" ? "(name of a support)"
            : path.back() == "Loads"    ? "(name of a load)"
            : path.back() == "Tools"    ? "(name of a tool)"
            : path.back() == "Probes"   ? "(name of a probe)"
                                        : "(name of a contact pair)"};
  };
  declare_all(prm, {names_below, [&prefix](const SceneFile::Path &path) {
                      return path.back().substr(prefix.size(), path.back().size() - prefix.size() - 1);
                    }});
}

void print_all_parameters(std::ostream &stream) {
  ParameterHandler prm;
  declare_every_parameter(prm);
  prm.print_parameters(stream, ParameterHandler::PRM | ParameterHandler::KeepDeclarationOrder);
}

} // namespace billet::parameters
