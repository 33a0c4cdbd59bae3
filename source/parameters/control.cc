// SPDX-License-Identifier: LGPL-2.1-or-later
#include "billet/parameters/control.h"

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <sstream>

namespace billet::parameters {

using dealii::ParameterHandler;
namespace Patterns = dealii::Patterns;

void Amplitude::declare(ParameterHandler &prm) {
  prm.declare_entry("Times", "0, 1", Patterns::Anything(),
                    "Strictly increasing numbers. Before the first and after the last time the value is "
                    "constant. Steps of implicit scenes end where the motion turns, begins, ends or changes "
                    "its rate by more than half. [time]");
  prm.declare_entry("Values", "0, 1", Patterns::Anything(), "One value for each time. [any]");
  prm.declare_entry("Interpolation", "linear", Patterns::Selection("linear|smooth"),
                    "linear: straight lines between the times; smooth: quintic steps with vanishing first "
                    "and second derivative at "
                    "each time.");
}

void Amplitude::parse(Reader &reader) {
  times = reader.numbers("Times");
  values = reader.numbers("Values");
  if (times.empty())
    reader.reject("Times", "at least one number");
  for (std::size_t i = 1; i < times.size(); ++i)
    if (!(times[i] > times[i - 1]))
      reader.reject("Times", "strictly increasing numbers");
  if (values.size() != times.size())
    reader.reject("Values", "as many numbers as there are times (" + std::to_string(times.size()) + ")");
  interpolation = reader.text("Interpolation") == "linear" ? Interpolation::linear : Interpolation::smooth;
}

void TimeStepping::declare(ParameterHandler &prm) {
  prm.declare_entry("End time", "1", Patterns::Double(),
                    "The run begins at time 0 and ends at this time. [time]");
  prm.declare_entry(
      "Scheme", "quasi-static", Patterns::Selection("quasi-static|explicit|implicit dynamics"),
      "quasi-static: equilibrium at the end of each step, by Newton's method; explicit: motion by central "
      "differences, in steps as short as elements and contact require; implicit dynamics: motion by Newton's "
      "method, in steps as long as accuracy allows. Bodies of dynamic scenes need a density.");
  prm.declare_entry("Stops", "", Patterns::Anything(),
                    "Further times at which steps end, separated by commas, such as corners of motions that "
                    "no amplitude describes. [time]");
  prm.declare_entry("Step control", "automatic", Patterns::Selection("automatic|fixed"),
                    "automatic: the step length follows the iterations of the last step, and a failed step "
                    "is cut and repeated; fixed: equal steps, shorter only where the next stop or output "
                    "time is nearer; a failed step ends the run.");
  prm.declare_entry("Initial step", "automatic", Patterns::Anything(),
                    "Length of the first step, or of all steps if they are fixed. automatic: a hundredth of "
                    "the end time, or the maximum step if that is less. [time]");
  prm.declare_entry("Minimum step", "automatic", Patterns::Anything(),
                    "The run ends when a step would have to be cut below this. automatic: a millionth of the "
                    "end time, or the initial step if that is less. [time]");
  prm.declare_entry("Maximum step", "automatic", Patterns::Anything(),
                    "A step grows up to this length. automatic: a tenth of the end time, or the initial step "
                    "if that is more. [time]");
  prm.declare_entry(
      "Error tolerance", "0", Patterns::Double(),
      "Quasi-static scenes with automatic steps: maximum error of a step, as a part of the forces. Steps of "
      "twice the length estimate the error now and then. 0: the iterations alone determine the step.");
  prm.declare_entry("Growth iterations", "5", Patterns::Integer(0),
                    "The step grows after at most this many iterations.");
  prm.declare_entry("Shrink iterations", "9", Patterns::Integer(0),
                    "The step shrinks after at least this many iterations.");
  prm.declare_entry("Growth factor", "1.5", Patterns::Double(), "At least 1. A step grows by this factor.");
  prm.declare_entry("Shrink factor", "0.7", Patterns::Double(),
                    "Between 0 and 1. A step shrinks by this factor.");
  prm.declare_entry("Cut factor", "0.5", Patterns::Double(),
                    "Between 0 and 1. A failed step is repeated at this part of its length.");
}

void TimeStepping::parse(Reader &reader) {
  end_time = reader.positive("End time");
  stops = reader.numbers("Stops");
  for (const double stop : stops)
    if (!(stop > 0. && stop <= end_time))
      reader.reject("Stops", "numbers > 0, not above the end time");
  const std::string chosen = reader.text("Scheme");
  scheme = chosen == "explicit"            ? Scheme::explicit_dynamics
           : chosen == "implicit dynamics" ? Scheme::implicit_dynamics
                                           : Scheme::quasi_static;
  if (scheme == Scheme::explicit_dynamics) {
    for (const std::string key :
         {"Step control", "Initial step", "Minimum step", "Maximum step", "Growth iterations",
          "Shrink iterations", "Growth factor", "Shrink factor", "Cut factor", "Error tolerance"})
      if (reader.is_set(key))
        reader.reject(key, "no value: the steps of an explicit scene follow from its elements");
    return;
  }
  control = reader.text("Step control") == "automatic" ? Control::automatic : Control::fixed;
  const auto step = [&reader](const std::string &key, const double automatic) {
    return reader.text(key) == "automatic" ? automatic : reader.positive(key);
  };
  const auto print = [](const double time) {
    std::ostringstream text;
    text << time;
    return text.str();
  };
  largest_step = step("Maximum step", 0.1 * end_time);
  initial_step = step("Initial step", std::min(0.01 * end_time, largest_step));
  if (initial_step > end_time)
    reader.reject("Initial step", "a number not above the end time, " + print(end_time));
  if (reader.text("Maximum step") == "automatic")
    largest_step = std::max(largest_step, initial_step);
  if (control == Control::fixed)
    for (const std::string key : {"Minimum step", "Maximum step", "Growth iterations", "Shrink iterations",
                                  "Growth factor", "Shrink factor", "Cut factor", "Error tolerance"})
      if (reader.is_set(key))
        reader.reject(key, "no value: steps are fixed");
  smallest_step = step("Minimum step", std::min(1e-6 * end_time, initial_step));
  if (control == Control::automatic) {
    if (smallest_step > initial_step)
      reader.reject("Minimum step", "a number not above the initial step, " + print(initial_step));
    if (largest_step < initial_step)
      reader.reject("Maximum step", "a number not below the initial step, " + print(initial_step));
  }
  error_tolerance = reader.not_negative("Error tolerance");
  if (error_tolerance >= 1.)
    reader.reject("Error tolerance", "a number >= 0 and < 1");
  if (error_tolerance > 0. && scheme == Scheme::implicit_dynamics)
    reader.reject("Error tolerance", "no value: that of 'Implicit dynamics' holds");
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
                    "> 0, at most 1. Steps are this part of the stability bound of elements and contact.");
  prm.declare_entry("Contact resolution", "2", Patterns::Double(),
                    "At least 1. Steps resolve the oscillation of a node on its contact penalty by this "
                    "factor finer than stability requires. 1 makes the longest steps; 2 reduces the energy "
                    "error of stiff impacts to a third.");
  prm.declare_entry("Linear bulk viscosity", "0.06", Patterns::Double(),
                    "b1 >= 0: a pressure b1 rho c L times the volumetric strain rate damps ringing; L is the "
                    "element's size, c the speed of sound.");
  prm.declare_entry("Quadratic bulk viscosity", "1.2", Patterns::Double(),
                    "b2 >= 0: a pressure rho (b2 L)^2 times the square of the rate, in compression only, "
                    "spreads shocks over some elements.");
  prm.declare_entry("Mass scaling step", "0", Patterns::Double(),
                    "Elements whose stable step, safety factor included, is shorter at the start get mass "
                    "until it is this long. A note reports the added mass. 0: none. [time]");
  prm.declare_entry("Maximum energy drift", "0.05", Patterns::Double(),
                    "> 0. The run ends if the energies fail to balance by more than this part of the "
                    "largest energy so far, for a hundred steps or at the end.");
  prm.declare_entry("Instruction set", "automatic", Patterns::Selection("automatic|scalar|SSE2|AVX2|AVX-512"),
                    "Instruction set of the element kernels; automatic: the best of this machine.");
  prm.declare_entry("Number type", "double", Patterns::Selection("double|float"),
                    "Numbers in which elements are computed. float: twice as many elements at once, to about "
                    "seven digits; nodes, sums and energies stay double.");
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
  largest_drift = reader.positive("Maximum energy drift");
  const std::string chosen_set = reader.text("Instruction set");
  instructions = chosen_set == "automatic" ? Instructions::automatic
                 : chosen_set == "scalar"  ? Instructions::scalar
                 : chosen_set == "SSE2"    ? Instructions::sse2
                 : chosen_set == "AVX2"    ? Instructions::avx2
                                           : Instructions::avx512;
  number_type =
      reader.text("Number type") == "float" ? NumberType::float_precision : NumberType::double_precision;
}

