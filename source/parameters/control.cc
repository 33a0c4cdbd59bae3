// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/control.h"

#include "billet/material/csv_columns.h"

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <stdexcept>

namespace billet::parameters {

using dealii::ParameterHandler;
namespace Patterns = dealii::Patterns;

namespace {

const NamedValues<Amplitude::Interpolation> interpolations = {{"linear", Amplitude::Interpolation::linear},
                                                              {"smooth", Amplitude::Interpolation::smooth}};

const NamedValues<TimeStepping::Control> step_controls = {{"automatic", TimeStepping::Control::automatic},
                                                          {"fixed", TimeStepping::Control::fixed}};

const NamedValues<InstructionSet> instruction_sets = {{"automatic", InstructionSet::automatic},
                                                      {"scalar", InstructionSet::scalar},
                                                      {"SSE2", InstructionSet::sse2},
                                                      {"AVX2", InstructionSet::avx2},
                                                      {"AVX-512", InstructionSet::avx512}};

const NamedValues<NumberType> number_types = {{"double", NumberType::double_precision},
                                              {"float", NumberType::float_precision}};

const NamedValues<ContactTangent> contact_tangents = {
    {"automatic", ContactTangent::automatic},
    {"exact", ContactTangent::exact},
    {"numerical", ContactTangent::numerical},
    {"consistent", ContactTangent::consistent},
    {"continuum", ContactTangent::continuum},
    {"symmetrised upper", ContactTangent::symmetrised_upper},
    {"symmetrised lower", ContactTangent::symmetrised_lower},
    {"symmetrised mean", ContactTangent::symmetrised_mean}};

const NamedValues<MaterialTangent> material_tangents = {{"automatic", MaterialTangent::automatic},
                                                        {"exact", MaterialTangent::exact},
                                                        {"symmetrised", MaterialTangent::symmetrised}};

const NamedValues<Solver::LineSearch> line_searches = {{"none", Solver::LineSearch::none},
                                                       {"energy", Solver::LineSearch::energy}};

const NamedValues<Solver::Predictor> predictors = {{"tangent", Solver::Predictor::tangent},
                                                   {"extrapolation", Solver::Predictor::extrapolation}};

const NamedValues<Solver::Forcing> forcings = {{"Eisenstat-Walker", Solver::Forcing::eisenstat_walker},
                                               {"fixed", Solver::Forcing::fixed}};

const NamedValues<Output::Format> formats = {
    {"vtu", Output::Format::vtu}, {"hdf5", Output::Format::hdf5}, {"none", Output::Format::none}};

const NamedValues<Output::Verbosity> verbosities = {{"quiet", Output::Verbosity::quiet},
                                                    {"steps", Output::Verbosity::steps},
                                                    {"iterations", Output::Verbosity::iterations}};

} // namespace

const std::vector<SchemeType> &scheme_types() {
  using Scheme = TimeStepping::Scheme;
  static const std::vector<SchemeType> types = {
      // scheme, name, description, has inertia, has a matrix, lumps the mass
      {Scheme::quasi_static, "quasi-static", "quasi-static, implicit", false, true, false},
      {Scheme::explicit_dynamics, "explicit", "dynamic, explicit", true, false, true},
      {Scheme::implicit_dynamics, "implicit dynamics", "dynamic, implicit", true, true, false}};
  return types;
}

const SchemeType &type_of(const TimeStepping::Scheme scheme) {
  for (const SchemeType &type : scheme_types())
    if (type.scheme == scheme)
      return type;
  throw std::logic_error("a scheme has no row in scheme_types()");
}

const NamedValues<TimeStepping::Scheme> &schemes() {
  static const NamedValues<TimeStepping::Scheme> names = [] {
    NamedValues<TimeStepping::Scheme> values;
    for (const SchemeType &type : scheme_types())
      values.emplace_back(type.name, type.scheme);
    // Most users and the manual say so.
    values.emplace_back("static", TimeStepping::Scheme::quasi_static);
    return values;
  }();
  return names;
}

const std::string &name_of(const TimeStepping::Scheme scheme) { return type_of(scheme).name; }

const NamedValues<std::optional<LinearMethod>> &linear_methods() {
  static const NamedValues<std::optional<LinearMethod>> methods = [] {
    NamedValues<std::optional<LinearMethod>> named = {{"automatic", std::nullopt}};
    for (const LinearMethod &method : all_linear_methods())
      named.emplace_back(name_of(method), method);
    return named;
  }();
  return methods;
}

std::string methods_for_unsymmetric() {
  std::string names;
  for (const auto &[name, method] : linear_methods())
    if (!method || !requires_symmetry(*method))
      names += (names.empty() ? "" : ", ") + name;
  return names;
}

void Amplitude::declare(ParameterHandler &prm) {
  prm.declare_entry("Times", "0, 1", Patterns::Anything(),
                    "Strictly increasing times. Before the first and after the last time the value is "
                    "constant. Steps of implicit scenes end where the motion reverses, begins, ends or "
                    "changes its rate by more than half. [time]");
  prm.declare_entry("Values", "0, 1", Patterns::Anything(), "Values, one for each time. [any]");
  prm.declare_entry("File", "", Patterns::Anything(),
                    "CSV file of times and values, relative to the scene file, instead of 'Times' and "
                    "'Values'. Lines before the first number and comments after '#' are skipped.");
  prm.declare_entry("File columns", "1, 2", Patterns::Anything(),
                    "Columns of that file with times and values, from 1.");
  prm.declare_entry("Interpolation", "linear", Patterns::Selection(selection(interpolations)),
                    "linear: straight lines between the times. smooth: quintic steps with vanishing first "
                    "and second derivative at "
                    "each time.");
}

void Amplitude::parse(Reader &reader) {
  const bool is_from_file = !reader.text("File").empty();
  if (is_from_file) {
    for (const std::string key : {"Times", "Values"})
      if (reader.is_set(key))
        reader.reject(key, "no value: times and values come from 'File'");
    for (const auto &[time, value] : read_columns(reader, "File", "File columns")) {
      times.push_back(time);
      values.push_back(value);
    }
  } else {
    if (reader.is_set("File columns"))
      reader.reject("File columns", "no value: there is no 'File'");
    times = reader.numbers("Times");
    values = reader.numbers("Values");
  }
  if (times.empty())
    reader.reject("Times", "at least one number");
  for (std::size_t i = 1; i < times.size(); ++i)
    if (!(times[i] > times[i - 1]))
      reader.reject(is_from_file ? "File" : "Times", "strictly increasing numbers");
  if (values.size() != times.size())
    reader.reject("Values", "as many numbers as there are times (" + std::to_string(times.size()) + ")");
  interpolation = chosen(interpolations, reader.text("Interpolation"));
}

void TimeStepping::declare(ParameterHandler &prm) {
  prm.declare_entry("End time", "1", Patterns::Double(),
                    "> 0. The run begins at time 0 and ends at this time. [time]");
  prm.declare_entry("Scheme", name_of(Scheme::quasi_static), Patterns::Selection(selection(schemes())),
                    "Bodies of dynamic scenes need a density. quasi-static: equilibrium at the end of each "
                    "step, by Newton's method. explicit: motion by central differences, in steps as short as "
                    "elements and contact require. implicit dynamics: motion by Newton's method, in steps as "
                    "long as accuracy allows. static: another name of quasi-static.");
  prm.declare_entry("Stops", "", Patterns::Anything(),
                    "Further times at which steps end, separated by commas, such as corners of motions that "
                    "no amplitude describes. [time]");
  prm.declare_entry("Step control", "automatic", Patterns::Selection(selection(step_controls)),
                    "automatic: the step length follows the iterations of the last step, and a failed step "
                    "is cut and repeated. fixed: equal steps, shorter only where the next stop or output "
                    "time is nearer. A failed step ends the run.");
  prm.declare_entry("Initial step", "automatic", Patterns::Anything(),
                    "Length of the first step, or of all steps if they are fixed. automatic: a hundredth of "
                    "the end time, or the maximum step if that is less. [time]");
  prm.declare_entry("Minimum step", "automatic", Patterns::Anything(),
                    "The run fails if a step requires a cut below this length. automatic: a millionth of the "
                    "end time, or the initial step if that is less. [time]");
  prm.declare_entry(
      "Maximum step", "automatic", Patterns::Anything(),
      "A step grows up to this length. automatic: a tenth of the end time, or the initial step "
      "if that is more. Where the scene sets nothing, 'Profile' does: by default a twentieth in "
      "static scenes with plasticity, friction or self-contact. [time]");
  prm.declare_entry(
      "Error tolerance", "0", Patterns::Double(),
      "Quasi-static scenes with automatic steps: maximum error of a step, as a part of the forces. From time "
      "to time a step of twice the length estimates the error. 0: the iterations alone determine the step.");
  prm.declare_entry("Growth iterations", "5", Patterns::Integer(0),
                    "The step grows after this number of iterations or fewer.");
  prm.declare_entry("Shrink iterations", "9", Patterns::Integer(0),
                    "The step shrinks after this number of iterations or more.");
  prm.declare_entry("Growth factor", "1.5", Patterns::Double(), ">= 1. Factor by which a step grows.");
  prm.declare_entry("Shrink factor", "0.7", Patterns::Double(),
                    "> 0 and <= 1. Factor by which a step shrinks.");
  prm.declare_entry("Cut factor", "0.5", Patterns::Double(),
                    "> 0 and < 1. Part of its length with which a failed step is repeated.");
}

namespace {

/// Automatic lengths of steps, as parts of the end time.
struct AutomaticSteps {
  static constexpr double largest = 0.1, first = 0.01, least = 1e-6;
};

} // namespace

void TimeStepping::parse(Reader &reader) {
  end_time = reader.positive("End time");
  stops = reader.numbers("Stops");
  for (const double stop : stops)
    if (!(stop > 0. && stop <= end_time))
      reader.reject("Stops", "numbers > 0, not above the end time");
  scheme = chosen(schemes(), reader.text("Scheme"));
  if (!type_of(scheme).has_matrix) {
    for (const std::string key :
         {"Step control", "Initial step", "Minimum step", "Maximum step", "Growth iterations",
          "Shrink iterations", "Growth factor", "Shrink factor", "Cut factor", "Error tolerance"})
      if (reader.is_set(key) && reader.text(key) != "automatic") // as an including scene says
        reader.reject_beside({"Scheme"}, key,
                             "no value: the steps of an explicit scene follow from its elements");
    return;
  }
  control = chosen(step_controls, reader.text("Step control"));
  const auto step = [&reader](const std::string &key, const double automatic) {
    return reader.text(key) == "automatic" ? automatic : reader.positive(key);
  };
  const auto print = [](const double time) {
    std::ostringstream text;
    text << time;
    return text.str();
  };
  max_step = step("Maximum step", AutomaticSteps::largest * end_time);
  initial_step = step("Initial step", std::min(AutomaticSteps::first * end_time, max_step));
  if (initial_step > end_time)
    reader.reject("Initial step", "a number not above the end time, " + print(end_time));
  if (reader.text("Maximum step") == "automatic")
    max_step = std::max(max_step, initial_step);
  if (control == Control::fixed)
    for (const std::string key : {"Minimum step", "Maximum step", "Growth iterations", "Shrink iterations",
                                  "Growth factor", "Shrink factor", "Cut factor", "Error tolerance"})
      if (reader.is_set(key))
        reader.reject(key, "no value: steps are fixed");
  min_step = step("Minimum step", std::min(AutomaticSteps::least * end_time, initial_step));
  if (control == Control::automatic) {
    if (min_step > initial_step)
      reader.reject("Minimum step", "a number not above the initial step, " + print(initial_step));
    if (max_step < initial_step && !reader.is_set("Initial step"))
      initial_step = max_step; // of a profile
    if (max_step < initial_step)
      reader.reject("Maximum step", "a number not below the initial step, " + print(initial_step));
  }
  error_tolerance = reader.not_negative("Error tolerance");
  if (error_tolerance >= 1.)
    reader.reject("Error tolerance", "a number >= 0 and < 1");
  if (error_tolerance > 0. && type_of(scheme).has_inertia)
    reader.reject_beside({"Scheme"}, "Error tolerance", "no value: that of 'Implicit dynamics' holds");
  few_iterations = reader.count("Growth iterations");
  many_iterations = reader.count("Shrink iterations");
  if (many_iterations <= few_iterations)
    reader.reject("Shrink iterations", "a number above 'Growth iterations'");
  growth_factor = reader.positive("Growth factor");
  if (growth_factor < 1.)
    reader.reject("Growth factor", "a number >= 1");
  shrink_factor = reader.positive("Shrink factor");
  if (shrink_factor > 1.)
    reader.reject("Shrink factor", "a number > 0 and <= 1");
  cut_factor = reader.positive("Cut factor");
  if (cut_factor >= 1.)
    reader.reject("Cut factor", "a number > 0 and < 1");
}

void ExplicitDynamics::declare(ParameterHandler &prm) {
  prm.declare_entry("Safety factor", "0.75", Patterns::Double(),
                    "> 0 and <= 1. Ratio of the step to the stability bound of elements and contact.");
  prm.declare_entry(
      "Contact resolution", "2", Patterns::Double(),
      ">= 1. Factor by which steps resolve the oscillation of a node on its contact penalty finer than "
      "stability requires. 1: longest steps. 2: a third of the energy error of stiff impacts.");
  prm.declare_entry("Linear bulk viscosity", "0.06", Patterns::Double(),
                    "b1 >= 0. A pressure b1 rho c L times the volumetric strain rate damps oscillations; L "
                    "is the element size, c the wave speed.");
  prm.declare_entry("Quadratic bulk viscosity", "1.2", Patterns::Double(),
                    "b2 >= 0. A pressure rho (b2 L)^2 times the square of the volumetric strain rate, in "
                    "compression only, spreads shocks over some elements.");
  prm.declare_entry("Mass scaling step", "0", Patterns::Double(),
                    "Elements with a shorter stable step at the start, including the safety factor, receive "
                    "mass until it has this length. A note reports the added mass. 0: none. [time]");
  prm.declare_entry("Maximum energy drift", "0.05", Patterns::Double(),
                    "> 0. Allowed drift of the energies, as a part of the maximum energy so far. The run "
                    "fails if the drift is larger for a hundred steps, or at the end.");
  prm.declare_entry(
      "Instruction set", "automatic", Patterns::Selection(selection(instruction_sets)),
      "Instruction set of the element kernels. automatic: the fastest one of this machine. Others are "
      "for comparison, and for the same digits on all machines.");
  prm.declare_entry("Number type", "double", Patterns::Selection(selection(number_types)),
                    "Precision of the elements. float: twice as many elements at once, with about seven "
                    "digits. Nodes, sums and energies remain double.");
}

void ExplicitDynamics::parse(Reader &reader) {
  contact_resolution = reader.positive("Contact resolution");
  if (contact_resolution < 1.)
    reader.reject("Contact resolution", "a number >= 1");
  safety_factor = reader.positive("Safety factor");
  if (safety_factor > 1.)
    reader.reject("Safety factor", "a number > 0 and <= 1");
  linear_viscosity = reader.not_negative("Linear bulk viscosity");
  quadratic_viscosity = reader.not_negative("Quadratic bulk viscosity");
  scaled_step = reader.not_negative("Mass scaling step");
  max_drift = reader.positive("Maximum energy drift");
  instructions = chosen(instruction_sets, reader.text("Instruction set"));
  number_type = chosen(number_types, reader.text("Number type"));
}

void Solver::declare(ParameterHandler &prm) {
  prm.declare_entry(
      "Contact tangent", "automatic", Patterns::Selection(selection(contact_tangents)),
      "Tangent of the contact forces. Values other than automatic are for comparison. Symmetric ones save "
      "memory. automatic: exact with friction and between bodies, otherwise "
      "consistent, which keeps the matrix symmetric. It is consistent between bodies, too, without friction "
      "and with a linear solver that requires a symmetric matrix. exact: full derivative, with rotation of "
      "the tool's normal and change of area. numerical: exact by central differences, eq. (43), slow. "
      "consistent: Bittencourt & Creus (1998), eqs. (55)-(57), with constant areas. continuum: their eq. "
      "(50), with constant areas. symmetrised upper: upper triangle of the consistent tangent in the contact "
      "frame, for mu <= 0.1. symmetrised lower: its lower triangle. symmetrised mean: mean of both "
      "triangles.");
  prm.declare_entry("Material tangent", "automatic", Patterns::Selection(selection(material_tangents)),
                    "Tangent of bodies whose exact one is unsymmetric. Scenes without such bodies allow "
                    "automatic only. automatic: "
                    "symmetric part if the rest of the matrix is symmetric, otherwise exact.");
  prm.declare_entry(
      "Force tolerance", "5e-3", Patterns::Double(),
      "A step converges when the norm of the residual, over all nodes, is at most this part of the norm of "
      "the nodal forces. In the last iteration, nodes that change their contact status may carry at most "
      "this part of the contact force. For comparisons with many digits use 1e-6 or less.");
  prm.declare_entry("Energy tolerance", "5e-5", Patterns::Double(),
                    "A step converges when the work of the residual along the last correction is at most "
                    "this part of a reference. The reference is the norm of the nodal forces times that of "
                    "the step's displacements. For comparisons use 1e-10 or less.");
  prm.declare_entry(
      "Displacement tolerance", "1e-2", Patterns::Double(),
      "A step converges when the last correction moves no node by more than this part of the maximum "
      "displacement in the step. A residual below 5e-6 of the forces waives this criterion.");
  prm.declare_entry("Maximum iterations", "60", Patterns::Integer(0),
                    ">= 1. Maximum number of Newton iterations of a step. A step fails as soon as its rate "
                    "of convergence predicts more.");
  prm.declare_entry("Maximum augmentations", "20", Patterns::Integer(0),
                    "Maximum number of augmentations in a step, for contact with a 'Penetration tolerance'. "
                    "A step that requires more fails.");
  prm.declare_entry("Line search", "energy", Patterns::Selection(selection(line_searches)),
                    "energy: the line search shortens a correction while the work of the residual along it "
                    "grows. none, for comparison: it shortens corrections that invert an element only.");
  prm.declare_entry("Predictor", "extrapolation", Patterns::Selection(selection(predictors)),
                    "Initial guess of the iterations of a step. extrapolation: the last increment continued, "
                    "or in implicit dynamics the motion at constant acceleration. tangent: a linear step "
                    "with the motion of tools and supports. It always applies at the start, after a cut, and "
                    "where tools or supports change their rate.");
  prm.declare_entry(
      "Linear solver", "automatic", Patterns::Selection(selection(linear_methods())),
      "Direct solvers are MUMPS, its symmetric form, and KLU. The last is for comparison: it runs on one "
      "rank at a time and is slow. Iterative solvers, with multigrid, are CG, for symmetric "
      "matrices, and GMRES. automatic: direct for small scenes, if memory suffices.");
  prm.declare_entry(
      "Forcing term", "Eisenstat-Walker", Patterns::Selection(selection(forcings)),
      "The relative residual to which iterative solvers solve. Eisenstat-Walker: it falls as Newton's "
      "method converges (Eisenstat & Walker 1996, choice 2). fixed: the linear tolerance.");
  prm.declare_entry("Linear tolerance", "1e-6", Patterns::Double(),
                    "> 0 and < 1. Residual over right-hand side to which iterative solvers solve. With "
                    "Eisenstat-Walker it is the minimum.");
  prm.declare_entry("Maximum linear iterations", "200", Patterns::Integer(0),
                    "Maximum number of iterations of an iterative solver. If it requires more, a direct "
                    "solver replaces it for that matrix.");
}

void Solver::parse(Reader &reader) {
  contact_tangent = chosen(contact_tangents, reader.text("Contact tangent"));
  material_tangent =
      reader.located("Material tangent", chosen(material_tangents, reader.text("Material tangent")));
  force_tolerance = reader.positive("Force tolerance");
  if (force_tolerance >= 1.)
    reader.reject("Force tolerance", "a number > 0 and < 1");
  energy_tolerance = reader.positive("Energy tolerance");
  displacement_tolerance = reader.positive("Displacement tolerance");
  max_iterations = reader.count("Maximum iterations", 1);
  max_augmentations = reader.count("Maximum augmentations", 1);
  line_search = chosen(line_searches, reader.text("Line search"));
  predictor = chosen(predictors, reader.text("Predictor"));
  linear_solver = reader.located("Linear solver", chosen(linear_methods(), reader.text("Linear solver")));
  forcing = chosen(forcings, reader.text("Forcing term"));
  linear_tolerance = reader.positive("Linear tolerance");
  if (linear_tolerance >= 1.)
    reader.reject("Linear tolerance", "a number > 0 and < 1");
  max_linear_iterations = reader.count("Maximum linear iterations", 1);
  if (linear_solver.value && std::holds_alternative<DirectMethod>(*linear_solver.value))
    for (const std::string key : {"Forcing term", "Linear tolerance", "Maximum linear iterations"})
      if (reader.is_set(key))
        reader.reject(key, "no value: the linear solver is direct");
}

void Output::declare(ParameterHandler &prm) {
  prm.declare_entry("Folder", "", Patterns::Anything(),
                    "Folder of all output, relative to the current folder. The run creates it if necessary. "
                    "A folder with results of another run is moved aside first, to FOLDER.1 or the lowest "
                    "free number. It stays with --force and if the run resumes from it. Empty: "
                    "the name of the scene file without its extension.");
  prm.declare_entry(
      "Format", "vtu", Patterns::Selection(selection(formats)),
      "Format of the field output for ParaView. vtu: VTU, one file for each block and output time on any "
      "number of ranks. hdf5: HDF5 and XDMF, one file for each output time. none: no field output.");
  prm.declare_entry("Step interval", "1", Patterns::Integer(0),
                    "Number of steps between field outputs, in addition to those at the start and at the "
                    "end. 0: none, or by the interval. Explicit scenes that set neither write 20 intervals.");
  prm.declare_entry(
      "Interval", "0", Patterns::Double(),
      "Time between field outputs, whose times are multiples of it. Implicit steps end there. Explicit "
      "scenes write at the end of the first step that reaches them. 0: by the step interval. Default of "
      "explicit scenes: 1/20 of the end time. [time]");
  prm.declare_entry("History interval", "0", Patterns::Double(),
                    "Explicit scenes: time between lines of the history, at the end of the first step that "
                    "reaches a multiple of it. 0: 1/200 of the end time. [time]");
  prm.declare_entry("Stress", "true", Patterns::Bool(),
                    "Write Cauchy stress, von Mises stress and pressure.");
  prm.declare_entry("Strain", "true", Patterns::Bool(),
                    "Write the logarithmic strain ln V of the mean deformation gradient of an element.");
  prm.declare_entry(
      "Sheet strains", "false", Patterns::Bool(),
      "Write the major and minor logarithmic strain in the plane of a sheet, and its thinning. "
      "With a 'Forming limit' of a material also the major strain over that limit. The plane is "
      "that of the two longer edges of an undeformed brick.");
  prm.declare_entry("Plastic strain", "true", Patterns::Bool(),
                    "Write the equivalent plastic strain, if a body is plastic.");
  prm.declare_entry(
      "State fields", "", Patterns::Anything(),
      "Fields of the materials' states to write, by name, separated by commas, such as 'inverse plastic "
      "metric'. For an unknown name the message lists those of the scene. In the files they are state_NAME "
      "or state_NAME_COMPONENT, means over the undeformed volume of an "
      "element. They are 0 in bodies whose law does not have them.");
  prm.declare_entry("Contact", "true", Patterns::Bool(),
                    "Write contact pressure, traction, gap, slip and status, if there is contact.");
  prm.declare_entry("Nodal averages", "false", Patterns::Bool(),
                    "Write element fields at the nodes, too, under names that begin with 'averaged_'. A node "
                    "has the mean of the elements of its body around it, weighted by undeformed volume.");
  prm.declare_entry("Verbosity", "steps", Patterns::Selection(selection(verbosities)),
                    "quiet: only warnings and errors. steps: a line for each step. iterations: residuals of "
                    "each iteration, too.");
  prm.enter_subsection("Checkpoint");
  prm.declare_entry("Step interval", "0", Patterns::Integer(0),
                    "Number of steps between checkpoints, from which the run can resume. Another one follows "
                    "at the end. 0: not by steps.");
  prm.declare_entry("Interval", "0", Patterns::Double(),
                    "Time between checkpoints: the first step that reaches a multiple of it writes one, and "
                    "so does the end. 0: not by time. [time]");
  prm.declare_entry("Keep", "2", Patterns::Integer(0),
                    ">= 1. Number of checkpoints to keep. The run removes its older ones.");
  prm.leave_subsection();
}

void Output::parse(Reader &reader) {
  folder = reader.located("Folder", reader.text("Folder"));
  if (folder.value.empty() && reader.is_set("Folder"))
    reader.reject("Folder", "the name of a folder");
  format = chosen(formats, reader.text("Format"));
  every_steps = reader.count("Step interval");
  interval = reader.not_negative("Interval");
  history_interval = reader.not_negative("History interval");
  if (interval > 0. && every_steps > 0 && reader.is_set("Step interval"))
    reader.reject("Step interval", "no value, or 0: fields are written by the 'Interval'");
  stress = reader.flag("Stress");
  strain = reader.flag("Strain");
  sheet_strains = reader.flag("Sheet strains");
  plastic_strain = reader.flag("Plastic strain");
  state_fields = reader.located("State fields", reader.parts("State fields", ','));
  const auto &names = state_fields.value;
  if (std::set<std::string>(names.begin(), names.end()).size() < names.size())
    reader.reject("State fields", "names that differ from each other");
  contact = reader.flag("Contact");
  averages = reader.flag("Nodal averages");
  verbosity = chosen(verbosities, reader.text("Verbosity"));
  reader.in("Checkpoint", [&] {
    checkpoint.every_steps = reader.count("Step interval");
    checkpoint.interval = reader.not_negative("Interval");
    checkpoint.keep = reader.count("Keep", 1);
    if (checkpoint.every_steps > 0 && checkpoint.interval > 0.)
      reader.reject("Step interval", "no value, or 0: checkpoints are written by the 'Interval'");
  });
}

void Restart::declare(ParameterHandler &prm) {
  prm.declare_entry("File", "", Patterns::Anything(),
                    "Checkpoint of an earlier run from which the scene resumes, relative to the scene file. "
                    "--restart on the command line replaces it.");
  prm.declare_entry("Release time", "0", Patterns::Double(),
                    "Quasi-static scenes that resume from an explicit run, or without former tools: time "
                    "over which unbalanced forces fade. 0: until the end time. [time]");
}

void Restart::parse(Reader &reader) {
  file = reader.located("File", std::string());
  if (!reader.text("File").empty())
    file.value = reader.file("File");
  release_time = reader.not_negative("Release time");
}

} // namespace billet::parameters
