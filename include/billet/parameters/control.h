// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_PARAMETERS_CONTROL_H
#define BILLET_PARAMETERS_CONTROL_H

#include "billet/parameters/reader.h"

namespace billet::parameters {

/// One named subsection of Amplitudes: a function of time, for use by its name in expressions.
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
  // Of implicit scenes, quasi-static or dynamic:
  Control control = Control::automatic;
  double initial_step = 0., smallest_step = 0., largest_step = 0.;
  double error_tolerance = 0.; ///< of quasi-static steps, part of the forces; 0: none
  unsigned int few_iterations = 0, many_iterations = 0;
  double growth_factor = 1., shrink_factor = 1., cut_factor = 1.;

  static void declare(dealii::ParameterHandler &prm);
  void parse(Reader &reader);
};

/// Subsection Explicit dynamics.
struct ExplicitDynamics {
  enum class Instructions { automatic, scalar, sse2, avx2, avx512 };
  enum class NumberType { double_precision, float_precision };

  double safety_factor;
  double contact_resolution; ///< of the oscillation on penalties, >= 1
  double linear_viscosity, quadratic_viscosity;
  double scaled_step;   ///< elements get mass until their step is not shorter; 0: none
  double largest_drift; ///< part of the energy
  Instructions instructions;
  NumberType number_type; ///< of the element kernels

  static void declare(dealii::ParameterHandler &prm);
  void parse(Reader &reader);
};

/// How the contact forces are linearised; see contact/traction.h.
enum class ContactTangent {
  automatic, ///< exact where there is friction; consistent, and so symmetric, where there is none
  exact,
  numerical, ///< the same by central differences, for comparison
  consistent,
  continuum,
  symmetrised_upper,
  symmetrised_lower,
  symmetrised_mean
};

/// How the stresses are linearised where their exact tangent is unsymmetric.
enum class MaterialTangent {
  automatic, ///< its symmetric part where nothing else in the scene makes the matrix unsymmetric
  exact,
  symmetrised
};

/// Subsection Solver.
struct Solver {
  enum class LineSearch { none, energy };
  enum class Predictor { tangent, extrapolation };
  /// Above so many unknowns, or where a direct solver would want half of the memory, `automatic` is
  /// iterative.
  static constexpr unsigned int most_direct_dofs = 10000;
  enum class LinearSolver { automatic, mumps_symmetric, mumps, klu, conjugate_gradients, gmres };
  enum class Forcing { eisenstat_walker, fixed };

  ContactTangent contact_tangent;
  Located<MaterialTangent> material_tangent;
  double force_tolerance, energy_tolerance, displacement_tolerance;
  unsigned int most_iterations;
  unsigned int most_augmentations; ///< in a step
  LineSearch line_search;
  Predictor predictor;
  Located<LinearSolver> linear_solver;
  Forcing forcing;
  double linear_tolerance; ///< |b − A x| / |b|; with Eisenstat and Walker the smallest that is asked for
  unsigned int most_linear_iterations;

  static void declare(dealii::ParameterHandler &prm);
  void parse(Reader &reader);
};

/// Subsection Output.
struct Output {
  enum class Format { vtu, hdf5, none };
  enum class Verbosity { quiet, steps, iterations };

  Located<std::string> folder;
  Format format;
  unsigned int every_steps;
  double interval;
  double history_interval; ///< of explicit scenes; 0: a two hundredth of the end time
  bool stress, plastic_strain, contact;
  Verbosity verbosity;

  /// Subsection Checkpoint.
  struct Checkpoint {
    unsigned int every_steps; ///< 0: not by steps
    double interval;          ///< 0: not by time
    unsigned int keep;        ///< the last ones

    bool is_regular() const { return every_steps > 0 || interval > 0.; }
  };
  Checkpoint checkpoint;

  static void declare(dealii::ParameterHandler &prm);
  void parse(Reader &reader);
};

/// Subsection Restart.
struct Restart {
  Located<std::string> file; ///< a checkpoint to go on with; empty: the scene starts at time 0
  double release_time;       ///< in which forces out of balance fade; 0: until the end time

  bool is_wanted() const { return !file.value.empty(); }

  static void declare(dealii::ParameterHandler &prm);
  void parse(Reader &reader);
};

} // namespace billet::parameters

#endif