namespace {

const std::vector<std::pair<std::string, ContactTangent>> tangent_names = {
    {"automatic", ContactTangent::automatic},
    {"exact", ContactTangent::exact},
    {"numerical", ContactTangent::numerical},
    {"consistent", ContactTangent::consistent},
    {"continuum", ContactTangent::continuum},
    {"symmetrised upper", ContactTangent::symmetrised_upper},
    {"symmetrised lower", ContactTangent::symmetrised_lower},
    {"symmetrised mean", ContactTangent::symmetrised_mean}};

const std::vector<std::pair<std::string, MaterialTangent>> material_tangent_names = {
    {"automatic", MaterialTangent::automatic},
    {"exact", MaterialTangent::exact},
    {"symmetrised", MaterialTangent::symmetrised}};

template <class T> std::string selection(const std::vector<std::pair<std::string, T>> &names) {
  std::string result;
  for (const auto &entry : names)
    result += (result.empty() ? "" : "|") + entry.first;
  return result;
}

template <class T> T chosen(const std::vector<std::pair<std::string, T>> &names, const std::string &name) {
  for (const auto &entry : names)
    if (entry.first == name)
      return entry.second;
  throw std::logic_error("selection not in its own list: " + name);
}

const std::vector<std::pair<std::string, Solver::LinearSolver>> linear_solver_names = {
    {"automatic", Solver::LinearSolver::automatic},
    {"MUMPS symmetric", Solver::LinearSolver::mumps_symmetric},
    {"MUMPS", Solver::LinearSolver::mumps},
    {"KLU", Solver::LinearSolver::klu},
    {"CG", Solver::LinearSolver::conjugate_gradients},
    {"GMRES", Solver::LinearSolver::gmres}};

} // namespace

