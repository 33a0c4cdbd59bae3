// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/profile.h"

#include "billet/errors.h"
#include "billet/friction/friction_law.h"
#include "billet/material/law_type.h"
#include "billet/mechanics/explicit_block.h"
#include "billet/parameters/body.h"
#include "billet/parameters/control.h"
#include "billet/parameters/reader.h"
#include "billet/parameters/registered.h"
#include "billet/parameters/tool.h"

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace billet::parameters {

namespace {

using Path = SceneFile::Path;

/// Schemes to which a row applies. Statics is divided by materials: path-dependent, elastic with
/// friction, elastic with self-contact, and independent of steps.
constexpr unsigned int statics_with_path = 1, statics_with_slip = 8, statics_with_folds = 32,
                       statics_without_path = 16, implicit_dynamics = 2, explicit_dynamics = 4,
                       statics_elastic = statics_with_slip | statics_with_folds | statics_without_path,
                       statics = statics_with_path | statics_elastic, implicit = statics | implicit_dynamics;

/// Values of a parameter for the profiles and the target error; empty: the parameter's default. T
/// is the end time, E the target error. "0.2 T" and "0.5 E" are products, "0.3 E 1e-3" is a product
/// with a maximum, and "0.03 / E" is a quotient.
struct Row {
  unsigned int schemes;
  const char *section; ///< subsection; each one for "Contact pairs", "Bodies", "Materials"
  const char *key;
  const char *fast, *balanced, *accurate, *target;
};

// Table of presets. 'balanced' is the default of nearly every parameter. Costs and errors of each
// profile: scripts/benchmarks profiles; of the target error: doc/results/target-error.md.
constexpr std::array<Row, 34> rows = {{
    // Steps. Iterations alone control the steps of `fast`; their maximum is such that a step does
    // not need more iterations than two of half the length. Steps of `balanced` are half as long
    // where the forces may depend on them. That halves the error of plastic scenes, and takes 0.8
    // to 1.7 times the iterations.
    //
    // Error estimates control the steps of `accurate`. In elastic bodies without friction they
    // alone suffice. They do not see what lies between the ends of steps, which matters where
    // friction makes curved paths.
    {statics_with_path, "Time stepping", "Initial step", "0.05 T", "", "0.005 T", "0.04 T"},
    {statics_with_slip, "Time stepping", "Initial step", "0.05 T", "", "0.02 T", "0.1 T"},
    {statics_with_folds, "Time stepping", "Initial step", "0.05 T", "", "0.005 T", "0.02 T"},
    {statics_without_path, "Time stepping", "Initial step", "0.05 T", "", "0.1 T", "0.3 T"},
    {statics, "Time stepping", "Minimum step", "1e-6 T", "", "1e-6 T", "1e-6 T"},
    {statics_with_path, "Time stepping", "Maximum step", "0.1 T", "0.05 T", "0.02 T", "0.1 T"},
    {statics_with_slip, "Time stepping", "Maximum step", "0.1 T", "0.05 T", "0.05 T", "0.2 T"},
    {statics_with_folds, "Time stepping", "Maximum step", "0.1 T", "0.05 T", "0.02 T", "0.05 T"},
    {statics_without_path, "Time stepping", "Maximum step", "0.1 T", "", "0.2 T", "0.5 T"},
    {statics, "Time stepping", "Error tolerance", "", "", "1e-3", "0.4 E"},
    {implicit_dynamics, "Time stepping", "Initial step", "", "", "", "0.01 T"},
    {implicit_dynamics, "Time stepping", "Minimum step", "", "", "", "1e-7 T"},
    {implicit_dynamics, "Time stepping", "Maximum step", "", "", "", "0.1 T"},
    {implicit_dynamics, "Implicit dynamics", "Error tolerance", "2e-2", "", "1e-4", "0.2 E 2e-2"},
    {implicit_dynamics, "Time stepping", "Growth iterations", "8", "", "", "8"},
    {implicit_dynamics, "Time stepping", "Shrink iterations", "14", "", "", "14"},
    {implicit_dynamics, "Time stepping", "Growth factor", "2", "", "", "2"},
    {statics, "Time stepping", "Growth iterations", "", "", "", "8"},
    {statics, "Time stepping", "Shrink iterations", "", "", "", "14"},
    {statics, "Time stepping", "Growth factor", "", "", "", "2"},
    // Equilibrium.
    {statics, "Solver", "Force tolerance", "", "", "1e-8", "0.3 E 5e-3"},
    {statics, "Solver", "Energy tolerance", "", "", "1e-12", "3e-3 E 5e-5"},
    {implicit_dynamics, "Solver", "Force tolerance", "", "", "1e-8", "0.3 E 3e-3"},
    {implicit_dynamics, "Solver", "Energy tolerance", "", "", "1e-12", "3e-3 E 3e-5"},
    {implicit, "Solver", "Displacement tolerance", "", "", "1e-4", "1 E 1e-2"},
    {implicit, "Solver", "Linear tolerance", "1e-4", "", "", "0.03 E 1e-3"},
    // Contact. All augment in statics: `fast` only in soft bodies, since a tenth of Young's modulus
    // makes a penetration of 0.01. They do not in dynamics, since penetrating nodes would have to
    // stop within a step. In explicit scenes `accurate` and the target error raise the penalty or
    // the resolution in time.
    {statics, "Contact pairs", "Penetration tolerance", "0.01", "", "automatic", "1e-5"},
    // Only for self-contact, which occurs in few places and late.
    {statics, "Contact pairs", "Facets", "planed", "", "", ""},
    {explicit_dynamics, "Contact pairs", "Normal penalty", "1", "", "40", "0.09 / E"},
    {explicit_dynamics, "Explicit dynamics", "Contact resolution", "1", "", "4", ""},
    {explicit_dynamics, "Explicit dynamics", "Safety factor", "0.95", "", "0.4", "0.9"},
    // Elements and laws. A target error changes neither elements nor the mesh. The law with the
    // final instantaneous rotation differs from the multiplicative law by less than a thousandth
    // for small elastic strains.
    {explicit_dynamics, "Bodies", "Element", "one point", "", "", ""},
    {explicit_dynamics, "Materials", "Elasticity", "hypoelastic", "", "", "hypoelastic"},
    // After elements and laws, which must have kernels in float.
    {explicit_dynamics, "Explicit dynamics", "Number type", "float", "", "", ""},
}};

constexpr const char *profile_key = "Profile", *target_key = "Target error",
                     *target_of_key = "Target error of", *finest_key = "Finest mesh level";
constexpr const char *of_mesh_given = "mesh given", *of_everything = "everything";
constexpr double part_of_mesh = 2. / 3.; // its error falls the most slowly with the cost
// Smaller targets are below the errors of Newton's method and round-off.
constexpr double min_target = 1e-6;

double number_in(const std::string &text, const double otherwise) {
  try {
    return parse_number(text);
  } catch (const std::invalid_argument &) { // refused when the parameter is read
    return otherwise;
  }
}

/// Bodies as the scene and the presets so far make them, for presets that depend on their laws.
class BodyDrafts {
public:
  BodyDrafts(dealii::ParameterHandler &prm, const SceneFile &file) : prm_(prm), file_(file) {}

  /// Returns the material of a body. Its law is null if values are refused, which reading the scene
  /// reports.
  Material material(const std::string &body) const {
    Material material;
    read(body, [&](Reader &reader) { reader.in("Material", [&] { material.parse(reader); }); });
    return material;
  }
  bool is_plastic(const std::string &body) const {
    const auto law = material(body).law;
    return law != nullptr && law->has_plasticity();
  }
  /// Whether the elastic strain at the initial yield stress is at most 1 %.
  bool has_small_elastic_strains(const std::string &body) const {
    constexpr double small = 0.01;
    const Material draft = material(body);
    return draft.law != nullptr && draft.law->has_plasticity() &&
           draft.law->flow_stress()->stress(0.) <= small * draft.elasticity->young_modulus();
  }
  /// Whether the explicit kernels have the elements and laws of all bodies.
  bool have_kernels() const {
    const std::vector<std::string> bodies = file_.names_below({"Bodies"});
    return std::all_of(bodies.begin(), bodies.end(), [this](const std::string &body) {
      const auto law = material(body).law;
      return law != nullptr && has_kernel(element(body), *law);
    });
  }
  /// Whether stresses or dashpots depend on the path. Friction does, too, but slip soon loses the
  /// influence of earlier steps, so that it needs no shorter ones.
  bool depend_on_path() const {
    const std::vector<std::string> bodies = file_.names_below({"Bodies"});
    return std::any_of(bodies.begin(), bodies.end(), [this](const std::string &body) {
      const auto law = material(body).law;
      return (law != nullptr && depends_on_path(*law)) || has_dashpots(body);
    });
  }

private:
  bool has_dashpots(const std::string &body) const {
    const std::vector<std::string> loads = file_.names_below({"Bodies", body, "Loads"});
    return std::any_of(loads.begin(), loads.end(), [&](const std::string &name) {
      Load load;
      bool is_read = false;
      read(body, [&](Reader &reader) {
        reader.in("Loads", [&] { reader.in(name, [&] { load.parse(reader); }); });
        is_read = true;
      });
      return is_read && load.load.is_viscous();
    });
  }
  BrickElement element(const std::string &body) const {
    BrickElement element = BrickElement::assumed_strain;
    read(body, [&](Reader &reader) { element = find_selected(reader, "Element", element_types()).element; });
    return element;
  }
  /// Calls `read` in the subsection of a body, up to the first value that is refused.
  template <class Read> void read(const std::string &body, const Read &read) const {
    Reader reader(prm_, file_);
    try {
      reader.in("Bodies", [&] { reader.in(body, [&] { read(reader); }); });
    } catch (const InputError &) { // reading the scene refuses it again
    }
  }

  dealii::ParameterHandler &prm_;
  const SceneFile &file_;
};

bool has_friction(const SceneFile &file) {
  const std::vector<std::string> pairs = file.names_below({"Contact pairs"});
  return std::any_of(pairs.begin(), pairs.end(), [&file](const std::string &name) {
    const Path path = {"Contact pairs", name};
    const FrictionLawType *type =
        friction_law_types().find(file.value(path, "Friction law", default_friction_law));
    return type == nullptr || type->vanishes_with.empty() ||
           number_in(file.value(path, type->vanishes_with, "0"), 1.) != 0.;
  });
}

/// Whether there is self-contact, in which surfaces may pass through each other in long steps, in
/// other pairs than generated ones.
bool folds_onto_itself(const SceneFile &file, const std::vector<std::string> &generated_pairs) {
  const std::vector<std::string> pairs = file.names_below({"Contact pairs"});
  return std::any_of(pairs.begin(), pairs.end(), [&](const std::string &name) {
    const Path path = {"Contact pairs", name};
    return std::count(generated_pairs.begin(), generated_pairs.end(), name) == 0 &&
           file.is_set(path, "Second body") &&
           file.value(path, "Second body", "") == file.value(path, "Body", "");
  });
}

TimeStepping::Scheme scheme_of(const SceneFile &file) {
  return chosen(schemes(),
                file.value({"Time stepping"}, "Scheme", name_of(TimeStepping::Scheme::quasi_static)));
}

/// Returns the scheme in the sense of rows.
unsigned int kind_of_scheme(const SceneFile &file, const BodyDrafts &bodies,
                            const std::vector<std::string> &generated_pairs) {
  switch (scheme_of(file)) {
  case TimeStepping::Scheme::explicit_dynamics:
    return explicit_dynamics;
  case TimeStepping::Scheme::implicit_dynamics:
    return implicit_dynamics;
  case TimeStepping::Scheme::quasi_static:
    break;
  }
  return bodies.depend_on_path()                    ? statics_with_path
         : folds_onto_itself(file, generated_pairs) ? statics_with_folds
         : has_friction(file)                       ? statics_with_slip
                                                    : statics_without_path;
}

std::vector<Path> paths_of(const std::string &section, const SceneFile &file) {
  std::vector<Path> paths;
  if (section == "Contact pairs" || section == "Bodies")
    for (const auto &name : file.names_below({section}))
      paths.push_back({section, name});
  else if (section == "Materials")
    for (const auto &name : file.names_below({"Bodies"}))
      paths.push_back({"Bodies", name, "Material"});
  else
    paths.push_back({section});
  return paths;
}

// Minimum target in single precision: its error of the forces, with a margin.
constexpr double min_target_of_float = 1e-5;

// Minimum target for which the hypoelastic law may replace Hencky's: ten times what they differ by
// in the shipped scenes.
constexpr double min_target_of_rates = 1e-3;

/// Whether the row is useful with the other settings of the scene.
bool fits(const Row &row, const Path &path, const SceneFile &file, const BodyDrafts &bodies,
          const double target) {
  const std::string key = row.key;
  if (path == Path{"Time stepping"} && key != "Initial step")
    return file.value(path, "Step control", "automatic") == "automatic";
  if (path == Path{"Implicit dynamics"})
    return file.value({"Time stepping"}, "Step control", "automatic") == "automatic";
  if (key == "Normal penalty")
    return file.value(path, "Penalty unit", "factor") == "factor";
  if (key == "Penetration tolerance") // `fast` keeps to a penalty of the scene, as `balanced` does
    return target > 0. || file.value({}, profile_key, "balanced") == "accurate" ||
           !file.is_set(path, "Normal penalty");
  if (key == "Facets")
    return file.value(path, "Second body", "") == file.value(path, "Body", "");
  if (key == "Elasticity") // hypoelastic laws do not conserve elastic energy
    return bodies.is_plastic(path[1]) &&
           (target == 0. || (target >= min_target_of_rates && bodies.has_small_elastic_strains(path[1])));
  if (key == "Number type")
    return bodies.have_kernels();
  return true;
}

std::string print(const double value) {
  std::ostringstream text;
  text.precision(6);
  text << value;
  return text.str();
}

class Evaluation {
public:
  Evaluation(const SceneFile &file, const double target)
      : end_time_(number_in(file.value({"Time stepping"}, "End time", "1"), 1.)), target_(target) {}

  /// Returns a row's value as a scene file would have it.
  std::string operator()(const std::string &text) const {
    std::istringstream words(text);
    std::string unit, over;
    double factor = 0.;
    if (!(words >> factor) || !(words >> unit))
      return text;
    if (unit == "T")
      return print(factor * end_time_);
    if (unit == "E") {
      double maximum = std::numeric_limits<double>::infinity();
      words >> maximum;
      return print(words ? std::min(factor * target_, maximum) : factor * target_);
    }
    return unit == "/" ? print(factor / target_) : text;
  }

private:
  double end_time_, target_;
};

/// Returns a step of the table, limited by the steps that the scene sets.
std::string between(const std::string &key, const std::string &value, const SceneFile &file) {
  const auto set = [&file](const std::string &key, const double otherwise) {
    return number_in(file.value({"Time stepping"}, key, ""), otherwise);
  };
  const double step = number_in(value, 0.);
  if (key == "Initial step") {
    const double clamped =
        std::max(std::min({step, set("Maximum step", step), set("End time", 1.)}), set("Minimum step", step));
    return clamped == step ? value : print(clamped);
  }
  if (key == "Maximum step" && set("Initial step", 0.) > step)
    return print(set("Initial step", step));
  if (key == "Minimum step" && set("Initial step", step) < step)
    return print(set("Initial step", step));
  return value;
}

[[noreturn]] void refuse_profile(const SceneFile &file, const Path &path, const std::string &key,
                                 const std::string &allowed) {
  throw InputError(file.where(path, key) + ": '" + key + "'" +
                   (path.empty() ? "" : " in '" + join(path) + "'") + " is '" + file.value(path, key, "") +
                   "'; allowed is " + allowed);
}

void check_contradictions(const SceneFile &file, const double target) {
  const std::string reason = std::string(", since there is a '") + target_key + "'";
  const std::vector<std::pair<Path, std::string>> limited = {{{"Time stepping"}, "Error tolerance"},
                                                             {{"Solver"}, "Force tolerance"},
                                                             {{"Implicit dynamics"}, "Error tolerance"}};
  if (file.is_set({}, profile_key))
    refuse_profile(file, {}, profile_key, "no value" + reason);
  if (file.value({"Time stepping"}, "Step control", "automatic") == "fixed")
    refuse_profile(file, {"Time stepping"}, "Step control", "automatic" + reason);
  for (const auto &[path, key] : limited) {
    constexpr double part_of_residuals = 0.3; // larger residuals hide what the steps do
    const double maximum = key == "Force tolerance" ? part_of_residuals * target : target;
    if (file.is_set(path, key) && number_in(file.value(path, key, ""), 0.) > maximum)
      refuse_profile(file, path, key, "a number not above " + print(maximum) + ", or none" + reason);
  }
}

/// Refuses settings that the error estimates do not cover: 'Penetration tolerance' in some pairs
/// only, and, in explicit scenes, settings that change the physics.
void check_what_is_estimated(const SceneFile &file, const double target) {
  const bool is_explicit = !type_of(scheme_of(file)).has_matrix;
  const std::vector<Path> pairs = paths_of("Contact pairs", file);
  const std::string tolerance = "Penetration tolerance";
  const auto is_set = [&](const Path &pair) { return file.is_set(pair, tolerance); };
  const auto one = std::find_if(pairs.begin(), pairs.end(), is_set);
  if (!is_explicit && one != pairs.end() && !std::all_of(pairs.begin(), pairs.end(), is_set))
    refuse_profile(file, *one, tolerance,
                   std::string("a number in every contact pair or in none, since there is a '") + target_key +
                       "', which chooses those of all pairs or of none");
  const Path dynamics = {"Explicit dynamics"};
  if (!is_explicit)
    return;
  if (number_in(file.value(dynamics, "Mass scaling step", "0"), 0.) > 0.)
    refuse_profile(file, dynamics, "Mass scaling step",
                   std::string("none beside a '") + target_key +
                       "': no estimate covers the effect of added mass");
  if (target < min_target_of_float && file.value(dynamics, "Number type", "double") == "float")
    refuse_profile(file, dynamics, "Number type",
                   std::string("double beside a '") + target_key + "' below " + print(min_target_of_float) +
                       ": single precision limits the accuracy to 1e-6 of the forces");
}

} // namespace

void declare_presets(dealii::ParameterHandler &prm) {
  prm.declare_entry(profile_key, "balanced", dealii::Patterns::Selection("fast|balanced|accurate"),
                    "Choice between speed and accuracy: it sets the defaults of steps, solver, contact and "
                    "elements. Values in the scene take precedence. --check lists the values of the profile. "
                    "fast: coarser steps and cheaper elements. accurate: finer steps and tolerances. "
                    "balanced: the defaults of "
                    "this list, with shorter static steps where the forces depend on them.");
  prm.declare_entry(target_key, "", dealii::Patterns::Anything(),
                    "Maximum error of the force curves, such as '1 percent', '1 %' or '0.01'. Error "
                    "estimates control steps, tolerances and augmentation during the run. The run prints the "
                    "estimated error at the end. Empty: none.");
  prm.declare_entry(
      target_of_key, of_mesh_given,
      dealii::Patterns::Selection(std::string(of_mesh_given) + "|" + of_everything),
      "mesh given: 'Target error' is that of all sources but the mesh. everything: two thirds of it are "
      "left to the mesh. The scene runs on coarser levels of the given meshes first, then on finer "
      "ones. The run ends where the difference between the last levels is small enough.");
  prm.declare_entry(
      finest_key, "1", dealii::Patterns::Integer(0),
      "'Target error of = everything': most levels above the given meshes. Each has bricks of half the "
      "size, and costs about ten times as much.");
}

namespace {

/// Returns 'Target error' as a fraction; 0 if it is not set.
double read_whole_target(const SceneFile &file) {
  const std::string text = file.value({}, target_key, "");
  if (text.empty())
    return 0.;
  std::string amount = text;
  double factor = 1.;
  for (const std::string unit : {"percent", "%"})
    if (amount.size() > unit.size() && amount.compare(amount.size() - unit.size(), unit.size(), unit) == 0) {
      amount = dealii::Utilities::trim(amount.substr(0, amount.size() - unit.size()));
      factor = 0.01;
      break;
    }
  const double target = factor * number_in(amount, 0.);
  const std::string found =
      file.where({}, target_key) + ": '" + target_key + "' is '" + text + "'; allowed is ";
  if (!(target > 0. && target < 1.))
    throw InputError(found + "a part > 0 and < 1 of the forces, such as '1 percent' or '0.01'");
  if (target < min_target)
    throw InputError(found +
                     "1e-6 or more: round-off and the residual of Newton's method limit the accuracy");
  return target;
}

bool includes_mesh(const SceneFile &file) {
  return file.value({}, target_of_key, of_mesh_given) == of_everything;
}

} // namespace

double read_target_error(const SceneFile &file) {
  return (includes_mesh(file) ? 1. - part_of_mesh : 1.) * read_whole_target(file);
}

MeshTarget read_mesh_target(const SceneFile &file) {
  const double target = read_whole_target(file);
  if (!includes_mesh(file)) {
    if (file.is_set({}, finest_key))
      refuse_profile(file, {}, finest_key,
                     std::string("no value without '") + target_of_key + " = " + of_everything + "'");
    return {};
  }
  if (!(target > 0.))
    refuse_profile(file, {}, target_of_key, std::string("no value without a '") + target_key + "'");
  constexpr double most = 10.;
  const double finest = number_in(file.value({}, finest_key, "1"), 1.);
  if (!(finest <= most))
    refuse_profile(file, {}, finest_key, "a whole number from 0 to 10");
  return {part_of_mesh * target, static_cast<unsigned int>(finest)};
}

std::vector<Preset> apply_presets(dealii::ParameterHandler &prm, const SceneFile &file,
                                  const std::vector<std::string> &generated_pairs) {
  const double target = read_target_error(file);
  if (target > 0.) {
    check_contradictions(file, target);
    check_what_is_estimated(file, target);
  }
  const std::string profile = file.value({}, profile_key, "balanced");
  const BodyDrafts bodies(prm, file);
  // Most generated pairs of bodies with themselves never touch. Under a target error, measurements
  // shorten steps and augment where that is necessary.
  const unsigned int scheme =
      kind_of_scheme(file, bodies, target > 0. ? generated_pairs : std::vector<std::string>());
  const Evaluation evaluate(file, target);
  std::vector<Preset> presets;
  for (const auto &row : rows) {
    const std::string text = target > 0.             ? row.target
                             : profile == "fast"     ? row.fast
                             : profile == "accurate" ? row.accurate
                                                     : row.balanced;
    if (text.empty() || (row.schemes & scheme) == 0)
      continue;
    const std::vector<Path> paths = paths_of(row.section, file);
    for (const auto &path : paths) {
      if (file.is_set(path, row.key) || !fits(row, path, file, bodies, target))
        continue;
      presets.push_back({path, row.key, between(row.key, evaluate(text), file)});
      for (const auto &name : path)
        prm.enter_subsection(name);
      prm.set(row.key, presets.back().value);
      for (std::size_t i = 0; i < path.size(); ++i)
        prm.leave_subsection();
    }
  }
  return presets;
}

std::string to_string(const Preset &preset) {
  return join(preset.path) + " / " + preset.key + " = " + preset.value;
}

} // namespace billet::parameters
