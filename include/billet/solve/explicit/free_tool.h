// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef BILLET_SOLVE_EXPLICIT_FREE_TOOL_H
#define BILLET_SOLVE_EXPLICIT_FREE_TOOL_H

#include "billet/contact/contact_load.h"
#include "billet/scene/scene.h"
#include "billet/state.h"

namespace billet {

/// Tool in an explicit scene. A tool with a force or moment has a mass, or moment of inertia, m.
/// Its offset s beyond its prescribed motion is along its direction, or about its axis. It obeys
///   m s̈ = load − resistance of the bodies,
/// and is integrated by the same central differences as the nodes.
class FreeTool {
public:
  FreeTool(const Tool &tool, const parameters::Motion &motion);

  const Placement &before() const { return before_; } ///< at the start of the step that ends now
  const Placement &now() const { return now_; }
  bool is_gone(const double t) const { return t >= tool_.removal_time(); }
  bool is_removed() const { return is_removed_; }
  /// Whether kick() needs the contact forces of all ranks.
  bool wants_load() const { return tool_.control() != Tool::Control::motion; }
  /// Whether it starts with a speed, or moves within this time from the start.
  bool moves(const double within) const {
    const Placement start = tool_.placement(0.), then = tool_.placement(within);
    return rate_ != 0. || start.translation != then.translation ||
           start.rotation_angle != then.rotation_angle;
  }
  /// Returns 1/m; 0 for a tool with prescribed motion, or a removed one.
  double inverse_inertia() const { return tool_.is_driven() && !is_removed_ ? 1. / inertia_ : 0.; }

  /// Updates the rate of the offset at time t, from half a step before to half a step after it. The
  /// first kick of a run leads from rest to half a step. `load`: of the tool on the bodies. A tool
  /// that reaches its stop force stops permanently.
  void kick(double t, const ContactLoad &load, double step_before, double step, bool is_first);
  /// Moves on to t + dt.
  void move(double t, double dt);

  /// Removes the tool with its mass: it neither moves nor contributes any more.
  void remove();

  double kinetic_energy() const { return 0.5 * inertia_ * rate_before_ * rate_; }
  /// Returns the momentum; 0 for a tool that rotates, whose axis is fixed.
  dealii::Tensor<1, 3> momentum() const;
  /// Returns the angular momentum about the origin, with the mass at the centre of rotation. It is
  /// 0 for a tool with prescribed motion.
  dealii::Tensor<1, 3> angular_momentum() const;
  /// Returns the work of the prescribed motion against `local` on the scene, in one half of the
  /// step from before() to now(), ...
  double motion_work(const ContactLoad &local) const;
  /// ... and that of the load of the last kick, the same on all ranks.
  double load_work() const { return 0.5 * load_ * (offset_ - offset_before_); }

  /// Saves into the current group, of a tool.
  void save(StateWriter &writer) const;
  /// `is_exact`: of the same method; else the tool starts at rest.
  void load(const StateReader &reader, bool is_exact);
  /// Places a tool that is new at time t.
  void begin(const double t) { before_ = now_ = tool_.placement(t); }

private:
  /// Returns the resistance of the bodies against the offset.
  double resistance(const ContactLoad &load) const;

  const Tool &tool_;
  double inertia_, rate_, rate_before_;
  double offset_ = 0., offset_before_ = 0.;
  double load_ = 0.; ///< at the last kick
  bool has_stopped_ = false, is_removed_ = false;
  Placement before_, now_;
};

} // namespace billet

#endif