void Solver::declare(ParameterHandler &prm) {
  prm.declare_entry(
      "Contact tangent", "automatic", Patterns::Selection(selection(tangent_names)),
      "automatic: exact with friction and between bodies, else consistent, so that the matrix is symmetric, "
      "as "
      "also between bodies without friction if a linear solver for symmetric matrices is chosen; "
      "exact: the full derivative of the contact forces, with the turning of the tool's normal and the "
      "change of area; "
      "numerical: the same by central differences, eq. (43), slow, for comparison; consistent, "
      "continuum: Bittencourt & "
      "Creus (1998), eqs. (55)-(57) and (50), areas held; symmetrised: the upper, the lower "
      "triangle or the mean of "
      "the consistent one in the contact frame, meant for mu <= 0.1.");
  prm.declare_entry("Material tangent", "automatic", Patterns::Selection(selection(material_tangent_names)),
                    "Tangent of bodies whose exact one is unsymmetric: hypoelastic ones, and plastic ones "
                    "that are neo-Hookean. Without such bodies only automatic is allowed. automatic: the "
                    "symmetric part where the matrix is symmetric otherwise, else exact.");
  prm.declare_entry(
      "Force tolerance", "5e-3", Patterns::Double(),
      "A step converges when the norm of the residual, over all nodes, is at most this part of the norm of "
      "the nodal forces. In the last iteration, nodes that change their contact status may carry at most "
      "this part of the contact force. For comparisons to many digits use 1e-6 or less.");
  prm.declare_entry(
      "Energy tolerance", "5e-5", Patterns::Double(),
      "A step converges when the work of the residual along the last correction is at most this part of the "
      "norm of the nodal forces times that of the step's displacements. For comparisons use 1e-10 or less.");
  prm.declare_entry(
      "Displacement tolerance", "1e-2", Patterns::Double(),
      "A step converges when the last correction moves no node by more than this part of the largest "
      "displacement in the step. This is not required if the residual is below 5e-6 of the forces.");
  prm.declare_entry("Maximum iterations", "60", Patterns::Integer(0),
                    "Newton iterations of a step. A step that would need more fails, as soon as its pace "
                    "shows that.");
  prm.declare_entry("Maximum augmentations", "20", Patterns::Integer(0),
                    "Augmentations of contact with a 'Penetration tolerance' in a step. A step that needs "
                    "more fails.");
  prm.declare_entry("Line search", "energy", Patterns::Selection("none|energy"),
                    "energy: a correction is shortened while the residual's work along it grows; in any case "
                    "a correction that turns an element inside out is shortened.");
  prm.declare_entry("Predictor", "extrapolation", Patterns::Selection("tangent|extrapolation"),
                    "Guess from which the iterations of a step start. extrapolation: the last increment "
                    "continued, or in implicit dynamics the motion at constant acceleration; tangent: a "
                    "linear step with the motion of tools and supports. The tangent is used in any case at "
                    "the start, after a cut, and where tools or supports change their rate.");
  prm.declare_entry("Linear solver", "automatic", Patterns::Selection(selection(linear_solver_names)),
                    "Direct solvers are MUMPS, its symmetric form, and KLU, which runs on one rank at a time "
                    "and is slow. Iterative solvers, with multigrid, are CG, for symmetric matrices, and "
                    "GMRES. automatic: a direct one for small scenes, if the machine's memory suffices.");
  prm.declare_entry(
      "Forcing term", "Eisenstat-Walker", Patterns::Selection("Eisenstat-Walker|fixed"),
      "The relative residual to which iterative solvers solve. Eisenstat-Walker: it falls as Newton's "
      "method converges (Eisenstat & Walker 1996, choice 2); fixed: the linear tolerance.");
  prm.declare_entry("Linear tolerance", "1e-6", Patterns::Double(),
                    "> 0 and < 1. Residual over right-hand side to which iterative solvers solve; with "
                    "Eisenstat-Walker the minimum of it.");
  prm.declare_entry("Maximum linear iterations", "200", Patterns::Integer(0),
                    "Iterations of an iterative solver. If it needs more, a direct solver replaces it for "
                    "that matrix.");
}

