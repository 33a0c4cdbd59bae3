// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_IMPLICIT_HEAVY_TOOLS_H
#define BILLET_SOLVE_IMPLICIT_HEAVY_TOOLS_H

#include "billet/integration/time_integrator.h"
#include "billet/scene/scene.h"
#include "billet/solve/implicit/contact_damping.h"
#include "billet/solve/implicit/tool_inertia.h"

#include <vector>

namespace billet {

/// Driven tools with a mass: their motion at the start of the step, and the effect of their
/// inertia.
class HeavyTools final : public ToolInertia {
public:
  /// `contact` weighs the forces that the tools exert. The arguments must outlive this object.
  HeavyTools(const Scene &scene, const TimeIntegrator &integrator, const ContactDamping &contact);

  bool has_mass(const std::size_t tool) const override { return tools_[tool].inertia > 0.; }
  /// Starts a motion with the load that the tool exerts, and its prescribed load.
  void start(std::size_t tool, double exerted, double load);
  /// Begins a step of this length [time] from these offsets.
  void start_step(double length, const std::vector<double> &offsets);
  /// Adds the change of the offsets at constant acceleration.
  void extrapolate(std::vector<double> &offsets) const;
  /// Returns the residual by round-off of offsets, `last_bit` times their masses [force]. Moments
  /// are divided by `radius`.
  double round_off_force(double last_bit, double radius) const;

  double residual(std::size_t tool, double offset) const override;
  double slope(std::size_t tool) const override;
  void commit(std::size_t tool, double offset, double exerted, double load, EnergyLedger &energies) override;
  double remove(std::size_t tool) override;
  /// Adds kinetic energies and momenta.
  void add_to(SolutionState &state) const;

  void save(std::size_t tool, StateWriter &writer) const override;
  /// `is_exact`: with accelerations; else they have to be computed anew.
  void load(std::size_t tool, const StateReader &reader, bool is_exact);

private:
  /// Offset, rate and forces of a tool at the start of the step.
  struct HeavyTool {
    double inertia = 0.; ///< 0: none
    double offset = 0., rate = 0., acceleration = 0., exerted = 0., load = 0.;
  };
  /// Returns the acceleration at the start; with (I4), that of the other forces.
  double start_acceleration(const HeavyTool &tool) const {
    return tool.acceleration + (contact_.is_on() ? tool.exerted / tool.inertia : 0.);
  }
  double accelerate(const HeavyTool &tool, double offset) const;

  const Scene &scene_;
  const TimeIntegrator &integrator_;
  const ContactDamping &contact_;
  double length_ = 0.; ///< of the step; 0: none yet [time]
  std::vector<HeavyTool> tools_;
};

} // namespace billet

#endif
