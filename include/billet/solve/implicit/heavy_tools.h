// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_HEAVY_TOOLS_H
#define BILLET_SOLVE_IMPLICIT_HEAVY_TOOLS_H

#include "billet/integration/time_integrator.h"
#include "billet/scene/scene.h"
#include "billet/solve/solution.h"
#include "billet/state.h"

#include <vector>

namespace billet {

/// Driven tools with a mass: their motion at the start of the step, and the effect of their inertia.
class HeavyTools {
public:
  explicit HeavyTools(const Scene &scene);

  /// Step that is tried.
  struct Step {
    const TimeIntegrator &integrator;
    double length;
    bool damps_contact; ///< by (I4)
  };

  bool has_mass(const std::size_t tool) const { return tools_[tool].inertia > 0.; }
  /// Starts a motion with the load that the tool exerts, and its prescribed load.
  void start(std::size_t tool, double exerted, double load);
  /// Begins a step from these offsets.
  void start_step(const std::vector<double> &offsets);
  /// Adds the change of the offsets at constant acceleration.
  void extrapolate(double step, std::vector<double> &offsets) const;
  /// Returns the residual by round-off of offsets, `last_bit` times their masses [force]. Moments are divided
  /// by `radius`.
  double round_off_force(double last_bit, double step, double radius) const;

  /// Returns the residual of a tool except the weighted force that it exerts and its load, and its slope.
  double residual(std::size_t tool, double offset, const Step &step) const;
  double slope(std::size_t tool, const Step &step) const;
  /// Accepts the step. `exerted`: on the bodies, along the tool's direction or about its axis.
  void commit(std::size_t tool, double offset, double exerted, double load, const Step &step,
              EnergyLedger &energies);
  /// Removes a tool. Returns its kinetic energy.
  double remove(std::size_t tool);
  /// Adds kinetic energies and momenta.
  void add_to(SolutionState &state) const;

  void save(std::size_t tool, StateWriter &writer) const;
  /// `is_exact`: with accelerations; else they have to be computed anew.
  void load(std::size_t tool, const StateReader &reader, bool is_exact);

private:
  /// Offset, rate and forces of a tool at the start of the step.
  struct HeavyTool {
    double inertia = 0.; ///< 0: none
    double offset = 0., rate = 0., acceleration = 0., exerted = 0., load = 0.;
  };
  /// Returns the acceleration at the start; with (I4), that of the other forces.
  static double start_acceleration(const HeavyTool &tool, const Step &step) {
    return tool.acceleration + (step.damps_contact ? tool.exerted / tool.inertia : 0.);
  }
  static double accelerate(const HeavyTool &tool, double offset, const Step &step);

  const Scene &scene_;
  std::vector<HeavyTool> tools_;
};

} // namespace billet

#endif