void Solver::parse(Reader &reader) {
  contact_tangent = chosen(tangent_names, reader.text("Contact tangent"));
  material_tangent =
      reader.located("Material tangent", chosen(material_tangent_names, reader.text("Material tangent")));
  force_tolerance = reader.positive("Force tolerance");
  if (force_tolerance >= 1.)
    reader.reject("Force tolerance", "a number > 0 and < 1");
  energy_tolerance = reader.positive("Energy tolerance");
  displacement_tolerance = reader.positive("Displacement tolerance");
  most_iterations = reader.count("Maximum iterations", 1);
  most_augmentations = reader.count("Maximum augmentations", 1);
  line_search = reader.text("Line search") == "none" ? LineSearch::none : LineSearch::energy;
  predictor = reader.text("Predictor") == "tangent" ? Predictor::tangent : Predictor::extrapolation;
  linear_solver = reader.located("Linear solver", chosen(linear_solver_names, reader.text("Linear solver")));
  forcing = reader.text("Forcing term") == "fixed" ? Forcing::fixed : Forcing::eisenstat_walker;
  linear_tolerance = reader.positive("Linear tolerance");
  if (linear_tolerance >= 1.)
    reader.reject("Linear tolerance", "a number > 0 and < 1");
  most_linear_iterations = reader.count("Maximum linear iterations", 1);
  if (linear_solver.value == LinearSolver::mumps || linear_solver.value == LinearSolver::mumps_symmetric ||
      linear_solver.value == LinearSolver::klu)
    for (const std::string key : {"Forcing term", "Linear tolerance", "Maximum linear iterations"})
      if (reader.is_set(key))
        reader.reject(key, "no value: the linear solver is direct");
}

