// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_CONTROL_H
#define BILLET_PARAMETERS_CONTROL_H

#include "billet/algebra/linear_method.h"
#include "billet/mechanics/kernel_choice.h"
#include "billet/parameters/named_values.h"
#include "billet/parameters/reader.h"

#include <optional>

namespace billet::parameters {

/// One named subsection of Amplitudes: a function of time that expressions use by its name.
struct Amplitude {
  enum class Interpolation { linear, smooth };

  std::string name;
  std::vector<double> times, values;
  Interpolation interpolation;

  static void declare(dealii::ParameterHandler &prm);
  void parse(Reader &reader);
};

/// Subsection Time stepping.
struct TimeStepping {
  enum class Scheme { quasi_static, explicit_dynamics, implicit_dynamics };
  enum class Control { automatic, fixed };

  Scheme scheme;
  std::vector<double> stops;
  double end_time;
  // Implicit schemes only, quasi-static or dynamic:
  Control control = Control::automatic;
  double initial_step = 0., min_step = 0., max_step = 0.;
  double error_tolerance = 0.; ///< for quasi-static steps, relative to the forces; 0: none
  unsigned int few_iterations = 0, many_iterations = 0;
  double growth_factor = 1., shrink_factor = 1., cut_factor = 1.;

  static void declare(dealii::ParameterHandler &prm);
  void parse(Reader &reader);
};

/// Properties of a scheme. Code that depends on the scheme reads this, not its name. A new scheme
/// is a row of scheme_types() and a run in make_run().
struct SchemeType {
  TimeStepping::Scheme scheme;
  std::string name;        ///< in scene files, checkpoints and messages
  std::string description; ///< in the summary of a scene
  bool has_inertia;        ///< bodies have densities, velocities and kinetic energy
  /// Whether iterations solve for the end of each step; else steps have a stability limit.
  bool has_matrix;
  bool lumps_mass; ///< always; else with inertia as the scene says
};
const std::vector<SchemeType> &scheme_types();
const SchemeType &type_of(TimeStepping::Scheme scheme);

/// Names of schemes in scene files, checkpoints and messages.
const NamedValues<TimeStepping::Scheme> &schemes();
const std::string &name_of(TimeStepping::Scheme scheme);

/// Subsection Explicit dynamics.
struct ExplicitDynamics {
  double safety_factor;
  double contact_resolution; ///< for the oscillation of nodes on penalty springs, >= 1
  double linear_viscosity, quadratic_viscosity;
  double scaled_step; ///< stable step that mass scaling ensures for each element; 0: none
  double max_drift;   ///< maximum, relative to the energy
  InstructionSet instructions;
  NumberType number_type; ///< for the element kernels

  static void declare(dealii::ParameterHandler &prm);
  void parse(Reader &reader);
};

/// Linearisation of the contact forces; see contact/traction.h.
enum class ContactTangent {
  automatic, ///< exact with friction; consistent, hence symmetric, without
  exact,
  numerical, ///< exact, by central differences, for comparison
  consistent,
  continuum,
  symmetrised_upper,
  symmetrised_lower,
  symmetrised_mean
};

/// Linearisation of stresses whose exact tangent is unsymmetric.
enum class MaterialTangent {
  automatic, ///< symmetric part, unless something else in the scene makes the matrix unsymmetric
  exact,
  symmetrised
};

/// Subsection Solver.
struct Solver {
  enum class LineSearch { none, energy };
  enum class Predictor { tangent, extrapolation };
  /// Above this number of unknowns, or if a direct solver would need half of the memory, the
  /// automatic choice is an iterative solver.
  static constexpr unsigned int max_direct_dofs = 10000;
  enum class Forcing { eisenstat_walker, fixed };

  ContactTangent contact_tangent;
  Located<MaterialTangent> material_tangent;
  double force_tolerance, energy_tolerance, displacement_tolerance;
  unsigned int max_iterations;
  unsigned int max_augmentations; ///< maximum in a step
  LineSearch line_search;
  Predictor predictor;
  Located<std::optional<LinearMethod>> linear_solver; ///< none: automatic
  Forcing forcing;
  double linear_tolerance; ///< |b − A x| / |b|; for Eisenstat and Walker the minimum
  unsigned int max_linear_iterations;

  static void declare(dealii::ParameterHandler &prm);
  void parse(Reader &reader);
};

/// Linear solvers of scene files; none: automatic.
const NamedValues<std::optional<LinearMethod>> &linear_methods();
/// Returns the names of those that solve with unsymmetric matrices, separated by commas.
std::string methods_for_unsymmetric();

/// Subsection Output.
struct Output {
  enum class Format { vtu, hdf5, none };
  enum class Verbosity { quiet, steps, iterations };

  Located<std::string> folder;
  Format format;
  unsigned int every_steps;
  double interval;
  double history_interval; ///< for explicit scenes; 0: 1/200 of the end time
  bool stress, plastic_strain, contact, strain, sheet_strains;
  /// Whether element fields are also averaged to nodes.
  bool averages;
  Located<std::vector<std::string>> state_fields; ///< names among PointLaw::fields()
  Verbosity verbosity;

  /// Subsection Checkpoint.
  struct Checkpoint {
    unsigned int every_steps; ///< 0: no checkpoints by steps
    double interval;          ///< 0: no checkpoints by time
    unsigned int keep;        ///< number of checkpoints to keep

    bool is_regular() const { return every_steps > 0 || interval > 0.; }
  };
  Checkpoint checkpoint;

  static void declare(dealii::ParameterHandler &prm);
  void parse(Reader &reader);
};

/// Subsection Restart.
struct Restart {
  Located<std::string> file; ///< checkpoint to resume from; empty: the scene starts at time 0
  double release_time;       ///< over which unbalanced forces fade; 0: until the end time

  bool is_wanted() const { return !file.value.empty(); }

  static void declare(dealii::ParameterHandler &prm);
  void parse(Reader &reader);
};

} // namespace billet::parameters

#endif