void Output::declare(ParameterHandler &prm) {
  prm.declare_entry(
      "Folder", "results", Patterns::Anything(),
      "Folder of all output, relative to the current folder. It is created if it does not exist.");
  prm.declare_entry(
      "Format", "vtu", Patterns::Selection("vtu|hdf5|none"),
      "Fields for ParaView: VTU and PVD; HDF5 and XDMF, one file a time on any number of ranks; or none.");
  prm.declare_entry("Step interval", "1", Patterns::Integer(0),
                    "Fields are written each time after this many steps, at the start and at the end. 0, "
                    "the default of explicit scenes: only there, or by the interval.");
  prm.declare_entry(
      "Interval", "0", Patterns::Double(),
      "If not 0, fields are written at multiples of this time instead: steps end there; in explicit "
      "scenes, at the end of the first step that reaches them. [time]");
  prm.declare_entry("History interval", "0", Patterns::Double(),
                    "Explicit scenes: a line of the history is written at the end of the first step that "
                    "reaches a multiple of this time; 0: a two hundredth of the end time. [time]");
  prm.declare_entry("Stress", "true", Patterns::Bool(),
                    "Write Cauchy stress, von Mises stress and pressure.");
  prm.declare_entry("Plastic strain", "true", Patterns::Bool(),
                    "Write the equivalent plastic strain, if a body is plastic.");
  prm.declare_entry("Contact", "true", Patterns::Bool(),
                    "Write contact pressure, traction, gap, slip and status, if there is contact.");
  prm.declare_entry("Verbosity", "steps", Patterns::Selection("quiet|steps|iterations"),
                    "quiet: only warnings and errors; steps: a line for each step; iterations: residuals of "
                    "each iteration, too.");
  prm.enter_subsection("Checkpoint");
  prm.declare_entry("Step interval", "0", Patterns::Integer(0),
                    "A checkpoint, from which the run can resume, is written each time after this many "
                    "steps and at the end. 0: not by steps.");
  prm.declare_entry("Interval", "0", Patterns::Double(),
                    "A checkpoint is written when a step reaches or passes a multiple of this time, and at "
                    "the end. 0: not by time. [time]");
  prm.declare_entry("Keep", "2", Patterns::Integer(0),
                    "At least 1: number of checkpoints that are kept. Older ones of this run are removed.");
  prm.leave_subsection();
}

void Output::parse(Reader &reader) {
  folder = reader.located("Folder", reader.text("Folder"));
  if (folder.value.empty())
    reader.reject("Folder", "the name of a folder");
  const std::string chosen_format = reader.text("Format");
  format = chosen_format == "vtu" ? Format::vtu : chosen_format == "hdf5" ? Format::hdf5 : Format::none;
  every_steps = reader.count("Step interval");
  interval = reader.not_negative("Interval");
  history_interval = reader.not_negative("History interval");
  if (interval > 0. && every_steps > 0 && reader.is_set("Step interval"))
    reader.reject("Step interval", "no value, or 0: fields are written by the 'Interval'");
  stress = reader.flag("Stress");
  plastic_strain = reader.flag("Plastic strain");
  contact = reader.flag("Contact");
  const std::string chosen_verbosity = reader.text("Verbosity");
  verbosity = chosen_verbosity == "quiet"   ? Verbosity::quiet
              : chosen_verbosity == "steps" ? Verbosity::steps
                                            : Verbosity::iterations;
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
  prm.declare_entry(
      "Release time", "0", Patterns::Double(),
      "Quasi-static scenes that resume from an explicit run, or without tools that were there: the forces "
      "that are out of balance then fade over this time; 0: until the end time. [time]");
}

void Restart::parse(Reader &reader) {
  file = reader.located("File", std::string());
  if (!reader.text("File").empty())
    file.value = reader.file("File");
  release_time = reader.not_negative("Release time");
}

} // namespace billet::parameters
